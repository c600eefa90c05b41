"""What can be hidden in an arm: physics of its own, of a strength that one magnitude sets."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from hidden import native
from hidden.arms import Arm
from hidden.native import Array, Plant


@dataclass(frozen=True)
class Scales:
    """Of an arm at work, by joint (n,): slope of the drive, motor speed, current, power of friction [W].

    common: (n, 2), the range that every record visits.
    """

    slope: Array
    speed: Array
    current: Array
    friction: Array
    common: Array
    floor: float  # height below which the tip is for a part of every record [m]
    power: Array  # electrical power of the whole arm (N,) [W]
    paths: list[Array]  # joint coordinates (N, n) of every record


@dataclass(frozen=True)
class Site:
    """Where an effect is put in: arm, joint (from 0), scales, and what its shape is drawn from.

    carried: friction under load is by all that moves the links, else by their weight.
    """

    arm: Arm
    joint: int
    scales: Scales
    random: Generator
    carried: bool = False


Put = Callable[[Plant, Site, float], None]
"""Changes the plant; a magnitude of 1 is a strong effect."""


@dataclass(frozen=True)
class Effect:
    """put: see Put. kind: which joints can have it, see joints_for."""

    put: Put
    kind: str = "driven"
    whole: bool = False  # measured on every joint, not on its own alone
    later: bool = False  # absent in the first record
    fine: bool = False  # needs small steps
    outside: bool = False  # no entry of the catalogue
    described: bool = False  # every driven joint has it: it is hidden by a description without it
    most: float = 12.0  # largest magnitude that is still a plausible arm


def _viscous(p: Plant, s: Site, m: float) -> None:
    p["viscous"][s.joint] *= 1.0 + m


def _dry(p: Plant, s: Site, m: float) -> None:
    p["dry"][s.joint] *= 1.0 + m


def _rotor(p: Plant, s: Site, m: float) -> None:
    p["rotor"][s.joint] *= 1.0 + 5.0 * m


def _offset(p: Plant, s: Site, m: float) -> None:
    p["dry_asymmetry"][s.joint] = m * p["dry"][s.joint] * s.random.choice((-1.0, 1.0))


def _asymmetric(p: Plant, s: Site, m: float) -> None:
    p["viscous_asymmetry"][s.joint] = m * p["viscous"][s.joint] * s.random.choice((-1.0, 1.0))


def _stribeck(p: Plant, s: Site, m: float) -> None:
    p["stribeck"][s.joint] = m * p["dry"][s.joint]
    p["stribeck_speed"][s.joint] = s.scales.speed[s.joint] * s.random.uniform(0.02, 0.06)
    p["stribeck_exponent"][s.joint] = s.random.uniform(0.8, 1.6)


def _load(p: Plant, s: Site, m: float) -> None:
    p["load_friction"][s.joint] = 0.1 * m
    p["load_carried"][s.joint] = float(s.carried)


def _power(p: Plant, s: Site, m: float) -> None:
    p["power_friction"][s.joint] = 2.0 * m * p["dry"][s.joint]
    p["power_speed"][s.joint] = s.scales.speed[s.joint]
    p["power_exponent"][s.joint] = s.random.uniform(0.6, 0.75) if s.random.random() < 0.5 else 2.0


def _wave(p: Plant, s: Site, m: float) -> None:
    p["wave_friction"][s.joint] = m * p["dry"][s.joint]
    p["wave_phase"][s.joint] = s.random.uniform(-math.pi, math.pi)


def _warm(p: Plant, s: Site, m: float) -> None:
    p["warm_up"][s.joint] = m
    p["warm_time"][s.joint] = s.random.uniform(8.0, 14.0)
    p["warm_power"][s.joint] = s.scales.friction[s.joint]


def _presliding(p: Plant, s: Site, m: float) -> None:
    p["slip_distance"][s.joint] = 0.01 * m * abs(s.scales.slope[s.joint])
    p["slip_bristles"][s.joint] = float(s.random.random() < 0.5)


def _ripple(p: Plant, s: Site, m: float) -> None:
    p["ripple"][s.joint] = 0.5 * m * p["dry"][s.joint]
    p["ripple_order"][s.joint] = s.random.choice((1.0, 2.0))
    p["ripple_phase"][s.joint], p["ripple_drift"][s.joint] = s.random.uniform(-math.pi, math.pi), 0.3


def _backlash(p: Plant, s: Site, m: float) -> None:
    j, slope = s.joint, abs(s.scales.slope[s.joint])
    p["gap"][j] = 0.004 * m * slope
    p["stiffness"][j] = 20.0 / slope / (2e-4 * slope) ** 1.5
    p["damping"][j] = 5.0 / slope


def _flexible(p: Plant, s: Site, m: float) -> None:
    j, slope = s.joint, abs(s.scales.slope[s.joint])
    p["stiffness"][j] = 400.0 / m / slope**2
    p["damping"][j] = 0.1 * math.sqrt(p["stiffness"][j] * p["rotor"][j])


def _coupling(p: Plant, s: Site, m: float) -> None:
    j, other = s.joint, s.joint - 1 if s.joint else 1
    slope = s.scales.slope[j]
    p["coupled_to"][j], p["coupling_ratio"][j] = 1.0 + other, s.random.choice((-1.0, 1.0))
    p["coupling_dry"][j] = 0.5 * m * p["dry"][j] * abs(slope)
    p["coupling_viscous"][j] = 0.5 * m * p["viscous"][j] * slope**2
    p["coupling_inertia"][j] = 0.3 * m * p["rotor"][j] * slope**2


def _lever(p: Plant, s: Site, m: float) -> None:
    p[s.random.choice(("l1", "l2"))][s.joint] += 0.004 * m * s.random.choice((-1.0, 1.0))


def _cylinder(p: Plant, s: Site, m: float) -> None:
    p["cylinder_mass"][s.joint] = 3.0 * m
    p["cylinder_centre"][s.joint] = s.random.uniform(0.35, 0.55) * p["l1"][s.joint]
    p["cylinder_anchor"][s.joint] = s.random.uniform(-math.pi, math.pi)


def _spring(p: Plant, s: Site, m: float) -> None:
    stiffness = 20.0 * m if p["kind"][s.joint] > 0.5 else 2.0 * m
    p["spring"][s.joint], p["spring_cubic"][s.joint] = stiffness, 0.15 * stiffness
    p["spring_rest"][s.joint] = s.random.uniform(-0.5, 0.5)


def add_payload(p: Plant, mass: float) -> None:
    """A point mass at the tip of the last link."""
    last = int(p["n"]) - 1
    tip, com, old = p["tip"], p["com"][last].copy(), float(p["mass"][last])
    centre = (old * com + mass * tip) / (old + mass)
    inertia = np.zeros((3, 3))
    inertia[np.triu_indices(3)] = p["inertia"][last]
    inertia = inertia + inertia.T - np.diag(np.diag(inertia))
    for weight, at in ((old, com), (mass, tip)):
        arm = at - centre
        inertia += weight * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    p["inertia"][last] = inertia[np.triu_indices(3)]
    p["com"][last], p["mass"][last] = centre, old + mass


def _payload(p: Plant, s: Site, m: float) -> None:
    add_payload(p, 0.5 * m)


def _drag(p: Plant, s: Site, m: float) -> None:
    for link in range(int(p["n"])):  # the whole arm is in the water
        p["drag"][link] = 60.0 * m * s.random.uniform(0.8, 1.2)


def _fluid(p: Plant, s: Site, m: float) -> None:
    for link in range(int(p["n"])):
        p["added_mass"][link] = 8.0 * m * s.random.uniform(0.8, 1.2)


def _tilt(p: Plant, s: Site, m: float) -> None:
    # About a horizontal axis, mostly the one that the arm's gravity torques feel.
    heading = s.random.uniform(-0.7, 0.7) + s.random.choice((0.0, math.pi))
    # The axis of the first horizontal joint is -y of the base.
    axis = np.array([math.sin(heading), math.cos(heading), 0.0])
    angle = 0.05 * m
    down = p["gravity"].copy()
    p["gravity"] = down * math.cos(angle) + np.cross(axis, down) * math.sin(angle)


def _gain(p: Plant, s: Site, m: float) -> None:
    p["torque_constant"][s.joint] *= 1.0 + 0.1 * m * s.random.choice((-1.0, 1.0))


def _saturation(p: Plant, s: Site, m: float) -> None:
    p["saturation"][s.joint] = 4.0 * s.scales.current[s.joint] / m


def _encoder(p: Plant, s: Site, m: float) -> None:
    slope = s.scales.slope[s.joint] if p["joint_side"][s.joint] < 0.5 else 1.0
    p["reading_offset"][s.joint] = 0.03 * m * slope * s.random.choice((-1.0, 1.0))


def _delay(p: Plant, s: Site, m: float) -> None:
    p["delay"][s.joint] = 0.004 * m


def _spot(p: Plant, s: Site, m: float) -> None:
    j, (low, high) = s.joint, s.scales.common[s.joint]
    p["spot"][j] = 2.0 * m * p["dry"][j] * abs(s.scales.slope[j]) * s.random.choice((-1.0, 1.0))
    p["spot_place"][j] = low + s.random.uniform(0.35, 0.65) * (high - low)
    p["spot_width"][j] = 0.03 * float(np.ptp(s.arm.position[j]))


def _sag(p: Plant, s: Site, m: float) -> None:
    threshold = float(np.quantile(s.scales.power, 0.6))
    p["sag"], p["sag_power"] = 0.5 * m / (float(s.scales.power.max()) - threshold), threshold


def _floor(p: Plant, s: Site, m: float) -> None:
    p["floor_height"] = s.scales.floor
    p["floor_stiffness"] = 400.0 * m


def _hose(p: Plant, s: Site, m: float) -> None:
    j, other = s.joint, s.joint - 1 if s.joint else 1
    side = s.random.choice((-1.0, 1.0))
    p["hose"][j], p["hose_to"][j], p["hose_side"][j] = 20.0 * m, 1.0 + other, side
    share = s.random.uniform(0.7, 0.9)
    p["hose_slack"][j] = min(np.quantile(q[:, j] + side * q[:, other], share) for q in s.scales.paths)


EFFECTS: dict[str, Effect] = {
    "viscous_friction": Effect(_viscous, described=True),
    "coulomb_friction": Effect(_dry, described=True),
    "drive_inertia": Effect(_rotor, "lever", described=True),  # elsewhere the link's inertia absorbs it
    "friction_offset": Effect(_offset),
    "asymmetric_viscous_friction": Effect(_asymmetric),
    "stribeck_friction": Effect(_stribeck, "any", most=3.0),  # four times the Coulomb friction at rest
    "load_dependent_friction": Effect(_load, "loaded"),
    "nonlinear_viscous_friction": Effect(_power, "any"),
    "position_dependent_friction": Effect(_wave),
    "friction_warm_up": Effect(_warm),
    "presliding": Effect(_presliding),
    "torque_ripple": Effect(_ripple),
    "backlash": Effect(_backlash, fine=True, most=25.0),
    "joint_flexibility": Effect(_flexible, fine=True, most=25.0),
    "transmission_coupling": Effect(_coupling, "chain"),
    "lever_geometry": Effect(_lever, "lever", most=6.0),
    "actuator_mass": Effect(_cylinder, "lever"),
    "spring": Effect(_spring, "any"),
    "payload_change": Effect(_payload, "last", whole=True, later=True),
    "fluid_drag": Effect(_drag, "outer", whole=True),
    "added_mass": Effect(_fluid, "outer", whole=True),
    "base_tilt": Effect(_tilt, "slewing", whole=True, most=4.0),
    "drive_gain_error": Effect(_gain, "chain", whole=True, most=6.0),
    "torque_constant_saturation": Effect(_saturation),
    "encoder_offset": Effect(_encoder, "inner", whole=True, most=4.0),
    "time_delay": Effect(_delay),
    "hard_spot": Effect(_spot, outside=True),
    "supply_sag": Effect(_sag, whole=True, outside=True),
    "external_contact": Effect(_floor, whole=True, outside=True, most=20.0),
    "taut_hose": Effect(_hose, "chain", whole=True, outside=True),
}
CATALOGUE = tuple(name for name, effect in EFFECTS.items() if not (effect.outside or effect.described))
OUTSIDE = tuple(name for name, effect in EFFECTS.items() if effect.outside)


def joints_for(name: str, arm: Arm) -> list[int]:
    """Joints (from 0) at which an effect can sit on this arm; empty where it cannot."""
    kinds, kind = arm.plant["kind"][: arm.n], EFFECTS[name].kind
    upright = arm.plant["alpha"][0] == 0.0  # the first axis is vertical: no gravity torque
    bent = arm.plant["alpha"][1 : arm.n] != 0.0  # axes j and j + 1 are not parallel
    between = [0 < j < arm.n - 1 and (bent[j - 1] or bent[j]) for j in range(arm.n)]
    allowed = {
        "any": [True] * arm.n,
        "driven": [value > 0.5 for value in kinds],
        "lever": [value > 1.5 for value in kinds],
        "chain": [value > 0.5 and arm.n > 1 for value in kinds],
        "loaded": [value > 0.5 and not (upright and j == 0) for j, value in enumerate(kinds)],
        "last": [j == arm.n - 1 and arm.n > 1 for j in range(arm.n)],
        # An arm whose axes are all parallel takes a tilt, and any arm an offset of its last joint or of a
        # vertical first one, or among parallel ones, for other links: what is left would ask for an absurd
        # angle. A lever's ratio tells.
        "slewing": [upright and value > 0.5 for value in kinds],
        "inner": [value > 1.5 or (value > 0.5 and between[j]) for j, value in enumerate(kinds)],
        "outer": [j > 0 and value > 0.5 for j, value in enumerate(kinds)],
    }[kind]
    return [j for j, good in enumerate(allowed) if good]


def _lowest(path: Array) -> Array:
    return np.asarray(path.min(axis=0))


def _highest(path: Array) -> Array:
    return np.asarray(path.max(axis=0))


def scales(plant: Plant, q: Array, current: Array, rate: float, paths: list[Array]) -> Scales:
    """What a record (N, n) of the arm without a hidden effect, and all paths (N, n), say about sizes."""
    n = int(plant["n"])
    dq = np.gradient(q, 1.0 / rate, axis=0)
    middle = 0.5 * (q.max(axis=0) + q.min(axis=0))
    slope = np.array([native.drive(plant, j, float(middle[j]))[1] for j in range(n)])
    speed = np.abs(slope) * np.abs(dq).max(axis=0)
    motor = np.abs(slope * dq)
    friction = (plant["dry"][:n] * motor + plant["viscous"][:n] * motor**2).mean(axis=0)
    power = np.abs(plant["torque_constant"][:n] * current * slope * dq).sum(axis=1)
    low, high = (np.array([end(path) for path in paths]) for end in (_lowest, _highest))
    common = np.column_stack([low.max(axis=0), high.min(axis=0)])
    floor = max(float(np.quantile(heights(plant, path), 0.06)) for path in paths)
    return Scales(slope, speed, np.sqrt((current**2).mean(axis=0)), friction, common, floor, power, paths)


def heights(plant: Plant, q: Array) -> Array:
    """Height (N,) of the last link's tip [m]."""
    total = np.zeros((len(q), 3))
    frame = np.broadcast_to(np.eye(3), (len(q), 3, 3))
    for j in range(int(plant["n"])):
        ca, sa = math.cos(plant["alpha"][j]), math.sin(plant["alpha"][j])
        c, s = np.cos(q[:, j] + plant["theta"][j]), np.sin(q[:, j] + plant["theta"][j])
        zero = np.zeros_like(c)
        turn = np.array([[c, -s, zero], [ca * s, ca * c, zero - sa], [sa * s, sa * c, zero + ca]])
        step = np.array([plant["d"][j], -sa * plant["r"][j], ca * plant["r"][j]])
        total = total + frame @ step
        frame = frame @ turn.transpose(2, 0, 1)
    return np.asarray((total + frame @ plant["tip"])[:, 2])
