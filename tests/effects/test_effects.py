"""Effects: each law holds at every joint and drive, in every unit, and what is derived from it agrees."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from witness.arms import ARMS, Emitted, build
from witness.bodies import random_bodies
from witness.compare import agree
from witness.levers import Drive
from witness.mechanism import states

from modelgen.description import Arm, DirectDrive, EffectUse, Joint, LeveredDrive, NoDrive
from modelgen.description import Drive as Description
from modelgen.effects import (
    CATALOGUE,
    BodyEffect,
    Effect,
    Parameter,
    Variables,
    applied_effects,
    catalogue,
    known_effects,
)
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.model.parameters import unit_of

TWO_PI = 2 * math.pi


def lever(scale: float = 1.0, constant: float = 4e-3) -> LeveredDrive:
    """`scale`: motor units to an increment."""
    return LeveredDrive(0.32, 0.07, (0.26, 0.38), (100.0 * scale, 9000.0 * scale), -1, 0.8, constant / scale)


DRIVES: dict[str, tuple[str, Description]] = {
    "none": ("revolute", NoDrive()),
    "gear": ("revolute", DirectDrive(-50.0, 0.1)),
    "lever": ("revolute", lever()),
    "screw": ("prismatic", DirectDrive(TWO_PI / 0.01, 0.1)),
    "slide": ("prismatic", NoDrive()),
}


# Forces over one coordinate of one joint, and the drives that each can stand at.
LOCAL = [
    n
    for n, e in CATALOGUE.items()
    if issubclass(e, BodyEffect) or (issubclass(e, Effect) and e.place in ("motor", "joint"))
]
PLACES = [(n, d) for n in LOCAL for d in DRIVES if n != "actuator_mass" or d == "lever"]


def needed(name: str, at: float = 300.0) -> dict[str, float]:
    """Values for the nonlinear parameters that have no default, or one in the unit of the coordinate."""
    if name == "torque_ripple":  # slow enough for differences over the stroke of a lever
        return {"harmonic": 1.5, "revolution": 300.0}
    return {
        p.name: min(max(at, p.bounds[0]), p.bounds[1]) if p.default is None else p.default
        for p in CATALOGUE[name].nonlinear
        if p.default is None or (p.default and "{x}" in p.unit)
    }


def one_joint(drive: Description, *uses: EffectUse, kind: str = "revolute") -> Arm:
    joint = Joint("j1", kind, alpha=0.4, drive=drive, effects=uses)
    return Arm("one", (joint,), (None,), (3.0, 9.0, -1.0))


def call(
    emitted: Emitted,
    name: str,
    *inputs: np.ndarray,
    state: np.ndarray | None = None,
    load: np.ndarray | None = None,
) -> np.ndarray:
    """With the states at `state`, the load and a time where the function takes them."""
    takes = [a.name for a in emitted.functions[name].arguments]
    more = {"state": state, "time": [0.7], "load": np.zeros_like(inputs[0]) + 2.0 if load is None else load}
    return np.asarray(emitted(name, *inputs, **{k: v for k, v in more.items() if k in takes}))


def loads(emitted: Emitted, q: np.ndarray, theta: np.ndarray) -> np.ndarray | None:
    """What the drives carry, where an effect asks for it."""
    return emitted("load_standard", q, theta) if "load_standard" in emitted.functions else None


def random_state(emitted: Emitted, samples: int = 8) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """q, dq, ddq and a standard vector with effects of about the size of the rest."""
    rng = np.random.default_rng(9)
    links = np.concatenate([body.ten for body in random_bodies(emitted.arm, rng)])
    q, dq, ddq = states(emitted.arm, samples)
    state = np.full(len(emitted.model.states), 0.3)
    columns = (
        call(emitted, "regressor_standard", q, dq, ddq, state=state) * emitted("drive_gain", q)[:, :, None]
    )
    extra = rng.uniform(3, 6, columns.shape[2] - len(links))
    return q, dq, ddq, np.concatenate([links, extra / np.abs(columns).max(axis=(0, 1))[len(links) :]])


@pytest.mark.parametrize(("name", "drive"), PLACES)
def test_columns_are_what_a_unit_of_each_parameter_adds(name: str, drive: str) -> None:
    kind, description = DRIVES[drive]
    use = EffectUse(name, needed(name))
    with_effect = build(one_joint(description, use, kind=kind), Options())
    without = build(one_joint(description, kind=kind), Options())
    q, dq, ddq, theta = random_state(with_effect)
    state = np.full(len(with_effect.model.states), 0.3)
    bare = without("inverse_dynamics_standard", q, dq, ddq, theta[:10])
    load = loads(with_effect, q, theta)
    columns = call(with_effect, "regressor_standard", q, dq, ddq, state=state, load=load)
    assert columns.shape[2] == 10 + len(CATALOGUE[name].linear)
    expected = bare.copy()
    for k in range(10, columns.shape[2]):
        expected += columns[:, :, k] * theta[k]
        assert np.abs(columns[:, :, k]).max() > 0
        more = theta.copy()
        more[k] *= 3.0
        found = call(with_effect, "inverse_dynamics_standard", q, dq, ddq, more, state=state)
        before = call(with_effect, "inverse_dynamics_standard", q, dq, ddq, theta, state=state)
        agree(found - before + bare, 2 * theta[k] * columns[:, :, k] + bare)
    agree(call(with_effect, "inverse_dynamics_standard", q, dq, ddq, theta, state=state), expected)
    agree(call(with_effect, "forward_dynamics_standard", q, dq, expected, theta, state=state), ddq)


def test_units_of_what_changes_over_the_position_have_the_joints_own() -> None:
    """Slope and curvature of dry friction are forces at the drive over a joint's angle or travel."""
    slope, curvature = (p.unit for p in CATALOGUE["position_dependent_friction"].linear)
    assert [unit_of(slope, *at) for at in (("rad", "rad"), ("m", "m"), ("unit", "rad"), ("m", "rad"))] == [
        "N m/rad", "N/m", "J/(unit rad)", "N/rad",
    ]  # fmt: skip
    assert unit_of(curvature, "unit", "rad") == "J/(unit rad^2)"
    assert unit_of(curvature, "rad") == "N m/rad^2"


@pytest.mark.parametrize("name", LOCAL)
def test_the_unit_of_the_motor_coordinate_changes_nothing(name: str) -> None:
    """Increments, or a thousandth of them: parameters follow the unit that they are printed with."""
    factor = 1e-3

    def converted(unit: str) -> float:
        under = unit.partition("/")[2].strip("()").split()
        over = unit.partition("/")[0].split()
        exponent = 0
        for sign, parts in ((1, over), (-1, under)):
            for part in parts:
                base, _, power = part.partition("^")
                exponent += sign * int(power or 1) * (base == "unit")
        return factor**exponent

    effect = CATALOGUE[name]
    coordinate = "unit" if effect.side == "motor" else "rad"
    values = needed(name)
    other = {
        p.name: values[p.name] * converted(unit_of(p.unit, coordinate))
        for p in effect.nonlinear
        if p.name in values
    }
    one = build(one_joint(lever(), EffectUse(name, values)), Options())
    two = build(one_joint(lever(factor), EffectUse(name, other)), Options())
    q, dq, ddq, theta = random_state(one)
    same = theta * np.array([converted(p.unit) for p in one.model.standard])
    state = np.full(len(one.model.states), 0.3)
    first = call(one, "inverse_dynamics_standard", q, dq, ddq, theta, state=state)
    second = call(two, "inverse_dynamics_standard", q, dq, ddq, same, state=state)
    agree(second, first)
    without = theta.copy()
    without[10:] = 0
    plain = call(one, "inverse_dynamics_standard", q, dq, ddq, without, state=state)
    assert np.abs(first - plain).max() > 1e-6 * np.abs(plain).max()  # the effect does show


@pytest.mark.parametrize(("name", "drive"), PLACES)
def test_stored_energy_is_the_work_against_the_force(name: str, drive: str) -> None:
    """dU/dq by differences is the effort of a conservative effect; others store nothing."""
    kind, description = DRIVES[drive]
    emitted = build(one_joint(description, EffectUse(name, needed(name)), kind=kind), Options())
    q, _, _, theta = random_state(emitted)
    theta[:10] = 0.0
    zero, h = np.zeros_like(q), 1e-4

    def stored(x: np.ndarray) -> np.ndarray:
        return np.asarray(emitted("energy_standard", x, zero, theta)[1])

    slope = (8 * (stored(q + h) - stored(q - h)) - (stored(q + 2 * h) - stored(q - 2 * h))) / (12 * h)
    if emitted.model.states or not np.abs(slope).max():
        assert np.ptp(stored(q)) == 0.0
        return
    agree(slope, call(emitted, "gravity_standard", q, theta) * emitted("drive_gain", q), 1e-7)


def test_which_effects_store_energy() -> None:
    """By name, so that none is forgotten above."""
    conservative = []
    for name in LOCAL:
        emitted = build(one_joint(lever(), EffectUse(name, needed(name))), Options())
        q, _, _, theta = random_state(emitted)
        theta[:10] = 0.0
        if np.ptp(emitted("energy_standard", q, 0 * q, theta)[1]) > 0:
            conservative.append(name)
    assert set(conservative) == {"friction_offset", "spring", "torque_ripple", "actuator_mass"}


def force(use: EffectUse, velocity: float, drive: Description | None = None) -> float:
    """Input that a unit effect takes at a joint speed, on an arm that weighs nothing."""
    emitted = build(one_joint(drive or NoDrive(), use), Options())
    theta = np.zeros(len(emitted.model.standard))
    theta[10] = 1.0
    return float(emitted("bias_standard", [0.3], [velocity], theta)[0])


def test_friction_takes_power_whatever_the_sense_of_the_drive() -> None:
    for name in ("viscous_friction", "coulomb_friction", "stribeck_friction"):
        for drive in (NoDrive(), DirectDrive(-50.0, 0.1), lever()):
            use = EffectUse(name, needed(name))
            gain = Drive(one_joint(drive, use), 0).gain(0.3)
            for velocity in (-1.3, 0.7):
                assert force(use, velocity, drive) * gain * velocity > 0


def test_dry_friction_is_zero_at_rest_and_constant_else() -> None:
    use = EffectUse("coulomb_friction")
    assert [force(use, v) for v in (-2.0, -1e-9, 0.0, 1e-9, 2.0)] == [-1.0, -1.0, 0.0, 1.0, 1.0]


def test_smoothing_is_a_tanh_over_the_velocity_given() -> None:
    use = EffectUse("coulomb_friction", {"smoothing": 0.02})
    for v in (-0.5, -0.01, 0.0, 0.003, 0.02, 0.5):
        assert force(use, v) == pytest.approx(math.tanh(v / 0.02), rel=1e-14)
    assert force(use, 1.0) == 1.0


def test_the_stribeck_effect_falls_by_e_at_its_velocity() -> None:
    for exponent in (1.0, 2.0, 0.7):
        use = EffectUse("stribeck_friction", {"velocity": 0.05, "exponent": exponent})
        assert force(use, 0.05) == pytest.approx(math.exp(-1))
        assert force(use, -0.1) == pytest.approx(-math.exp(-(2.0**exponent)))
        assert force(use, 1e-12) == pytest.approx(1.0)
        assert force(use, 0.0) == 0.0
    assert force(EffectUse("stribeck_friction", {"velocity": 0.05}), 0.1) == pytest.approx(math.exp(-4))


def test_friction_offset_with_coulomb_is_asymmetric_coulomb() -> None:
    emitted = build(
        one_joint(NoDrive(), EffectUse("coulomb_friction"), EffectUse("friction_offset")), Options()
    )
    theta = np.zeros(12)
    theta[10:] = 1.0, 0.2
    assert [p.name for p in emitted.model.standard[10:]] == ["FC1", "FO1"]
    forward, back = (emitted("bias_standard", [0.0], [v], theta)[0] for v in (0.4, -0.4))
    assert (forward, back) == pytest.approx((1.2, -0.8))


def test_a_spring_rests_where_it_is_said_to() -> None:
    values = {"stiffness": 3.0, "rest": 0.25}
    (applied,) = applied_effects(one_joint(NoDrive(), EffectUse("spring", values)))
    assert applied.nominal == {"stiffness": 3.0, "preload": -0.75}
    emitted = build(one_joint(NoDrive(), EffectUse("spring")), Options())
    theta = np.zeros(12)
    theta[10:] = 3.0, -0.75
    assert emitted("gravity_standard", [0.25], theta)[0] == pytest.approx(0.0, abs=1e-15)
    assert emitted("gravity_standard", [1.25], theta)[0] == pytest.approx(3.0)


def test_joint_side_effects_feel_the_joint_and_motor_side_effects_the_motor() -> None:
    """A gear of ratio N: what acts at the motor is N^2 times as strong at the joint."""
    ratio, constant = -50.0, 0.1
    drive = DirectDrive(ratio, constant)
    gain = ratio * constant
    assert force(EffectUse("viscous_friction"), 0.7, drive) * gain == pytest.approx(ratio**2 * 0.7)
    emitted = build(one_joint(drive, EffectUse("spring")), Options())
    theta = np.zeros(12)
    theta[10] = 1.0
    assert emitted("gravity_standard", [0.7], theta)[0] * gain == pytest.approx(0.7)


# -- the mechanism: one class more is one effect more ----------------------------------------


class Bristle(Effect):
    """A throw-away effect: a bristle that bends (Dahl 1968), with a state and a nonlinear parameter."""

    name = "bristle"
    text = "for a test"
    reference = "Dahl 1968"
    linear = (Parameter("magnitude", "{f}", "force of a bent bristle", "FB"),)
    nonlinear = (Parameter("distance", "{x}", "distance over which it bends", bounds=(1e-9, 1e9)),)
    states = ("bend",)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        return p["magnitude"] * x.state["bend"]

    def step(self, x: Variables, p: Mapping[str, sp.Expr], dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        way = sp.sign(x.velocity)
        fall = sp.exp(-sp.Abs(x.velocity) * dt / p["distance"])
        return {"bend": way + (x.state["bend"] - way) * fall}


class Ripple(Effect):
    """Another: two linear parameters on one nonlinear one, over the motor's position."""

    name = "ripple"
    text = "for a test"
    reference = "none"
    linear = (Parameter("sine", "{f}", "amplitude", "RS"), Parameter("cosine", "{f}", "amplitude", "RC"))
    nonlinear = (Parameter("count", "1", "waves in a unit", default=3.0, bounds=(1.0, 100.0)),)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        angle = p["count"] * x.position
        return p["sine"] * sp.sin(angle) + p["cosine"] * sp.cos(angle)


class Carriage(Effect):
    """A mass on the joint's side: an effect that adds to the mass matrix."""

    name = "carriage"
    text = "for a test"
    reference = "none"
    side = "joint"
    linear = (Parameter("mass", "{f} s^2/{x}", "mass", "MC"),)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        return p["mass"] * x.acceleration


@pytest.fixture
def extended(monkeypatch: pytest.MonkeyPatch) -> None:
    for effect in (Bristle, Ripple, Carriage):
        monkeypatch.setitem(catalogue.CATALOGUE, effect.name, effect)


@pytest.mark.usefixtures("extended")
def test_a_new_effect_is_known_to_the_description() -> None:
    assert known_effects()["bristle"] == ("magnitude", "distance")


@pytest.mark.usefixtures("extended")
@pytest.mark.parametrize("drive", ["none", "gear", "lever"])
def test_a_state_enters_where_it_is_used_and_steps(drive: str) -> None:
    distance = 40.0
    arm = one_joint(DRIVES[drive][1], EffectUse("bristle", {"distance": distance}))
    emitted = build(arm, Options())
    assert emitted.model.states == ("bristle_bend_1",)
    takes = {f.name: [a.name for a in f.arguments] for f in emitted.model.functions}
    assert takes["inverse_dynamics"] == ["q", "dq", "ddq", "parameters", "state"]
    assert takes["gravity"] == ["q", "parameters", "state"]  # a bent bristle pushes at rest
    assert takes["forward_dynamics"] == ["q", "dq", "input", "parameters", "state"]
    assert takes["regressor"] == ["q", "dq", "ddq", "state"]
    assert takes["mass_matrix"] == ["q", "parameters"]
    assert takes["motor_from_joint"] == ["q", "dq", "ddq"]
    assert takes["effects_step"] == ["q", "dq", "dt", "parameters", "state"]
    q, dq, ddq, theta = random_state(emitted)
    witness = Drive(arm, 0)
    columns = emitted("regressor_standard", q, dq, ddq, state=[0.37])
    np.testing.assert_allclose(columns[:, 0, 10], 0.37 / witness.constant, rtol=1e-14)
    # exact step: as good as ten thousand small ones of the differential equation
    speed = (witness.k1(q) * dq)[:, 0]
    dt = 0.6 * distance / np.abs(speed).max()
    bend = np.full(len(q), -0.2)
    for _ in range(10000):
        middle = bend + dt / 2e4 * speed / distance * (1 - bend * np.sign(speed))
        bend += dt / 1e4 * speed / distance * (1 - middle * np.sign(speed))
    stepped = emitted(
        "effects_step_standard", q, dq, np.full((len(q), 1), dt), theta, np.full((len(q), 1), -0.2)
    )
    np.testing.assert_allclose(np.reshape(stepped, -1), bend, rtol=1e-8)
    base = emitted.base(theta)
    assert emitted("effects_step", q[0], [0.0], [1.0], base, [0.4]) == pytest.approx([0.4])


@pytest.mark.usefixtures("extended")
def test_a_nonlinear_parameter_is_fixed_by_the_description() -> None:
    arm = one_joint(DirectDrive(2.0, 0.5), EffectUse("ripple", {"count": 7.0}))
    emitted = build(arm, Options())
    q = np.linspace(-3, 3, 9)[:, None]
    columns = emitted("regressor_standard", q, 0 * q, 0 * q)
    np.testing.assert_allclose(columns[:, 0, 10], np.sin(7 * 2 * q[:, 0]) / 0.5, atol=1e-14)
    np.testing.assert_allclose(columns[:, 0, 11], np.cos(7 * 2 * q[:, 0]) / 0.5, atol=1e-14)
    assert {"RS1", "RC1"} <= {base.name for base in emitted.model.grouping.base}
    default = build(one_joint(DirectDrive(2.0, 0.5), EffectUse("ripple")), Options())
    assert default("regressor_standard", [0.1], [0.0], [0.0])[0, 0, 10] == pytest.approx(math.sin(0.6) / 0.5)


@pytest.mark.usefixtures("extended")
@pytest.mark.parametrize("drive", ["none", "gear", "lever"])
def test_an_effect_in_the_acceleration_adds_to_the_mass_matrix(drive: str) -> None:
    emitted = build(one_joint(DRIVES[drive][1], EffectUse("carriage"), EffectUse("drive_inertia")), Options())
    q, dq, ddq, theta = random_state(emitted)
    bare = theta.copy()
    bare[10:] = 0
    k1 = Drive(emitted.arm, 0).k1(q)
    added = emitted("mass_matrix_standard", q, theta) - emitted("mass_matrix_standard", q, bare)
    agree(added[:, :, 0], theta[10] + theta[11] * k1**2)
    given = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    agree(emitted("forward_dynamics_standard", q, dq, given, theta), ddq)
    kinetic = emitted("energy_standard", q, dq, theta)[0]
    mass = emitted("mass_matrix_standard", q, theta)
    agree(kinetic, mass[:, :, 0] * dq**2 / 2)


@pytest.mark.usefixtures("extended")
def test_on_a_real_arm_a_new_effect_leaves_the_rest_alone() -> None:
    arm = ARMS["gravity_arm"]
    joints = list(arm.joints)
    joints[1] = replace(
        joints[1], effects=(*joints[1].effects, EffectUse("bristle", {"distance": 0.1}), EffectUse("ripple"))
    )
    before = build(arm, Options())
    after = build(replace(arm, joints=tuple(joints)), Options())
    names = [base.name for base in after.model.grouping.base]
    assert names == [*(base.name for base in before.model.grouping.base), "FB2", "RS2", "RC2"]
    q, dq, ddq = states(arm, 5)
    old = before("regressor", q, dq, ddq)
    new = after("regressor", q, dq, ddq, state=[0.0])
    np.testing.assert_array_equal(new[:, :, : old.shape[2]], old)


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (EffectUse("viscos_friction"), "did you mean viscous_friction"),
        (
            EffectUse("stribeck_friction"),
            r"stribeck_friction needs a value for velocity \[rad/s at the motor",
        ),
        (EffectUse("stribeck_friction", {"velocity": -1.0}), "velocity is -1.0, expected"),
        (
            EffectUse("coulomb_friction", {"magnitud": 1.0}),
            "has no parameter magnitud, did you mean magnitude",
        ),
    ],
)
def test_a_mistake_in_an_effect_is_named(use: EffectUse, message: str) -> None:
    with pytest.raises(InputError, match=message):
        build(one_joint(NoDrive(), use), Options())


def test_an_effect_may_stand_once_at_a_joint() -> None:
    twice = one_joint(NoDrive(), EffectUse("spring"), EffectUse("spring"))
    with pytest.raises(InputError, match="spring stands twice at joint j1"):
        build(twice, Options())
