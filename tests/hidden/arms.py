"""Arms of the plant: drawn about a few designs, and written as the description a user would have."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator
from ruamel.yaml import YAML

from hidden import native
from hidden.native import Array, Plant

LEAD = 0.005  # m per turn of a screw
COUNTS = 4096  # per turn of a motor


@dataclass(frozen=True)
class Arm:
    """A drawn arm. plant: the truth without a hidden effect. position: (n, 2) [rad]. Others by joint."""

    name: str
    plant: Plant
    position: Array
    velocity: Array
    acceleration: Array

    @property
    def n(self) -> int:
        return int(self.plant["n"])


@dataclass(frozen=True)
class Joint:
    """One joint of a design. mass [kg], length of the link [m], drive: direct, screw, counts or none."""

    drive: str
    alpha: float
    d: float
    mass: float
    length: float
    position: tuple[float, float]
    theta: float = 0.0
    r: float = 0.0
    ratio: float = 100.0
    levers: tuple[float, float] = (0.35, 0.08)
    rev: int = 1
    friction: float = 1.0


UP, HANG = math.pi / 2, -math.pi / 2
SLEW = Joint("direct", 0.0, 0.0, 8.0, 0.15, (-1.4, 1.4))
BOOM = Joint("screw", UP, 0.08, 6.0, 0.45, (-0.55, 0.75), levers=(0.36, 0.09), friction=2.5)
STICK = Joint("screw", 0.0, 0.45, 4.0, 0.38, (-0.7, 0.6), theta=-0.9, levers=(0.33, 0.08), rev=-1)
DESIGNS: dict[str, tuple[Joint, ...]] = {
    "pendulum1": (Joint("none", UP, 0.0, 4.0, 0.5, (-2.5, 2.5), theta=HANG),),
    "pendulum2": (
        Joint("none", UP, 0.0, 4.0, 0.45, (-2.5, 2.5), theta=HANG),
        Joint("none", 0.0, 0.45, 2.5, 0.35, (-2.5, 2.5)),
    ),
    "direct2": (
        Joint("direct", UP, 0.0, 6.0, 0.4, (-1.3, 1.3), theta=HANG),
        Joint("direct", 0.0, 0.4, 4.0, 0.35, (-1.5, 1.5), ratio=80.0),
    ),
    "direct3": (
        SLEW,
        Joint("direct", UP, 0.06, 6.0, 0.42, (-0.4, 1.9), ratio=120.0, friction=1.6),
        Joint("direct", 0.0, 0.42, 3.5, 0.36, (-2.2, 0.2), ratio=100.0),
    ),
    "direct6": (
        SLEW,
        Joint("direct", UP, 0.06, 7.0, 0.42, (-0.2, 1.9), ratio=120.0, friction=3.0),
        Joint("direct", 0.0, 0.42, 5.0, 0.2, (-2.2, 0.2), ratio=100.0, friction=1.8),
        Joint("direct", -UP, 0.05, 2.5, 0.1, (-1.8, 1.8), r=0.38, ratio=80.0),
        Joint("direct", UP, 0.0, 1.6, 0.1, (-1.5, 1.5), ratio=80.0),
        Joint("direct", -UP, 0.0, 0.8, 0.12, (-2.4, 2.4), r=0.08, ratio=60.0),
    ),
    "levered2": (
        Joint("screw", UP, 0.0, 7.0, 0.45, (-0.6, 0.75), levers=(0.35, 0.09), friction=3.0),
        Joint("screw", 0.0, 0.45, 4.5, 0.38, (-0.7, 0.65), theta=-0.7, levers=(0.33, 0.08), rev=-1),
    ),
    "levered3": (
        Joint("counts", UP, 0.0, 8.0, 0.5, (-0.55, 0.75), levers=(0.38, 0.1), friction=4.0),
        Joint(
            "counts", 0.0, 0.5, 5.0, 0.4, (-0.7, 0.6), theta=-0.8, levers=(0.34, 0.085), rev=-1, friction=1.5
        ),
        Joint("counts", 0.0, 0.4, 2.5, 0.25, (-0.7, 0.7), theta=-0.5, levers=(0.28, 0.06), friction=0.7),
    ),
    "mixed2": (
        Joint("direct", UP, 0.0, 6.0, 0.4, (-1.3, 1.3), theta=HANG),
        Joint("screw", 0.0, 0.4, 4.0, 0.35, (-0.7, 0.7), levers=(0.35, 0.08)),
    ),
    "mixed3": (SLEW, BOOM, STICK),
    "mixed4": (
        SLEW,
        BOOM,
        STICK,
        Joint("direct", 0.0, 0.38, 1.8, 0.2, (-1.2, 1.2), theta=-0.4, ratio=80.0),
    ),
    "mixed5": (
        SLEW,
        BOOM,
        STICK,
        Joint("direct", 0.0, 0.38, 2.0, 0.15, (-1.2, 1.2), theta=-0.4, ratio=80.0),
        Joint("direct", UP, 0.05, 1.2, 0.15, (-2.0, 2.0), r=0.1, ratio=60.0),
    ),
}
FREE = tuple(name for name in DESIGNS if name.startswith("pendulum"))
DRIVEN = tuple(name for name in DESIGNS if name not in FREE)


def draw(name: str, random: Generator) -> Arm:
    """The design of that name with masses, frictions and gains of its own."""
    if name not in DESIGNS:
        raise native.PlantError(f"no arm {name!r}; there are {', '.join(DESIGNS)}")
    design, plant = DESIGNS[name], native.new()
    plant["n"], plant["gravity"] = len(design), (0.0, 0.0, -9.81)
    plant["frequency"], plant["model_mass"] = 0.1, 0.9
    plant["position_gain"], plant["speed_gain"], plant["integral_gain"] = 20.0, 60.0, 300.0
    plant["tip"] = (design[-1].length, 0.0, 0.0)
    for j, joint in enumerate(design):
        _link(plant, j, joint, random)
        _drive(plant, j, joint, random)
    speed = np.array([1.6 if joint.drive == "direct" else 0.9 for joint in design])
    position = np.array([joint.position for joint in design])
    return Arm(name, plant, position, speed, np.round(6.0 * speed, 3))


def _link(plant: Plant, j: int, joint: Joint, random: Generator) -> None:
    plant["alpha"][j], plant["d"][j], plant["r"][j], plant["theta"][j] = (
        joint.alpha,
        joint.d,
        joint.r,
        joint.theta,
    )
    mass = joint.mass * random.uniform(0.8, 1.25)
    across = joint.length * random.uniform(0.2, 0.35, size=2)
    plant["mass"][j] = mass
    along = 0.5 * joint.length * random.uniform(0.8, 1.2)
    plant["com"][j] = (along, 0.15 * across[0] * random.normal(), 0.15 * across[1] * random.normal())
    box = np.array([joint.length, *across]) ** 2
    plain = np.diag(mass / 12.0 * (box.sum() - box))
    skewed, _ = np.linalg.qr(np.eye(3) + 0.1 * random.normal(size=(3, 3)))
    turned = skewed @ plain @ skewed.T
    plant["inertia"][j] = turned[np.triu_indices(3)]


def _drive(plant: Plant, j: int, joint: Joint, random: Generator) -> None:
    varied = random.uniform(0.8, 1.25, size=4)
    if joint.drive == "none":
        plant["dry"][j], plant["viscous"][j] = 0.10 * varied[0], 0.06 * varied[1]
        plant["torque_constant"][j], plant["revolution"][j] = 1.0, 2 * math.pi
        plant["joint_side"][j], plant["count"][j] = 1.0, 2 * math.pi / 2**17
        return
    unit = 1.0  # motor units per rad of the motor
    if joint.drive == "direct":
        plant["kind"][j], plant["ratio"][j] = 1.0, joint.ratio
    else:
        unit = COUNTS / (2 * math.pi) if joint.drive == "counts" else 1.0
        plant["kind"][j], plant["rev"][j] = 2.0, joint.rev
        plant["l1"][j], plant["l2"][j] = joint.levers
        low, high = joint.position[0] - 0.12, joint.position[1] + 0.12
        middle = math.radians(88)  # of the inner angle, at the middle of the range
        plant["offset"][j] = 0.5 * (low + high) - joint.rev * middle
        ends = [joint.rev * (q - plant["offset"][j]) for q in (low, high)]
        plant["length"][j] = [
            round(
                math.sqrt(sum(side**2 for side in joint.levers) - 2 * math.prod(joint.levers) * math.cos(a)),
                6,
            )
            for a in (min(ends), max(ends))
        ]
        plant["offset"][j] = round(float(plant["offset"][j]), 6)
        stroke = plant["length"][j][1] - plant["length"][j][0]
        plant["motor"][j] = (0.0, round(stroke / LEAD * 2 * math.pi * unit, 3))
    heavy = min(1.0, joint.mass / 4.0)
    plant["torque_constant"][j] = float(f"{0.05 * varied[0] / unit:.5g}")
    plant["rotor"][j] = 2.5e-5 * varied[1] * heavy / unit**2
    plant["viscous"][j] = 2.0e-4 * varied[2] * heavy / unit**2
    plant["dry"][j] = 0.022 * varied[3] * heavy * joint.friction / unit
    plant["revolution"][j] = 2 * math.pi * unit
    plant["count"][j] = 2 * math.pi * unit / COUNTS
    plant["current_limit"][j] = 40.0


def describe(arm: Arm, random: Generator, exact_links: bool = False) -> dict[str, Any]:
    """The arm's entry in arms.yaml; nominal links are some per cent off unless `exact_links`."""
    plant = arm.plant
    joints, links = [], {}
    for j in range(arm.n):
        low, high = (round(float(value), 4) for value in arm.position[j])
        limits = {
            "position": [low, high],
            "velocity": float(arm.velocity[j]),
            "acceleration": float(arm.acceleration[j]),
        }
        frame = {key: round(float(plant[key][j]), 9) for key in ("alpha", "d", "r", "theta")}
        joints.append({"name": f"j{j + 1}", **frame, "limits": limits, "drive": _described_drive(plant, j)})
        if plant["kind"][j] < 0.5:
            joints[-1]["effects"] = ["viscous_friction", "coulomb_friction"]
        off = 0.0 if exact_links else 0.05
        scale = 1.0 + off * random.normal()
        com = plant["com"][j] * (1.0 + off * random.normal(size=3))
        links[f"j{j + 1}"] = {
            "mass": _short(plant["mass"][j] * scale),
            "com": [_short(value) for value in com],
            "inertia": [_short(value * scale) for value in plant["inertia"][j]],
        }
    gravity = [_short(value) for value in plant["gravity"]]
    source = "Simulated; no such arm exists."
    return {"source": source, "gravity": gravity, "joints": joints, "links": links}


def _described_drive(plant: Plant, j: int) -> dict[str, Any]:
    kind = plant["kind"][j]
    if kind < 0.5:
        return {"type": "none"}
    common = {
        "torque_constant": float(plant["torque_constant"][j]),
        "current": float(plant["current_limit"][j]),
    }
    if kind < 1.5:
        return {"type": "direct", "ratio": float(plant["ratio"][j]), **common}
    return {
        "type": "levered",
        "l1": float(plant["l1"][j]),
        "l2": float(plant["l2"][j]),
        "length": [float(value) for value in plant["length"][j]],
        "motor": [float(value) for value in plant["motor"][j]],
        "rev": int(plant["rev"][j]),
        "offset": float(plant["offset"][j]),
        **common,
    }


def _short(value: float) -> float:
    return float(f"{value:.9g}")


def write_description(path: Path, name: str, entry: dict[str, Any]) -> None:
    """One arm as a file of arms."""
    writer = YAML()
    writer.default_flow_style = None
    writer.width = 110
    document = {"schema": 1, "convention": "khalil_kleinfinger", "arms": {name: entry}}
    with path.open("w", encoding="utf-8") as file:
        writer.dump(document, file)
