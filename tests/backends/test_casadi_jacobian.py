"""with_jacobian: the dynamics in CasADi with the emitted derivatives, against its own differentiation."""

from collections.abc import Callable
from functools import cache
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from arms_support import ARMS, inputs, model

from modelgen.backends import Provenance, casadi_files
from modelgen.functions import Options, build_model, nominal_base

PROVENANCE = Provenance("modelgen test", "0" * 64)
# Direct drives, levers, joint efforts and a fourth link behind a locked joint, prismatic joints, a tree.
NAMES = ["yaw3pitch", "ariane4", "ur10e", "scara", "two_fingers"]

Dynamics = Callable[..., ca.MX]


@cache
def module(name: str, derivatives: bool = True) -> Any:
    made: Any = ModuleType("generated")
    (text,) = casadi_files(build_model(ARMS[name], Options(derivatives=derivatives)), PROVENANCE).values()
    exec(text, made.__dict__)  # noqa: S102 - the text under test
    return made


def jacobians(function: ca.Function, names: list[str]) -> ca.Function:
    """By the inputs of these names, as a caller's graph has them."""
    given = [ca.MX.sym(n, function.size1_in(n)) for n in function.name_in()]
    value = function(*given)
    return ca.Function("jacobians", given, [ca.jacobian(value, given[function.index_in(n)]) for n in names])


@pytest.mark.parametrize("suffix", ["", "_standard"])
@pytest.mark.parametrize(
    ("kind", "names"), [("inverse", ["q", "dq", "ddq"]), ("forward", ["q", "dq", "input"])]
)
@pytest.mark.parametrize("name", NAMES)
def test_the_jacobian_is_casadis_own(name: str, kind: str, names: list[str], suffix: str) -> None:
    made, full = module(name), f"{name}_{kind}_dynamics{suffix}"
    plain, derived = made.function(full), made.with_jacobian(full)
    assert (derived.name_in(), derived.name_out()) == (plain.name_in(), plain.name_out())
    own, given = jacobians(plain, names), jacobians(derived, names)
    assert f"jac_{full}" in {f.name() for f in given.find_functions()}
    assert f"jac_{full}" not in {f.name() for f in own.find_functions()}
    function = next(f for f in model(name).functions if f.name == f"{kind}_dynamics{suffix}")
    rng = np.random.default_rng(3)
    for _ in range(3):
        values = inputs(model(name), function, rng)
        np.testing.assert_array_equal(derived(*values).full(), plain(*values).full())
        for mine, other in zip(given(*values), own(*values), strict=True):
            assert abs(other.full()).max() > 0
            np.testing.assert_allclose(
                mine.full(), other.full(), rtol=0, atol=1e-10 * abs(other.full()).max()
            )


def step(dynamics: Dynamics, x: ca.MX, u: ca.MX, h: float) -> ca.MX:
    """Runge-Kutta 4."""
    n = u.numel()

    def slope(state: ca.MX) -> ca.MX:
        return ca.vertcat(state[n:], dynamics(state[:n], state[n:], u))

    a = slope(x)
    b = slope(x + h / 2 * a)
    c = slope(x + h / 2 * b)
    d = slope(x + h * c)
    return x + h / 6 * (a + 2 * b + 2 * c + d)


def integrated(plugin: str, options: dict[str, Any]) -> Callable[[Dynamics, ca.MX, ca.MX, float], ca.MX]:
    def final(dynamics: Dynamics, x: ca.MX, u: ca.MX, h: float) -> ca.MX:
        n = u.numel()
        state, held = ca.MX.sym("state", 2 * n), ca.MX.sym("held", n)
        ode = ca.vertcat(state[n:], dynamics(state[:n], state[n:], held))
        made = ca.integrator("made", plugin, {"x": state, "u": held, "ode": ode}, 0, h, options)
        return made(x0=x, u=u)["xf"]

    return final


@pytest.mark.parametrize(
    ("final", "tolerance"),
    [
        pytest.param(step, 1e-10, id="rk4"),
        pytest.param(integrated("rk", {"number_of_finite_elements": 4}), 1e-10, id="rk"),
        pytest.param(integrated("collocation", {"number_of_finite_elements": 2}), 1e-10, id="collocation"),
        # Its steps follow the error, which rounding moves.
        pytest.param(integrated("cvodes", {"abstol": 1e-11, "reltol": 1e-11}), 1e-8, id="cvodes"),
    ],
)
def test_sensitivities_through_an_integrator_are_the_same(
    final: Callable[[Dynamics, ca.MX, ca.MX, float], ca.MX], tolerance: float
) -> None:
    made, n = module("yaw3pitch"), 4
    parameters = ca.DM(list(nominal_base(model("yaw3pitch")).values()))
    start, effort = np.array([0.3, 0.6, -0.9, 0.4, 0.5, -0.4, 0.3, -0.2]), np.array([5.0, -3.0, 2.0, 1.0])
    results = []
    for found in (made.function, made.with_jacobian):
        dynamics = found("yaw3pitch_forward_dynamics")
        x, u = ca.MX.sym("x", 2 * n), ca.MX.sym("u", n)
        value = final(lambda q, dq, held, f=dynamics: f(q, dq, held, parameters), x, u, 0.05)
        whole = ca.Function("whole", [x, u], [value, ca.jacobian(value, x), ca.jacobian(value, u)])
        results.append([r.full() for r in whole(start, effort)])
    for mine, other in zip(*results, strict=True):
        assert np.isfinite(other).all()
        np.testing.assert_allclose(mine, other, rtol=0, atol=tolerance * abs(other).max())
    moved = abs(results[0][0].ravel() - start)
    assert (moved > 1e-3).all()


def test_an_arm_without_derivatives_has_none() -> None:
    assert not hasattr(module("ariane4", derivatives=False), "with_jacobian")
    with pytest.raises(KeyError):
        module("ariane4").with_jacobian("ariane4_gravity")
