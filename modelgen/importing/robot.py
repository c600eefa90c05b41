"""A robot as its source describes it: links, joints between them, what is known of each.

Units are SI with radians. Poses are homogeneous 4 x 4 matrices. The drawn pose is the one in which the
source gives all its poses; a joint stands there at its `reference`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from modelgen.errors import Location
from modelgen.numeric import Array

MOVING = ("revolute", "prismatic")  # what a joint of one degree of freedom may be


@dataclass(frozen=True)
class Body:
    """A rigid body in the frame of its link: mass [kg], com (3,) [m], inertia (3, 3) about it [kg m^2]."""

    mass: float
    com: Array
    inertia: Array


@dataclass(frozen=True)
class SourceLink:
    """A link of the source, and its line in the file."""

    name: str
    body: Body | None = None
    line: int = 0


@dataclass(frozen=True)
class Mimic:
    """The coordinate is `multiplier` times that of the joint `master`, plus `offset` [rad, m]."""

    master: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class SourceLever:
    """A linear actuator between two points at l1 and l2 [m] from the joint's axis.

    rev, offset: coordinate = rev inner angle + offset [rad]. length: at the ends of the joint's range [m].
    """

    l1: float
    l2: float
    rev: int
    offset: float
    length: tuple[float, float]


@dataclass(frozen=True)
class SourceJoint:
    """A joint of the source between two of its links.

    kind: "revolute", "prismatic", "fixed", or the source's own word for what has several degrees of
    freedom. pose: joint frame in the parent link, drawn pose; the child link's frame is the joint's.
    axis: in the joint frame, of length 1; anchor: a point of it there [m]. reference: coordinate in the
    drawn pose [rad, m]. properties: what the joint resists with and stores, at the joint, by the names
    that the catalogue of effects gives them (`Traits.sources`); with a lever damping, friction and armature
    are those along the actuator. reduction: motor coordinate per joint coordinate, or per length of the
    lever's actuator. gain: force at the motor coordinate per input. most: largest input. alone: what acts by
    itself at the motor coordinate, each by the names of `Definition.simulated`.
    """

    name: str
    kind: str
    parent: str
    child: str
    pose: Array
    axis: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    anchor: Array = field(default_factory=lambda: np.zeros(3))
    reference: float = 0.0
    position: tuple[float, float] | None = None
    velocity: float | None = None
    effort: float | None = None
    properties: Mapping[str, float] = field(default_factory=dict)
    reduction: float = 1.0
    gain: float = 1.0
    most: float | None = None
    alone: tuple[Mapping[str, float], ...] = ()
    lever: SourceLever | None = None
    mimic: Mimic | None = None
    line: int = 0


@dataclass(frozen=True)
class SourcePair:
    """What resists and stores along q + ratio q_other; properties as those of a joint."""

    joint: str
    other: str
    ratio: float
    properties: Mapping[str, float]


@dataclass(frozen=True)
class Closure:
    """What ties joints or links together besides the tree: an equality, a tendon; refused by `text`.

    pair: what it comes to where both of its joints move; then it is not refused.
    """

    text: str
    joints: tuple[str, ...] = ()
    links: tuple[str, ...] = ()
    line: int = 0
    pair: SourcePair | None = None


@dataclass(frozen=True)
class Robot:
    """A source that has been read: a tree of links that stands on `root`.

    tools: links that the source has for their frames alone. remarks: what the user must know. file: its name
    as the user gave it.
    """

    name: str
    form: str  # what people call the format
    root: str
    links: Mapping[str, SourceLink]
    joints: tuple[SourceJoint, ...]
    gravity: Array = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    closures: tuple[Closure, ...] = ()
    remarks: tuple[str, ...] = ()
    inertials: bool = True  # whether the format has any
    file: str = ""

    def where(self, line: int) -> Location | None:
        """The place of a line in the file; None where either is not known."""
        return Location(self.file, line, 1) if self.file and line else None
