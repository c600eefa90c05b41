"""Derivatives of the dynamics against Pinocchio, and against differences with a hundred digits."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from arms_support import ARMS, inputs, model
from mpmath import MPContext
from witness.arms import Emitted, build, random_arm, shipped
from witness.bodies import random_bodies
from witness.mechanism import states
from witness.program import run
from witness.rigid_bodies import RigidBodies

from modelgen.backends import NumpyFunction
from modelgen.description import Arm
from modelgen.evaluation import with_effect
from modelgen.functions import Function, Model, Options, build_model

Array = np.ndarray
LINKS = Options(without=frozenset({"drives", "effects"}))
MP = MPContext()
MP.dps = 100
STEP = MP.mpf(10) ** -40
NAMES = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "tanh")
CALLS: Mapping[str, Callable[..., Any]] = {
    **{name: getattr(MP, name) for name in NAMES},
    "abs": abs,
    "min": min,
    "max": max,
    "pow": lambda x, y: x**y,
    "sign": lambda x: MP.mpf(int(x > 0) - int(x < 0)),
    "select": lambda c, a, b: a if c > 0 else b,
}
BY = {"inverse_dynamics": ("q", "dq", "ddq"), "forward_dynamics": ("q", "dq", "input")}


def agree_by_rows(found: Array, expected: Array, tolerance: float) -> None:
    """Each row has its own unit and size; a row of zeros may hold the rounding of the largest."""
    allowed = tolerance * np.abs(expected).max(axis=-1, keepdims=True) + 1e-14 * np.abs(expected).max()
    assert np.isfinite(found).all()
    assert (np.abs(found - expected) <= allowed).all()


# -- plain links --------------------------------------------------------------------------------

PLAIN = [
    *(pytest.param(lambda n=n: shipped(n, "links"), id=n) for n in ("ur10e", "iiwa14", "scara")),
    *(pytest.param(lambda s=s: build(random_arm(s), LINKS), id=f"random{s}") for s in (4, 32)),
    pytest.param(lambda: shipped("two_fingers", "links"), id="two_fingers"),
]


@pytest.mark.parametrize("make", PLAIN)
def test_of_links_as_pinocchio_has_them(make: Callable[[], Emitted]) -> None:
    emitted = make()
    arm = emitted.arm
    bodies = random_bodies(arm, np.random.default_rng(3))
    witness = RigidBodies(arm, bodies)
    standard = np.concatenate([body.ten for body in bodies])
    of_places = np.ix_(witness.places, witness.places)
    for q, dq, ddq in zip(*states(arm, 3), strict=True):
        full = witness._q(q), witness._full(dq)
        by_q, by_dq, by_ddq = (
            np.array(m)[of_places]
            for m in pin.computeRNEADerivatives(witness.model, witness.data, *full, witness._full(ddq))
        )
        by_ddq = np.triu(by_ddq) + np.triu(by_ddq, 1).T
        effort = witness.effort(q, dq, ddq)
        theirs = pin.computeABADerivatives(witness.model, witness.data, *full, witness._full(effort))
        for suffix, parameters in (("", emitted.base(standard)), ("_standard", standard)):
            value, *found = emitted(f"inverse_dynamics_derivatives{suffix}", q, dq, ddq, parameters)
            np.testing.assert_allclose(value, effort, rtol=1e-10, atol=1e-10 * np.abs(effort).max())
            for ours, his in zip(found, (by_q, by_dq, by_ddq), strict=True):
                agree_by_rows(ours.reshape(his.shape), his, 1e-10)
            value, *found = emitted(f"forward_dynamics_derivatives{suffix}", q, dq, effort, parameters)
            np.testing.assert_allclose(value, ddq, rtol=1e-9, atol=1e-9 * np.abs(ddq).max())
            for ours, his in zip(found, theirs, strict=True):
                agree_by_rows(ours.reshape(by_q.shape), np.array(his)[of_places], 1e-9)


# -- drives and effects -------------------------------------------------------------------------


def exact(function: Function, given: Mapping[str, Any]) -> list[Any]:
    """Outputs of a function to a hundred digits."""
    found = run(function.program, given, MP.mpf, CALLS).outputs
    return [found.get((o.name, i), MP.mpf(0)) for o in function.outputs for i in range(o.size)]


def differences(
    function: Function, given: Mapping[str, Array], by: str, ends: tuple[int, int] = (1, -1)
) -> Array:
    """Jacobian (outputs, inputs) by differences between two steps on either side of each element."""
    columns = []
    for k in range(len(given[by])):
        values = []
        for end in ends:
            moved = {name: [MP.mpf(float(x)) for x in values] for name, values in given.items()}
            moved[by][k] += end * STEP
            if by == "q" and "sin_q" in moved:
                moved["sin_q"][k], moved["cos_q"][k] = MP.sin(moved["q"][k]), MP.cos(moved["q"][k])
            values.append(exact(function, moved))
        width = STEP * (ends[0] - ends[1])
        columns.append([float((a - b) / width) for a, b in zip(*values, strict=True)])
    return np.array(columns).T


def compare(made: Model, name: str, suffix: str, rest: bool = False, tolerance: float = 1e-10) -> None:
    """Derivatives at a random state, or at rest, where the mean of both sides is meant."""
    functions = {f.name: f for f in made.functions}
    value, derived = functions[f"{name}{suffix}"], functions[f"{name}_derivatives{suffix}"]
    rng = np.random.default_rng(5)
    given = dict(zip((a.name for a in derived.arguments), inputs(made, derived, rng), strict=True))
    if rest:
        given["dq"] = 0 * given["dq"]
    known = {a.name: given[a.name] for a in value.arguments}
    outputs = NumpyFunction(derived)(**given)
    expected = [float(x) for x in exact(value, {n: [MP.mpf(float(x)) for x in v] for n, v in known.items()})]
    agree_by_rows(np.array([outputs[0]]), np.array([expected]), tolerance)
    for by, found in zip(BY[name], outputs[1:], strict=True):
        wanted = differences(value, known, by)
        if rest and by == "dq":
            wanted = sum(differences(value, known, by, ends) for ends in ((2, 1), (-1, -2))) / 2
        agree_by_rows(found.reshape(wanted.shape), wanted, tolerance)


@pytest.mark.parametrize(
    ("name", "suffix"), [("ariane4", ""), ("ariane4_free", "_standard"), ("scara", ""), ("two_fingers", "")]
)
def test_with_drives_and_friction(name: str, suffix: str) -> None:
    for function in BY:
        compare(model(name), function, suffix)


@pytest.mark.parametrize("seed", [3, 7])
def test_of_random_arms_with_levers_and_slides(seed: int) -> None:
    made = build_model(random_arm(seed, dressed=True))
    for function in BY:
        compare(made, function, "", tolerance=1e-9)


@pytest.mark.parametrize("variant", ["sincos", "runtime_geometry"])
def test_whatever_the_options(variant: str) -> None:
    for function in BY:
        compare(model("ariane4", variant), function, "")


# Two arms share the effects out: one with levers, one that is quick with forces along its links.
EFFECTS_OF = {
    "ariane4": [
        ("joint_flexibility", 1, {"stiffness": 50.0, "damping": 2.0}),
        ("stribeck_friction", 2, {"velocity": 0.5, "exponent": 0.7}),
        ("torque_ripple", 2, {"harmonic": 2.0, "revolution": 20000.0}),
        ("torque_constant_saturation", 3, {"coefficient": 1e-3}),
        ("friction_warm_up", 3, {"time": 5.0, "speed": 1e4}),
        ("load_dependent_friction", 3, {}),
    ],
    "gravity_arm": [
        ("drive_inertia", 1, {}),
        ("backlash", 1, {"play": 0.0001, "stiffness": 50.0}),
        ("transmission_coupling", 2, {"other": 1.0}),
        ("presliding", 2, {"distance": 1.0}),
        ("fluid_drag", None, {}),
        ("added_mass", None, {}),
        ("payload_change", None, {"mass": 0.4, "z": 0.1}),
        ("base_tilt", None, {"x": 0.05}),
    ],
}


@pytest.mark.parametrize("name", sorted(EFFECTS_OF))
def test_with_effects_of_every_kind(name: str) -> None:
    arm = ARMS[name]
    for effect, joint, values in EFFECTS_OF[name]:
        arm = with_effect(arm, effect, joint, values)
    made = build_model(arm)
    for function in BY:
        compare(made, function, "_standard", tolerance=1e-9)


def test_row_by_row() -> None:
    compare(model("ariane4", "row_wise"), "inverse_dynamics", "")


def frictions(*uses: tuple[str, dict[str, float]]) -> Arm:
    arm = ARMS["gravity_arm"]
    for effect, values in uses:
        arm = with_effect(arm, effect, 1, values)
    return arm


@pytest.mark.parametrize(
    "uses",
    [
        [("coulomb_friction", {})],
        [("stribeck_friction", {"velocity": 0.3, "exponent": 1.0})],
        [("stribeck_friction", {"velocity": 0.3, "exponent": 2.0})],
        [("asymmetric_viscous_friction", {}), ("position_dependent_friction", {})],
        [("nonlinear_viscous_friction", {"exponent": 1.4}), ("load_dependent_friction", {})],
    ],
)
def test_at_rest_the_mean_of_both_sides(uses: list[tuple[str, dict[str, float]]]) -> None:
    made = build_model(frictions(*uses))
    for function in BY:
        compare(made, function, "", rest=True)


def test_an_infinite_slope_at_rest_counts_as_none() -> None:
    """Below an exponent of one friction rises without bound at rest; a controller still gets numbers."""
    made = build_model(frictions(("nonlinear_viscous_friction", {"exponent": 0.5})))
    function = next(f for f in made.functions if f.name == "inverse_dynamics_derivatives")
    given = {a.name: np.full(a.size, 0.3) for a in function.arguments} | {"dq": np.zeros(2)}
    assert all(np.isfinite(x).all() for x in NumpyFunction(function)(**given))


def test_an_arm_can_do_without() -> None:
    made = build_model(ARMS["gravity_arm"], Options(derivatives=False))
    assert not [f.name for f in made.functions if "derivatives" in f.name]
    assert len(build_model(ARMS["gravity_arm"]).functions) == len(made.functions) + 4
