"""The momentum observer against Pinocchio and against motions, the monitor against batch least squares."""

import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from arms_support import ARMS, base_vector, inputs, model, standard_vector
from c_support import C_COMPILERS, Library, flat_c, shared_library, write
from witness.arms import Emitted, build, random_arm, shipped
from witness.bodies import random_bodies
from witness.mechanism import states
from witness.rigid_bodies import RigidBodies

from modelgen.backends import NumpyFunction
from modelgen.description import Watched, loads
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.functions import EVALUATED, Function, Model, Options, build_model
from modelgen.functions.nominal import grouped, nominal_base
from modelgen.generation.arm import print_model
from modelgen.options.noise import Noise

Array = np.ndarray
LINKS = Options(without=frozenset({"drives", "effects"}))
STATUS_INPUT = 4


def function(made: Model, name: str) -> Function:
    return next(f for f in made.functions if f.name == name)


# -- momentum observer ---------------------------------------------------------------------------

PLAIN = [
    *(pytest.param(lambda n=n: shipped(n, "links"), id=n) for n in ("ur10e", "scara")),
    *(pytest.param(lambda s=s: build(random_arm(s), LINKS), id=f"random{s}") for s in (4, 32)),
    pytest.param(lambda: shipped("two_fingers", "links"), id="two_fingers"),
]


@pytest.mark.parametrize("make", PLAIN)
def test_the_momentum_of_links_changes_as_pinocchio_has_it(make: Callable[[], Emitted]) -> None:
    """d(M dq)/dt = effort + C' dq - g, with C of Christoffel symbols."""
    emitted = make()
    arm = emitted.arm
    n = len(arm.coordinates)
    bodies = random_bodies(arm, np.random.default_rng(3))
    witness = RigidBodies(arm, bodies)
    standard = np.concatenate([body.ten for body in bodies])
    dt, gain, effort = 0.5, np.linspace(0.1, 1.0, n), np.linspace(-3.0, 2.0, n)
    for q, dq, _ in zip(*states(arm, 3), strict=True):
        full = witness._q(q), witness._full(dq)
        coriolis = np.array(pin.computeCoriolisMatrix(witness.model, witness.data, *full))
        mass = np.array(pin.crba(witness.model, witness.data, full[0]))
        mass = np.triu(mass) + np.triu(mass, 1).T
        gravity = np.array(pin.computeGeneralizedGravity(witness.model, witness.data, full[0]))
        momentum = (mass @ full[1])[witness.places]
        forces = effort + (coriolis.T @ full[1] - gravity)[witness.places]
        before = momentum - 0.3
        for suffix, parameters in (("", emitted.base(standard)), ("_standard", standard)):
            after, external = emitted(
                f"momentum_observer_step{suffix}", q, dq, effort, [dt], gain, parameters, before
            )
            np.testing.assert_allclose(external, 0.3 * gain, rtol=1e-9, atol=1e-12 * np.abs(momentum).max())
            expected = before + dt * (forces + 0.3 * gain)
            np.testing.assert_allclose(after, expected, rtol=1e-10, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("name", ["ariane4", "ur10e", "yaw3pitch"])
def test_an_effort_from_outside_comes_through_a_low_pass(name: str) -> None:
    """Along a motion of the arm with its drives and effects, to which an effort is added at once."""
    made = model(name, "default" if name == "ariane4" else "links")
    n = len(made.arm.coordinates)
    of = {f.name: NumpyFunction(f) for f in made.functions}
    parameters = np.array(list(nominal_base(made).values()))
    q = inputs(made, function(made, "gravity"), np.random.default_rng(4))[0]
    dq, dt, gain, moment = np.full(n, 0.3), 2e-4, 100.0, 2.0
    state = of["mass_matrix"](q, parameters) @ dq
    held = of["bias"](q, dq, parameters)
    for k in range(300):
        outside = np.full(n, moment if k >= 100 else 0.0)
        expected = outside * (1 - (1 - gain * dt) ** (k - 100))
        after, external = of["momentum_observer_step"](q, dq, held, [dt], np.full(n, gain), parameters, state)
        np.testing.assert_allclose(external, expected, atol=0.02 * moment)
        whole = held + outside / of["drive_gain"](q)
        middle = of["forward_dynamics"](q, dq, whole, parameters)  # midpoint rule
        at = q + 0.5 * dt * dq, dq + 0.5 * dt * middle
        q, dq, state = q + dt * at[1], dq + dt * of["forward_dynamics"](*at, whole, parameters), after


def test_a_gain_or_a_step_out_of_range_is_a_status(watching: tuple[Model, Library, Path]) -> None:
    made, library, _ = watching
    f = function(made, "momentum_observer_step")
    names = [a.name for a in f.arguments]
    good = dict(zip(names, inputs(made, f, np.random.default_rng(5)), strict=True))
    assert library.call(f.name, *good.values())[0] == 0
    for name, bad in (("gain", -1.0), ("gain", 2e4), ("gain", 1001.0), ("dt", -1e-3), ("dt", 2.0)):
        status, found = library.call(f.name, *{**good, name: np.full_like(good[name], bad)}.values())
        assert status == STATUS_INPUT, (name, bad)
        assert not flat_c(found).any()


# -- monitor -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def watching(tmp_path_factory: pytest.TempPathFactory) -> tuple[Model, Library, Path]:
    made = model("ariane4")
    folder = tmp_path_factory.mktemp("watch")
    write(print_model(made, made.arm, {}).files, folder)
    return made, Library(shared_library(folder, "ariane4", "double"), made, "double"), folder


@pytest.mark.parametrize("suffix", ["", "_standard", "_identified"])
@pytest.mark.parametrize("name", ["ariane4", "ur10e"])
def test_the_monitor_is_weighted_least_squares(name: str, suffix: str) -> None:
    """The same as a batch over the regressor's columns, each step's rows weighted by forgetting^age."""
    arm = ARMS[name]
    n = len(arm.coordinates)
    noise = Noise(
        tuple(0.1 + 0.05 * k for k in range(n)), (1.0,) * n, (0.2,) * n, (1.0,) * n, (1.0,) * n, 1.0, 1.0
    )
    given = base_vector(model(name), standard_vector(model(name), np.random.default_rng(1)))
    names = [b.name for b in model(name).grouping.base]
    identified = dict(zip(names, given, strict=True)) if suffix == "_identified" else {}
    made = build_model(arm, Options(derivatives=False, noise=noise, identified=identified))
    rng = np.random.default_rng(6)
    step = NumpyFunction(function(made, f"monitor_step{suffix}"))
    of_effort = "_standard" if suffix == "_standard" else ""
    regressor = NumpyFunction(function(made, f"regressor{of_effort}"))
    known = [p.name for p in made.standard] if of_effort else names
    parameters = standard_vector(made, rng) if of_effort else given
    monitored = [w.name for w in arm.monitor]
    directions = np.zeros((len(known), len(monitored)))
    for k, one in enumerate(monitored):
        if one in known:
            directions[known.index(one), k] = 1.0
        else:
            unit = [float(p.name == one) for p in made.standard]
            directions[:, k] = list(grouped(made, unit).values())
    forgetting, state = 0.97, np.zeros(step.function.outputs[0].size)
    normal, right = np.zeros((3, 3)), np.zeros(3)
    for _ in range(60):
        q, dq, ddq, measured = inputs(made, step.function, rng)[:4]
        columns = regressor(q, dq, ddq) @ directions
        error = measured - regressor(q, dq, ddq) @ parameters
        weights = np.array(noise.input) ** -2 * (np.abs(dq) > 0.2)
        normal = forgetting * normal + columns.T @ (weights[:, None] * columns)
        right = forgetting * right + columns.T @ (weights * error)
        last = [] if suffix == "_identified" else [parameters]
        state = step(q, dq, ddq, measured, [forgetting], *last, state)
    start = [parameters[known.index(one)] if one in known else 0.0 for one in monitored]
    deviations = np.sqrt(np.diag(np.linalg.inv(normal)))
    change = np.linalg.solve(normal, right)
    np.testing.assert_allclose(state[:3] - start, change, rtol=1e-8, atol=1e-9 * np.abs(start).max())
    np.testing.assert_allclose(state[3:6], deviations, rtol=1e-8)


def test_at_rest_nothing_is_learned(watching: tuple[Model, Library, Path]) -> None:
    """Nor lost but by forgetting: dry friction at rest says nothing, and no information is no change."""
    made, library, _ = watching
    f = function(made, "monitor_step")
    q, dq, ddq, measured, _, parameters, _ = inputs(made, f, np.random.default_rng(7))
    names = [b.name for b in made.grouping.base]
    start = [parameters[names.index("FC2")], parameters[names.index("FV2")], 0.0]
    state = np.zeros(f.outputs[0].size)
    status, found = library.call(f.name, q, 0 * dq, ddq, measured, [0.9], parameters, state)
    assert status == 0
    np.testing.assert_array_equal(found["out"][:6], [*start, 0, 0, 0])
    some = [inputs(made, f, np.random.default_rng(k)) for k in range(50)]
    for k in range(3000):
        moving, given = k < 50, some[k % 50]
        status, found = library.call(
            f.name, given[0], given[1] if moving else 0 * dq, given[2], given[3], [0.9], parameters, state
        )
        assert status == 0
        state = found["out"]
    np.testing.assert_allclose(state[:3], start, rtol=1e-12)


def test_a_forgetting_factor_out_of_range_is_a_status(watching: tuple[Model, Library, Path]) -> None:
    made, library, _ = watching
    f = function(made, "monitor_step")
    given = inputs(made, f, np.random.default_rng(8))
    for bad in (0.0, 0.4, 1.01, np.nan):
        given[4] = np.array([bad])
        status, found = library.call(f.name, *given)
        assert status == STATUS_INPUT
        assert not flat_c(found).any()


@pytest.mark.skipif("gcc" not in C_COMPILERS, reason="gcc warns of it")
def test_a_compiler_warns_of_a_state_that_is_too_short(watching: tuple[Model, Library, Path]) -> None:
    _, _, folder = watching
    program = """#include "ariane4.h"
int f(const double x[3], const double one[1], const double parameters[ARIANE4_N_PARAMETERS]);
int f(const double x[3], const double one[1], const double parameters[ARIANE4_N_PARAMETERS])
{
    double state[%s] = {0}, after[%s];
    return (int)ariane4_monitor_step(x, x, x, x, one, parameters, state, after);
}
"""
    found = []
    for length in ("ARIANE4_N_MONITOR_STATES", "ARIANE4_N_MONITOR_STATES - 1", "ARIANE4_N_OBSERVER_STATES"):
        (folder / "short.c").write_text(program % (length, length), encoding="utf-8")
        command = ["gcc", "-O2", "-Wall", "-c", "short.c", "-Iinclude", "-o", "short.o"]
        found.append(subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stderr)
    assert not found[0]
    assert "ariane4_monitor_step" in found[1]
    assert "ariane4_monitor_step" in found[2]


TEXT = """schema: 1
convention: khalil_kleinfinger
arms:
  bench:
    monitor: [%s]
    joints:
      - {name: j1, drive: {type: direct, ratio: 100, torque_constant: 0.1}}
      - {name: j2, d: 0.3}
"""


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (
            "FC1, FC3",
            "arms.yaml:5:20: monitor: found 'FC3', expected base or standard parameters of the arm, did you "
            "mean 'FC1'? (available: ",
        ),
        ("FC1, M2, FC1", "arms.yaml:5:24: monitor: found 'FC1' twice, expected each once"),
        ("XX1", "arms.yaml:5:15: monitor: XX1 has no effect on the inputs of this arm"),
    ],
)
def test_what_does_not_exist_is_refused_with_what_does(names: str, message: str) -> None:
    (arm,) = loads(TEXT % names, "arms.yaml", known_effects()).values()
    with pytest.raises(InputError) as caught:
        build_model(arm)
    assert str(caught.value).startswith(message)
    build_model(arm, EVALUATED)  # nothing is monitored where nothing is emitted


def test_an_arm_without_the_watch_has_neither() -> None:
    made = build_model(replace(ARMS["gravity_arm"], monitor=(Watched("FC1"),)), Options(watch=False))
    assert not [f.name for f in made.functions if "observer" in f.name or "monitor" in f.name]
