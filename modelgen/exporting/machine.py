"""What is exported of an arm, before any format: links with their frames and bodies, and what acts on joints.

Units are SI with radians. A coordinate `y` of the arm carries properties: damping, friction and the others by
the names of `Definition.simulated`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from modelgen.importing.robot import Body
from modelgen.numeric import Array

Properties = dict[str, float]


@dataclass(frozen=True)
class Lever:
    """A linear actuator between two points, whose length gives the motor coordinate but for a constant.

    base: its end in the frame before the joint, tip: in the joint's own (3,) [m]. per_length: motor units per
    metre, from `zero` [m] on.
    """

    base: Array
    tip: Array
    per_length: float
    zero: float

    def length(self, motor: float) -> float:
        """Length [m] at a motor coordinate."""
        return self.zero + motor / self.per_length


@dataclass(frozen=True)
class Axis:
    """A coordinate of the model: its drive, and what it has at the joint and at the motor.

    number: from 0. ratio: motor coordinate per joint coordinate; where that changes, the one in the middle of
    the range, with joint and motor coordinate there in `middle`. gain: generalised force at the motor
    coordinate per input. varies: the ratio does. current: largest input. input: what lies before the effort.
    alone: what stands by itself, with its place, "joint" or "motor".
    """

    number: int
    driven: bool
    ratio: float
    middle: tuple[float, float]
    gain: float
    varies: bool
    lever: Lever | None
    current: float | None
    at_joint: Properties = field(default_factory=dict)
    at_motor: Properties = field(default_factory=dict)
    input: Properties = field(default_factory=dict)
    alone: list[tuple[str, Properties]] = field(default_factory=list)

    def joined(self) -> Properties:
        """What the joint has with what its motor has, of a motor that turns with it by `ratio`.

        Without constant forces, which belong to the input.
        """
        found = {name: value for name, value in self.at_joint.items() if name != "force"}
        scale = abs(self.ratio)
        for name, value in self.at_motor.items():
            if name in POWERS:
                found[name] = found.get(name, 0.0) + value * scale ** POWERS[name]
        if "stiffness" in self.at_motor and "stiffness" not in self.at_joint:
            found["rest"] = self.middle[0] + (self.at_motor["rest"] - self.middle[1]) / self.ratio
        return found

    def push(self) -> float:
        """Constant force at the motor coordinate that opposes the input."""
        return self.at_motor.get("force", 0.0) + self.at_joint.get("force", 0.0) / self.ratio


# Power of the ratio by which a property is greater at the joint than at the motor.
POWERS: Mapping[str, int] = {
    "damping": 2,
    "quadratic": 3,
    "cubic": 4,
    "armature": 2,
    "friction": 1,
    "stiffness": 2,
}


@dataclass(frozen=True)
class Link:
    """A link, and the joint that carries it; its frame is the joint's, z along the axis.

    before: index of the link that carries the joint, None for the base. pose: its frame there (4, 4) where
    the coordinate is zero. body: None where nothing is known of it.
    """

    name: str
    kind: str  # "revolute", "prismatic", "fixed"
    before: int | None
    pose: Array
    body: Body
    position: tuple[float, float] | None = None
    velocity: float | None = None
    effort: float | None = None
    axis: Axis | None = None


@dataclass(frozen=True)
class Coupling:
    """Properties of y = q + ratio q_other; indices of links."""

    name: str
    link: int
    other: int
    ratio: float
    properties: Properties = field(default_factory=dict)


@dataclass(frozen=True)
class Tool:
    """A named frame (4, 4) on a link, by its index."""

    name: str
    link: int
    frame: Array


@dataclass(frozen=True)
class Machine:
    """What is exported. base: world <- base frame (4, 4). gravity: (3,) in the world [m/s^2].

    links: in the order of the arm's joints. order: their indices, those before first.
    """

    name: str
    source: str
    base: Array
    gravity: Array
    links: tuple[Link, ...]
    order: tuple[int, ...]
    tools: tuple[Tool, ...]
    couplings: list[Coupling] = field(default_factory=list)

    def carried(self, index: int | None) -> list[int]:
        """Indices of the links that a link carries, or the base."""
        return [i for i in self.order if self.links[i].before == index]

    @property
    def moving(self) -> list[Link]:
        """Links whose joint has a coordinate, in the order of the coordinates."""
        return [link for link in self.links if link.axis is not None]

    def properties(self) -> list[Properties]:
        """All that acts on joints, motors and pairs."""
        axes = [link.axis for link in self.links if link.axis is not None]
        own = [p for axis in axes for p in (axis.at_joint, axis.at_motor)]
        return own + [coupling.properties for coupling in self.couplings]
