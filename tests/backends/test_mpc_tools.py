"""A generated function in do-mpc and in rockit: the plan holds when NumPy and SciPy integrate it."""

import importlib.util
import sys
import warnings
from functools import cache
from pathlib import Path
from types import ModuleType

import casadi as ca
import numpy as np
import pytest
from arms_support import model
from scipy.integrate import solve_ivp

from modelgen.backends import NumpyFunction
from modelgen.functions import nominal_base

# The warnings of these two and of what they load are not this project's.
pytestmark = [
    pytest.mark.xdist_group("mpc"),
    pytest.mark.filterwarnings("ignore"),
]

N, STEPS, DURATION = 4, 10, 0.5
START = np.array([0.0, 0.6, -0.9, 0.4])
GOAL = np.array([0.15, 0.7, -1.0, 0.2])
EFFORT = np.array([300.0, 300.0, 150.0, 40.0])  # N m


def imported(name: str) -> ModuleType:
    """The package, or a skip that says how to get it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        module: ModuleType = pytest.importorskip(name, reason=f"{name} is missing: pip install -e '.[mpc]'")
    return module


@cache
def functions() -> dict[str, ca.Function]:
    """The functions in the repository, imported as a user does."""
    file = Path(__file__).resolve().parents[2] / "generated" / "yaw3pitch" / "yaw3pitch_casadi.py"
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    writes, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        spec.loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = writes
    made: dict[str, ca.Function] = module.functions()
    return made


@cache
def parameters() -> np.ndarray:
    return np.array(list(nominal_base(model("yaw3pitch")).values()))


def integrated(efforts: np.ndarray) -> np.ndarray:
    """State at every interval's end under efforts (STEPS × 4) held over the intervals, by NumPy and SciPy."""
    dynamics = NumpyFunction(next(f for f in model("yaw3pitch").functions if f.name == "forward_dynamics"))

    def slope(_: float, x: np.ndarray, effort: np.ndarray) -> np.ndarray:
        return np.concatenate([x[N:], dynamics(x[:N], x[N:], effort, parameters())])

    states = [np.concatenate([START, np.zeros(N)])]
    for effort in efforts:
        span = (0.0, DURATION / STEPS)
        done = solve_ivp(slope, span, states[-1], args=(effort,), rtol=1e-9, atol=1e-10)
        states.append(done.y[:, -1])
    return np.array(states)


def test_the_start_would_fall_without_control() -> None:
    """Else a plan that does nothing would pass below."""
    fallen = integrated(np.zeros((STEPS, N)))[-1]
    assert abs(fallen[:N] - GOAL).max() > 1.0


def test_rockit_plans_with_forward_dynamics() -> None:
    rockit = imported("rockit")
    forward = functions()["yaw3pitch_forward_dynamics"]
    ocp = rockit.Ocp(T=DURATION)
    q, dq, effort = ocp.state(N), ocp.state(N), ocp.control(N)
    ocp.set_der(q, dq)
    ocp.set_der(dq, forward(q, dq, effort, parameters()))
    ocp.subject_to(ocp.at_t0(q) == START)
    ocp.subject_to(ocp.at_t0(dq) == 0)
    ocp.subject_to((effort <= EFFORT) >= -EFFORT)
    ocp.add_objective(ocp.at_tf(1e5 * ca.sumsqr(q - GOAL) + 1e4 * ca.sumsqr(dq)))
    ocp.add_objective(ocp.sum(ca.sumsqr(dq) + 1e-4 * ca.sumsqr(effort)))
    ocp.set_initial(q, START)
    ocp.solver("ipopt", {"expand": True, "print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"})
    ocp.method(rockit.MultipleShooting(N=STEPS, M=2, intg="rk"))
    plan = ocp.solve()
    efforts = plan.sample(effort, grid="control")[1][:STEPS]
    planned = np.hstack([plan.sample(v, grid="control")[1] for v in (q, dq)])
    np.testing.assert_allclose(planned, integrated(efforts), atol=1e-3)
    np.testing.assert_allclose(planned[-1], [*GOAL, 0, 0, 0, 0], atol=0.02)
    assert (abs(efforts) <= EFFORT + 1e-5).all()


def test_rockit_plans_with_inverse_dynamics_as_a_constraint() -> None:
    rockit = imported("rockit")
    inverse = functions()["yaw3pitch_inverse_dynamics"]
    ocp = rockit.Ocp(T=DURATION)
    q, dq, ddq = ocp.state(N), ocp.state(N), ocp.control(N)
    ocp.set_der(q, dq)
    ocp.set_der(dq, ddq)
    effort = inverse(q, dq, ddq, parameters())
    limit = np.array([30.0, 240.0, 75.0, 10.0])  # above what gravity takes, below what the free plan takes
    ocp.subject_to(ocp.at_t0(q) == START)
    ocp.subject_to(ocp.at_t0(dq) == 0)
    ocp.subject_to((effort <= limit) >= -limit, include_last=False)
    ocp.add_objective(ocp.at_tf(1e5 * ca.sumsqr(q - GOAL) + 1e4 * ca.sumsqr(dq)))
    ocp.add_objective(ocp.sum(1e-6 * ca.sumsqr(ddq)))
    ocp.set_initial(q, START)
    ocp.solver("ipopt", {"expand": True, "print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"})
    ocp.method(rockit.MultipleShooting(N=STEPS, M=1, intg="rk"))
    plan = ocp.solve()
    states = [plan.sample(v, grid="control")[1][:STEPS] for v in (q, dq, ddq)]
    needed = NumpyFunction(next(f for f in model("yaw3pitch").functions if f.name == "inverse_dynamics"))
    efforts = np.array([needed(*row, parameters()) for row in zip(*states, strict=True)])
    assert (abs(efforts) <= limit + 1e-4).all()
    assert np.isclose(abs(efforts), limit, rtol=1e-3).any(), (
        "a limit must bind, or the test says nothing of it"
    )


def test_do_mpc_plans_with_forward_dynamics() -> None:
    do_mpc = imported("do_mpc")
    forward = functions()["yaw3pitch_forward_dynamics"]
    made = do_mpc.model.Model("continuous", "SX")
    q, dq = (made.set_variable("_x", name, shape=(N, 1)) for name in ("q", "dq"))
    effort = made.set_variable("_u", "effort", shape=(N, 1))
    made.set_rhs("q", dq)
    made.set_rhs("dq", forward(q, dq, effort, parameters()))
    made.setup()
    mpc = do_mpc.controller.MPC(made)
    mpc.settings.n_horizon = STEPS
    mpc.settings.t_step = DURATION / STEPS
    mpc.settings.store_full_solution = True
    mpc.settings.supress_ipopt_output()
    end = 1e5 * ca.sumsqr(q - GOAL) + 1e4 * ca.sumsqr(dq)
    mpc.set_objective(mterm=end, lterm=ca.sumsqr(dq) + 1e-4 * ca.sumsqr(effort))
    mpc.set_rterm(effort=np.zeros(N))
    mpc.bounds["lower", "_u", "effort"], mpc.bounds["upper", "_u", "effort"] = -EFFORT, EFFORT
    mpc.setup()
    mpc.x0 = np.concatenate([START, np.zeros(N)])
    mpc.set_initial_guess()
    first = mpc.make_step(mpc.x0)
    assert mpc.solver_stats["success"]
    efforts = (
        np.array([mpc.opt_x_num["_u", k, 0].full().ravel() for k in range(STEPS)])
        * mpc.opt_x_scaling["_u", 0, 0].full().ravel()
    )
    np.testing.assert_allclose(first.ravel(), efforts[0])
    reached = integrated(efforts)
    planned = np.array([mpc.opt_x_num["_x", k, 0, -1].full().ravel() for k in range(STEPS + 1)])
    np.testing.assert_allclose(planned, reached, atol=2e-3)
    np.testing.assert_allclose(reached[-1], [*GOAL, 0, 0, 0, 0], atol=0.02)
