"""Effects that reach beyond one coordinate, each against the same physics written another way."""

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from witness.arms import ARMS, WHOLE, Emitted, build
from witness.bodies import random_bodies
from witness.compare import agree
from witness.levers import Drive
from witness.mechanism import states
from witness.rigid_bodies import RigidBodies

from modelgen.description import Arm, DirectDrive, EffectUse, Inertial, Joint, LeveredDrive, NoDrive
from modelgen.effects import (
    CATALOGUE,
    Effect,
    LinkEffect,
    Parameter,
    Point,
    PointVariables,
    Seen,
    Values,
    catalogue,
    described,
)
from modelgen.effects.variables import Variables
from modelgen.errors import InputError
from modelgen.functions import Options

LIMB = Inertial(2.0, (0.2, 0.0, 0.0), (0.001, 0, 0, 0.03, 0, 0.03))
PLANAR = Arm(
    "planar",
    (
        Joint("j1", "revolute", drive=DirectDrive(80.0, 0.05)),
        Joint("j2", "revolute", d=0.45, antecedent=0, drive=DirectDrive(60.0, 0.04)),
    ),
    (LIMB, LIMB),
    (0.0, -9.81, 0.0),
)


def with_arm(arm: Arm, *uses: EffectUse) -> Arm:
    return replace(arm, effects=uses)


def with_joint(arm: Arm, joint: int, *uses: EffectUse) -> Arm:
    joints = list(arm.joints)
    joints[joint] = replace(joints[joint], effects=(*joints[joint].effects, *uses))
    return replace(arm, joints=tuple(joints))


def links_vector(emitted: Emitted, seed: int = 3) -> np.ndarray:
    """Physical links, and 1 for every parameter of an effect."""
    links = np.concatenate([b.ten for b in random_bodies(emitted.arm, np.random.default_rng(seed))])
    return np.concatenate([links, np.ones(len(emitted.model.standard) - len(links))])


# -- load and time --------------------------------------------------------------------------


def test_the_load_is_the_weight_of_the_links_at_the_motor() -> None:
    emitted = build(with_joint(PLANAR, 1, EffectUse("load_dependent_friction")), Options())
    bare = build(PLANAR, Options())
    q, dq, ddq = states(emitted.arm, 9)
    theta = links_vector(emitted)
    theta[-1] = 0.15
    weight = bare("gravity_standard", q, theta[:20]) * bare("drive_gain", q)
    load = weight / np.array([80.0, 60.0])
    agree(emitted("load_standard", q, theta), load)
    agree(emitted("load", q, emitted.base(theta)), load)
    friction = 0.15 * np.abs(load[:, 1]) * np.sign(60.0 * dq[:, 1]) / 0.04
    extra = emitted("inverse_dynamics_standard", q, dq, ddq, theta) - bare(
        "inverse_dynamics_standard", q, dq, ddq, theta[:20]
    )
    agree(extra, np.column_stack([0 * friction, friction]))
    base = emitted.base(theta)
    given = emitted("inverse_dynamics", q, dq, ddq, base)
    agree(np.einsum("nij,j->ni", emitted("regressor", q, dq, ddq, load=load), base), given)
    agree(emitted("forward_dynamics", q, dq, given, base), ddq)


def test_with_a_rise_the_load_is_all_that_moves_the_links() -> None:
    rise = 0.01
    emitted = build(with_joint(PLANAR, 1, EffectUse("load_dependent_friction", {"rise": rise})), Options())
    bare = build(PLANAR, Options())
    assert emitted.model.states == ("load_dependent_friction_load_2",)
    q, dq, ddq = states(emitted.arm, 9)
    theta = links_vector(emitted)
    theta[-1] = 0.15
    base = emitted.base(theta)
    effort = bare("inverse_dynamics_standard", q, dq, ddq, theta[:20])[:, 1:]
    carried = 0.04 * effort
    half = emitted("effects_step", q, dq, [rise * math.log(2.0)], base, 0 * carried, ddq=ddq)
    agree(half, carried / 2)
    load = emitted("effects_step", q, dq, [60 * rise], base, half, ddq=ddq)
    agree(load, carried)
    given = emitted("inverse_dynamics", q, dq, ddq, base, state=load)
    friction = 0.15 * np.abs(effort) * np.sign(dq[:, 1:])
    agree(given[:, 1:], effort + friction)
    agree(emitted("forward_dynamics", q, dq, given, base, state=load), ddq)


def test_a_drive_warms_by_its_own_motion() -> None:
    """Heat of a drive that speeds up and turns back, by an integrator; at heat 1 no excess is left."""
    time, speed = 12.0, 100.0
    use = EffectUse("friction_warm_up", {"time": time, "speed": speed})
    emitted = build(with_joint(PLANAR, 0, use), Options())
    assert emitted.model.states == ("friction_warm_up_heat_1",)
    q, dq, ddq = states(emitted.arm, 4)
    base = emitted.base(links_vector(emitted))
    at = [emitted("inverse_dynamics", q, dq, ddq, base, state=[heat]) for heat in (0.0, 0.75, 1.0)]
    agree(at[1] - at[2], (at[0] - at[2]) / 4)
    w = 80.0 * dq[:, 0]
    agree((at[0] - at[2])[:, 0], (np.sign(w) + w) / 0.05)

    def moving(t: float) -> float:
        return 2.0 * math.sin(0.3 * t)

    heat, dt = np.zeros((1, 1)), 0.02
    for k in range(1500):
        now = np.array([[moving((k + 0.5) * dt), 0.0]])
        heat = emitted("effects_step", 0 * now, now, [[dt]], base, heat)
    truth = solve_ivp(
        lambda t, h: [(abs(80.0 * moving(t)) / speed - h[0]) / time], (0.0, 30.0), [0.0], max_step=0.05
    )
    np.testing.assert_allclose(heat[0, 0], truth.y[0, -1], rtol=1e-3)


# -- several coordinates --------------------------------------------------------------------


def test_a_coupled_rotor_is_a_third_body_by_virtual_work() -> None:
    """Its kinetic energy adds to the mass matrix, its friction takes power from both joints."""
    ratio = -0.75
    use = EffectUse("transmission_coupling", {"other": 1.0, "ratio": ratio})
    emitted = build(with_joint(PLANAR, 1, use), Options())
    bare = build(PLANAR, Options())
    q, dq, ddq = states(emitted.arm, 9)
    theta = links_vector(emitted)
    theta[20:] = 0.4, 0.0, 0.0  # inertia alone
    jacobian = np.array([ratio, 1.0])
    added = emitted("mass_matrix_standard", q, theta) - bare("mass_matrix_standard", q, theta[:20])
    agree(added, np.broadcast_to(0.4 * np.outer(jacobian, jacobian), added.shape))
    kinetic = emitted("energy_standard", q, dq, theta)[0]
    agree(kinetic[:, 0], np.einsum("ni,nij,nj->n", dq, emitted("mass_matrix_standard", q, theta), dq) / 2)
    theta[20:] = 0.4, 0.3, 2.0
    given = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    extra = (given - bare("inverse_dynamics_standard", q, dq, ddq, theta[:20])) * emitted("drive_gain", q)
    u, a = dq @ jacobian, ddq @ jacobian
    agree(extra, np.outer(0.4 * a + 0.3 * u + 2.0 * np.sign(u), jacobian))
    agree(emitted("forward_dynamics_standard", q, dq, given, theta), ddq)


def test_a_payload_is_a_point_mass_of_the_last_link() -> None:
    place, mass = np.array([0.3, -0.05, 0.1]), 1.7
    use = EffectUse("payload_change", {"mass": mass, **dict(zip("xyz", place, strict=True))})
    for name in ("ur10e", "two_fingers", "ariane4"):
        emitted, bare = build(with_arm(ARMS[name], use), WHOLE), build(ARMS[name], WHOLE)
        q, dq, ddq = states(emitted.arm, 5)
        theta = links_vector(emitted)
        heavier = theta.copy()
        last = 10 * (len(emitted.arm.joints) - 1)
        spread = mass * (place @ place * np.eye(3) - np.outer(place, place))
        heavier[last : last + 10] += [*spread[np.triu_indices(3)], *(mass * place), mass]
        agree(
            emitted("inverse_dynamics_standard", q, dq, ddq, theta),
            bare("inverse_dynamics_standard", q, dq, ddq, heavier),
        )
        agree(emitted("mass_matrix_standard", q, theta), bare("mass_matrix_standard", q, heavier))
        agree(
            emitted("forward_dynamics_standard", q, dq, 0 * q, theta),
            bare("forward_dynamics_standard", q, dq, 0 * q, heavier),
        )


def drag_effort(q: np.ndarray, dq: np.ndarray) -> np.ndarray:
    """Of the planar arm, both links 0.45 and 0.4 m long, by 4,000 strips in base coordinates."""
    effort = np.zeros(2)
    place = (np.arange(4000) + 0.5) / 4000
    for link, length in ((0, 0.45), (1, 0.4)):
        a = q[0] + (q[1] if link else 0.0)

        def position(x: np.ndarray, s: np.ndarray, link: int = link, length: float = length) -> np.ndarray:
            first = 0.45 * np.array([np.cos(x[0]), np.sin(x[0])])
            if not link:
                return np.outer(s * length, [np.cos(x[0]), np.sin(x[0])])
            second = np.array([np.cos(x[0] + x[1]), np.sin(x[0] + x[1])])
            return first + np.outer(s * length, second)

        h = 1e-5
        jacobian = np.stack(
            [(position(q + h * e, place) - position(q - h * e, place)) / (2 * h) for e in np.eye(2)], axis=2
        )
        across = np.array([-np.sin(a), np.cos(a)])
        speed = (jacobian @ dq) @ across
        effort += length / 4000 * np.einsum("s,c,sck->k", np.abs(speed) * speed, across, jacobian)
    return effort


def test_drag_of_slender_links() -> None:
    """Five Gauss points a link against thousands of strips; |v| v has a kink inside some links."""
    emitted, bare = build(with_arm(PLANAR, EffectUse("fluid_drag")), Options()), build(PLANAR, Options())
    assert emitted.model.standard[-1].name == "CD"
    q, dq, ddq = states(emitted.arm, 6)
    theta = links_vector(emitted)
    given = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    extra = (given - bare("inverse_dynamics_standard", q, dq, ddq, theta[:20])) * emitted("drive_gain", q)
    expected = np.array([drag_effort(*x) for x in zip(q, dq, strict=True)])
    np.testing.assert_allclose(extra, expected, atol=2e-3 * np.abs(expected).max())
    agree(emitted("forward_dynamics_standard", q, dq, given, theta), ddq)
    assert ((extra * dq).sum(axis=1) > 0).all()  # it takes power


class Fluid:
    """What moves with the slender links of a chain, 1 kg/m across them, by its energy. Slides stand at zero
    where a link's end is asked for.
    """

    def __init__(self, arm: Arm, tip: tuple[float, float, float]) -> None:
        self.links = RigidBodies(arm, random_bodies(arm, np.random.default_rng(0)), every_joint=True)
        rest = self.links.poses(np.zeros(len(arm.joints)))
        self.ends = [
            np.linalg.solve(here, there)[:3, 3] for here, there in itertools.pairwise(np.array(rest))
        ]
        self.ends.append(np.array(tip))

    def inertia(self, q: np.ndarray) -> np.ndarray:
        total = np.zeros((len(q), len(q)))
        for link, end in enumerate(self.ends):
            length = float(np.linalg.norm(end))
            if length < 1e-9:
                continue
            line = self.links.poses(q)[link][:3, :3] @ end / length
            jacobian = self.links.jacobian(q, link)
            for place, weight in zip(*np.polynomial.legendre.leggauss(8), strict=True):
                moved = np.cross(jacobian[3:].T, line * length * (place + 1) / 2).T
                across = (np.eye(3) - np.outer(line, line)) @ (jacobian[:3] + moved)
                total += weight / 2 * length * across.T @ across
        return total

    def effort(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Lagrange's, the inertia's derivatives by differences."""
        slopes = np.stack([derivative(self.inertia, q, e) for e in np.eye(len(q))])  # by the coordinate
        rate = np.einsum("kij,k->ij", slopes, dq)
        return self.inertia(q) @ ddq + rate @ dq - 0.5 * np.einsum("kij,i,j->k", slopes, dq, dq)


def derivative(
    function: Callable[[np.ndarray], np.ndarray], x: np.ndarray, along: np.ndarray, h: float = 1e-3
) -> np.ndarray:
    """By differences of sixth order."""
    terms = [(function(x + k * h * along) - function(x - k * h * along)) * c for k, c in SIXTH]
    return np.asarray(sum(terms) / h)


SIXTH = ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60))
TIP = (0.3, -0.05, 0.12)
IN_WATER = {"planar": PLANAR, "ur10e": ARMS["ur10e"], "scara": ARMS["scara"]}
IN_FLUID = EffectUse("added_mass", dict(zip(("tip_x", "tip_y", "tip_z"), TIP, strict=True)))


together = pytest.mark.xdist_group("in_water")


@cache
def in_water(name: str) -> Emitted:
    """An arm with the mass that the fluid adds, built once."""
    return build(with_arm(IN_WATER[name], IN_FLUID), WHOLE)


@together
@pytest.mark.parametrize("name", IN_WATER)
def test_added_mass_is_the_fluid_s_kinetic_energy(name: str) -> None:
    arm = IN_WATER[name]
    emitted, bare = in_water(name), build(arm, WHOLE)
    assert emitted.model.standard[-1].name == "CM"
    fluid = Fluid(arm, TIP)
    q, dq, ddq = states(emitted.arm, 6)
    theta = links_vector(emitted)
    given = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    extra = (given - bare("inverse_dynamics_standard", q, dq, ddq, theta[:-1])) * emitted("drive_gain", q)
    agree(extra, [fluid.effort(*x) for x in zip(q, dq, ddq, strict=True)], 1e-8)
    more = emitted("mass_matrix_standard", q, theta) - bare("mass_matrix_standard", q, theta[:-1])
    agree(more, [fluid.inertia(x) for x in q])
    agree(emitted("forward_dynamics_standard", q, dq, given, theta), ddq)


@together
@pytest.mark.parametrize("name", IN_WATER)
def test_added_mass_keeps_the_coriolis_matrix_passive(name: str) -> None:
    """dM/dt - 2 C is skew-symmetric, C through unit reference velocities."""
    emitted = in_water(name)
    theta = emitted.base(links_vector(emitted))
    q, dq, _ = states(emitted.arm, 4)

    def effort(reference: np.ndarray) -> np.ndarray:
        columns = emitted("slotine_li_regressor", q, dq, reference, 0 * q)
        return np.asarray(columns @ theta * emitted("drive_gain", q))

    units = [np.broadcast_to(unit, q.shape) for unit in np.eye(q.shape[1])]
    coriolis = np.stack([effort(unit) - effort(0 * q) for unit in units], axis=2)
    rate = derivative(lambda x: np.asarray(emitted("mass_matrix", x, theta)), q, dq)
    skew = rate - 2 * coriolis
    assert np.abs(skew + np.swapaxes(skew, 1, 2)).max() <= 1e-8 * np.abs(rate).max()


@together
@pytest.mark.parametrize("name", ["added_mass", "fluid_drag", "payload_change"])
def test_places_on_a_link_are_in_its_frame_as_drawn(name: str) -> None:
    """Base parameters stand about the foot of the last link's common normal, 0.12 m from ur10e's frame."""
    values = {"mass": 1.2, "x": 0.1, "z": 0.2} if name == "payload_change" else dict(IN_FLUID.values)
    other = name != IN_FLUID.name
    emitted = build(with_arm(ARMS["ur10e"], EffectUse(name, values)), WHOLE) if other else in_water("ur10e")
    q, dq, ddq = states(emitted.arm, 4)
    theta = links_vector(emitted)
    agree(
        emitted("inverse_dynamics", q, dq, ddq, emitted.base(theta)),
        emitted("inverse_dynamics_standard", q, dq, ddq, theta),
    )


# -- changes of the description -------------------------------------------------------------


@pytest.mark.parametrize("name", ["fluid_drag", "added_mass"])
def test_what_is_not_looked_for_is_said(name: str) -> None:
    """A fluid's force needs the arm's end: from its nominal inertials, or given with the effect."""
    effect, seen = CATALOGUE[name], Seen(whole=True, still=(), unsided=(), coarse=False)
    bare = replace(PLANAR, links=(LIMB, None))
    pointed = replace(bare, joints=(bare.joints[0], replace(bare.joints[1], d=0.0, r=0.0)))
    for arm in (pointed, bare) if name == "added_mass" else (pointed,):
        (said,) = effect.hidden(arm, seen, named=False)
        assert said.endswith(": j2")
        assert not effect.stands_at(arm, None)
    given = with_arm(bare, EffectUse(name, dict(zip(("tip_x", "tip_y", "tip_z"), TIP, strict=True))))
    for arm in (PLANAR, given, replace(PLANAR, links=(None, LIMB))):
        assert effect.hidden(arm, seen, named=False) == []


def test_the_end_of_an_arm_in_a_fluid_is_guessed() -> None:
    """As far away as the longest link is long, in four directions, and it is said to be a guess."""
    effect, seen = CATALOGUE["fluid_drag"], Seen(whole=True, still=(), unsided=(), coarse=False)
    bare = replace(PLANAR, links=(LIMB, None))
    for named in (False, True):
        (said,) = effect.hidden(bare, seen, named=named)
        assert said.endswith("where j2 ends")
    assert effect.stands_at(bare, None)
    ends = [[form[f"tip_{axis}"] for axis in "xyz"] for form in effect.variants(bare, None)]
    length = float(np.hypot(PLANAR.joints[1].d, PLANAR.joints[1].r))
    assert np.linalg.norm(ends, axis=1) == pytest.approx(length)
    assert len({tuple(end) for end in ends}) == 4


def test_an_encoder_offset_shifts_the_joint() -> None:
    for name, joint in (("ariane4", 1), ("ur10e", 2), ("scara", 2), ("gravity_arm", 0)):
        offset = 0.013
        emitted = build(with_joint(ARMS[name], joint, EffectUse("encoder_offset", {"offset": offset})), WHOLE)
        bare = build(ARMS[name], WHOLE)
        q, dq, ddq = states(bare.arm, 6)
        q = 0.8 * q + 0.2 * q.mean(axis=0)
        true = q.copy()
        true[:, bare.arm.coordinates.index(joint)] += offset
        theta = links_vector(bare)
        agree(
            emitted("inverse_dynamics_standard", q, dq, ddq, theta),
            bare("inverse_dynamics_standard", true, dq, ddq, theta),
        )


def test_a_tilted_base_sees_a_tilted_gravity() -> None:
    """Turning the base is turning the first joint, for an arm whose joint 1 turns about the same axis."""
    tilt = 0.07
    emitted = build(with_arm(PLANAR, EffectUse("base_tilt", {"z": tilt})), Options())
    bare = build(PLANAR, Options())
    q, _, _ = states(bare.arm, 6)
    theta = links_vector(bare)
    agree(
        emitted("gravity_standard", q, theta),
        bare("gravity_standard", q + np.array([tilt, 0.0]), theta),
    )
    assert np.linalg.norm(emitted.arm.gravity) == pytest.approx(9.81, rel=1e-14)


def test_a_gain_error_scales_its_row_and_a_lever_error_moves_its_gain() -> None:
    arm = ARMS["ariane4"]
    bare = build(arm, Options(without=frozenset({"effects"})))
    q, dq, ddq = states(bare.arm, 6)
    q = 0.8 * q + 0.2 * q.mean(axis=0)
    theta = links_vector(bare)
    plain = arm.without_effects()
    wrong = build(with_joint(plain, 1, EffectUse("drive_gain_error", {"error": 0.25})), Options())
    expected = bare("inverse_dynamics_standard", q, dq, ddq, theta) / np.array([1.0, 1.25, 1.0])
    agree(wrong("inverse_dynamics_standard", q, dq, ddq, theta), expected)
    longer = build(with_joint(plain, 0, EffectUse("lever_geometry", {"l1": 0.001})), Options())
    gain = longer("drive_gain", q)
    first = plain.joints[0]
    assert isinstance(first.drive, LeveredDrive)
    lever = replace(first, drive=replace(first.drive, l1=first.drive.l1 + 0.001))
    agree(gain[:, 0], Drive(replace(plain, joints=(lever, *plain.joints[1:])), 0).gain(q[:, 0]))
    agree(
        longer("inverse_dynamics_standard", q, dq, ddq, theta) * gain,
        bare("inverse_dynamics_standard", q, dq, ddq, theta) * bare("drive_gain", q),
    )


# -- between input and effort ---------------------------------------------------------------


def test_a_saturated_drive_needs_more_current_for_the_same_effort() -> None:
    coefficient = 0.002
    use = EffectUse("torque_constant_saturation", {"coefficient": coefficient})
    emitted, bare = build(with_joint(PLANAR, 0, use), Options()), build(PLANAR, Options())
    q, dq, ddq = states(emitted.arm, 30)
    theta = links_vector(emitted)
    ideal = bare("inverse_dynamics_standard", q, dq, ddq, theta)
    scale = 4.0 / np.abs(ideal).max()
    theta = theta * scale
    given = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    agree(given[:, 0] * (1 - coefficient * given[:, 0] ** 2), (ideal * scale)[:, 0])
    agree(given[:, 1], (ideal * scale)[:, 1])
    agree(emitted("forward_dynamics_standard", q, dq, given, theta), ddq)
    agree(emitted("effective_input", given), ideal * scale)


def test_a_delayed_drive_follows_its_input_after_the_delay() -> None:
    emitted, bare = (
        build(with_arm(PLANAR, EffectUse("time_delay", {"delay": 0.02})), Options()),
        build(PLANAR),
    )
    bare = build(PLANAR, Options())
    assert emitted.model.states == ("time_delay_lagged_1", "time_delay_lagged_2")
    q, dq, _ = states(emitted.arm, 1)
    theta = links_vector(emitted)
    base = emitted.base(theta)
    given, lagged = np.array([[1.5, -0.4]]), np.zeros((1, 2))
    steps = 400
    area = np.zeros(2)
    for _ in range(steps):
        area += (given - lagged)[0] * 0.001
        lagged = emitted("effects_step", q, dq, [[0.001]], base, lagged, input=given)
    agree(lagged, given, 1e-7)
    np.testing.assert_allclose(area / given[0], 0.02, rtol=0.03)  # the delay is the area between the two
    agree(
        emitted("forward_dynamics", q, dq, given, base, state=lagged),
        bare("forward_dynamics", q, dq, lagged, base),
    )


# -- a link that does not follow its drive ----------------------------------------------------


def two_masses(
    gap: float, stiffness: float, damping: float, inertia: float, rotor: float, span: float
) -> object:
    """Motor and link of a pendulum of 2 kg at 0.2 m, the motor driven by a slow torque; both positions."""

    def spring(lag: float, rate: float) -> float:
        beyond = lag - min(max(lag, -gap / 2), gap / 2)
        return stiffness * beyond + (damping * rate if beyond or not gap else 0.0)

    def rates(t: float, x: np.ndarray) -> list[float]:
        motor, link, dm, dl = x
        force = spring(motor - link, dm - dl)
        drive = 9.0 * math.sin(3.0 * t)
        return [
            dm,
            dl,
            (drive - force) / rotor,
            (force - 2.0 * 9.81 * 0.2 * math.cos(link)) / inertia,
        ]

    start = [0.3 + 2.0 * 9.81 * 0.2 * math.cos(0.3) / stiffness + gap / 2, 0.3, 0.0, 0.0]
    return solve_ivp(rates, (0.0, span), start, rtol=1e-9, atol=1e-11, max_step=2e-4, dense_output=True)


@pytest.mark.parametrize(("name", "gap"), [("joint_flexibility", 0.0), ("backlash", 0.02)])
def test_an_elastic_joint_or_play_moves_as_two_masses(name: str, gap: float) -> None:
    stiffness, damping, rotor = 900.0, 2.0, 0.35
    values = {"stiffness": stiffness, "damping": damping, **({"play": gap} if gap else {})}
    arm = Arm(
        "one",
        (
            Joint(
                "j1",
                "revolute",
                drive=NoDrive(),
                effects=(EffectUse("drive_inertia"), EffectUse(name, values)),
            ),
        ),
        (LIMB,),
        (0.0, -9.81, 0.0),
    )
    emitted = build(arm, Options())
    inertia = 0.03 + 2.0 * 0.2**2
    theta = np.array([0.001, 0, 0, inertia, 0, inertia, 0.4, 0, 0, 2.0, rotor])
    span, dt = 0.8, 1e-4
    exact = two_masses(gap, stiffness, damping, inertia, rotor, span)
    motor, link, _, _ = exact.sol(0.0)  # type: ignore[attr-defined]
    q, dq, state = np.array([motor]), np.zeros(1), np.array([motor - link, 0.0])
    for k in range(round(span / dt)):
        given = [9.0 * math.sin(3.0 * (k + 0.5) * dt)]
        ddq = emitted("forward_dynamics_standard", q, dq, given, theta, state=state)
        after = emitted("effects_step_standard", q, dq, [dt], theta, state, ddq=ddq)
        q, dq, state = q + dt * dq + dt**2 / 2 * ddq, dq + dt * ddq, after
    truth = exact.sol(span)  # type: ignore[attr-defined]
    moved = abs(truth[0] - motor)
    assert abs(q[0] - truth[0]) < 1e-3 * moved
    lag = np.ptp([m - x for m, x, _, _ in exact.sol(np.linspace(0, span, 400)).T])  # type: ignore[attr-defined]
    assert abs(state[0] - (truth[0] - truth[1])) < 0.05 * lag
    # what the drive gives is what it takes
    back = emitted("inverse_dynamics_standard", q, dq, ddq, theta, state=state)
    agree(emitted("forward_dynamics_standard", q, dq, back, theta, state=state), ddq, 1e-9)


# -- the mechanism: one class more is one effect more ------------------------------------------


class Wind(LinkEffect):
    """A throw-away effect: a steady push along the link's own x axis."""

    name = "wind"
    text = "for a test"
    reference = "none"
    linear = (Parameter("push", "N", "force", "PW"),)

    def points(self, p: Values) -> list[Point]:
        return [Point((sp.Integer(0), sp.Integer(0), sp.Integer(0)))]

    def force(self, x: PointVariables, p: Values) -> sp.Matrix:
        return p["push"] * sp.Matrix([1, 0, 0])


class Clock(Effect):
    """Another: a force that depends on time and on the weight."""

    name = "clock"
    text = "for a test"
    reference = "none"
    linear = (Parameter("size", "1", "size", "PK"),)
    nonlinear = (Parameter("rate", "1/s", "rate", default=2.0),)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        return p["size"] * x.load * sp.sin(p["rate"] * x.time)


def test_throw_away_effects_of_other_kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    for effect in (Wind, Clock):
        monkeypatch.setitem(catalogue.CATALOGUE, effect.name, effect)
    arm = with_joint(ARMS["ur10e"], 5, EffectUse("wind"))
    emitted, bare = build(arm, Options()), build(ARMS["ur10e"], Options())
    q, dq, ddq = states(arm, 5)
    theta = links_vector(emitted)
    extra = emitted("inverse_dynamics_standard", q, dq, ddq, theta) - bare(
        "inverse_dynamics_standard", q, dq, ddq, theta[:-1]
    )
    poses = emitted("forward_kinematics", q)[5]
    linear = emitted("jacobian", q)[:, :3]
    agree(extra * emitted("drive_gain", q), np.einsum("nij,ni->nj", linear, poses[:, :3, 0]))
    clock = build(with_joint(PLANAR, 0, EffectUse("clock")), Options())
    assert [a.name for f in clock.model.functions if f.name == "regressor" for a in f.arguments] == [
        "q", "dq", "ddq", "time", "load",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("arm", "message"),
    [
        (with_arm(PLANAR, EffectUse("spring")), "spring acts on one joint, expected under its `effects`"),
        (with_joint(PLANAR, 0, EffectUse("base_tilt")), "base_tilt acts on the whole arm"),
        (
            with_arm(PLANAR, EffectUse("base_tilt"), EffectUse("base_tilt")),
            "base_tilt stands twice at the arm",
        ),
        (with_joint(PLANAR, 0, EffectUse("actuator_mass")), "without a lever, expected a levered drive"),
        (with_joint(PLANAR, 0, EffectUse("lever_geometry")), "without a lever, expected a levered drive"),
        (
            with_joint(PLANAR, 0, EffectUse("transmission_coupling", {"other": 1.0})),
            "other is 1, expected one of 2",
        ),
        (
            with_joint(ARMS["ariane4"], 0, EffectUse("lever_geometry", {"l1": 1.0})),
            "leave no triangle anywhere on the stroke",
        ),
        (
            with_arm(replace(PLANAR, links=(None, None)), EffectUse("fluid_drag")),
            "needs the end of link j2, which carries no other",
        ),
    ],
)
def test_an_effect_in_the_wrong_place_is_named(arm: Arm, message: str) -> None:
    with pytest.raises(InputError, match=message):
        build(arm, Options())


def test_a_stroke_ends_where_its_lever_closes() -> None:
    """With true lengths that reach less far than the described stroke, the angle at each motor position stays
    that of the law of cosines.
    """
    arm = ARMS["ariane4"]
    old = arm.joints[0].drive
    assert isinstance(old, LeveredDrive)
    l1, l2, ends = float(old.l1), float(old.l2), [float(x) for x in old.length]
    shorter = max(ends) - l1 - 1e-3 - l2  # the longest length is a millimetre out of reach
    new = described(with_joint(arm, 0, EffectUse("lever_geometry", {"l2": shorter}))).joints[0].drive
    assert isinstance(new, LeveredDrive)
    low, high = (float(x) for x in new.length)
    assert [low, high] == sorted(np.clip([low, high], abs(l1 - l2 - shorter), l1 + l2 + shorter))
    assert abs(l1 - l2 - shorter) < min(low, high) < max(low, high) < l1 + l2 + shorter < max(ends)
    for length, motor in zip((low, high), new.motor, strict=True):
        share = (length - ends[0]) / (ends[1] - ends[0])
        assert motor == pytest.approx(old.motor[0] + share * (old.motor[1] - old.motor[0]), rel=1e-12)


def test_every_effect_of_the_catalogue_says_what_it_is_confused_with() -> None:
    for effect in CATALOGUE.values():
        assert effect.confused_with
        assert effect.experiment
        assert not set(effect.confused_with) - set(CATALOGUE) - {effect.name}
