"""Frozen objects describe an arm: geometry, drives, effects, limits, nominal inertials.

Units are SI with radians; a motor coordinate is in the drive's own unit (rad, increments, ...).
A `Scalar` is a number, or a SymPy expression in the arm's named geometry symbols.
Every object has been validated when it exists; later stages need not check again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from modelgen.errors import Location
from modelgen.symbolic import Range, Scalar, geometry_symbol
from modelgen.transmission import UNDRIVEN, Drive

__all__ = [
    "OPTIONAL",
    "Arm",
    "Combined",
    "EffectUse",
    "Inertial",
    "Joint",
    "Limits",
    "Range",
    "Scalar",
    "Tool",
    "Transform",
    "Watched",
    "geometry_symbol",
]

# Marks what most arms do not have: the hash of a description then says nothing of it.
OPTIONAL = MappingProxyType({"optional": True})


@dataclass(frozen=True)
class Limits:
    """Limits of a joint coordinate: rad or m, per s, per s^2, and N m or N at the joint."""

    position: Range | None = None
    velocity: float | None = None
    acceleration: float | None = None
    effort: float | None = None


@dataclass(frozen=True)
class EffectUse:
    """One entry of a list `effects`: the effect's name and nominal values of its parameters."""

    name: str
    values: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    where: Location | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Joint:
    """One joint and the link that it carries, frame j by modified DH (Khalil-Kleinfinger).

    T(antecedent -> j) = Rot(z, gamma) Trans(z, b) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r),
    with the joint coordinate added to theta (revolute) or r (prismatic).
    `antecedent` is the index of another joint of the arm, None for the base.
    `locked` holds the coordinate of a joint that has left the model's coordinates. `lift` is how far along z
    the frame is drawn from where it stands (`base_parameters.analytic.slid`): places on the link are given
    there.
    """

    name: str
    type: str  # "revolute", "prismatic" or "fixed"
    alpha: Scalar = 0.0
    d: Scalar = 0.0
    r: Scalar = 0.0
    theta: Scalar = 0.0
    gamma: Scalar = 0.0
    b: Scalar = 0.0
    antecedent: int | None = None
    limits: Limits = Limits()
    drive: Drive = UNDRIVEN
    effects: tuple[EffectUse, ...] = ()
    locked: float | None = None
    lift: Scalar = field(default=0.0, metadata={"derived": True})
    where: Location | None = field(default=None, compare=False)

    @property
    def moving(self) -> bool:
        """Whether the joint has a coordinate in the model."""
        return self.type != "fixed" and self.locked is None

    @property
    def unit(self) -> str:
        """Unit of its coordinate."""
        return "m" if self.type == "prismatic" else "rad"


@dataclass(frozen=True)
class Inertial:
    """Nominal inertials of a link in its frame: kg, m, and kg m^2 about the centre of mass.

    `inertia` is (ixx, ixy, ixz, iyy, iyz, izz).
    """

    mass: float
    com: tuple[float, float, float]
    inertia: tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class Transform:
    """A fixed rotation (rows) and translation [m]."""

    rotation: tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]
    translation: tuple[float, float, float]


@dataclass(frozen=True)
class Tool:
    """A named frame on the link of joint `link` (an index): link <- tool."""

    name: str
    link: int
    transform: Transform


@dataclass(frozen=True)
class Combined:
    """A function that does the work of several at once. `at`: place of its name in the file; `where`: of each
    of the others.
    """

    name: str
    functions: tuple[str, ...]
    at: Location | None = field(default=None, compare=False)
    where: tuple[Location, ...] = field(default=(), compare=False)


@dataclass(frozen=True)
class Watched:
    """A parameter that a monitor follows, by its name. `where`: its place in the file."""

    name: str
    where: Location | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Arm:
    """One arm, as its description has it.

    Parameters
    ----------
    name : str
        Its name in the file.
    joints : tuple of Joint
        In YAML order; an antecedent may stand later in the file, without cycles.
    links : tuple of Inertial or None
        `links[i]` belongs to `joints[i]`: mass [kg], centre of mass [m], inertia [kg m^2].
    gravity : tuple of float
        Acceleration (3,) in the base frame [m/s^2].
    fluid_density : float
        Of the fluid around the arm [kg/m^3]; above 0 adds the buoyancy parameters.
    source : str
        Where the figures come from.
    symbols : mapping of str to float
        Values of the geometry's symbols [m, rad] by name.
    notes : tuple of str
        Remarks for the user that are not errors (a range cut to the stroke, say).
    effects : tuple of EffectUse
        Effects of the whole arm.
    base : Transform, optional
        World <- base frame, None where that is the world.
    tools : tuple of Tool
        Named frames on links.
    combined : tuple of Combined
        Functions that do the work of several at once.
    monitor : tuple of Watched
        Parameters that the function `monitor_step` follows.
    version : str
        Version of the description, "" where it has none.
    where : Location, optional
        Place of the arm in its file.
    document : str
        The text of the description that the arm was read from, in YAML.
    """

    name: str
    joints: tuple[Joint, ...]
    links: tuple[Inertial | None, ...]
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    fluid_density: float = 0.0
    source: str = ""
    symbols: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    notes: tuple[str, ...] = ()
    effects: tuple[EffectUse, ...] = field(default=(), metadata=OPTIONAL)
    base: Transform | None = field(default=None, metadata=OPTIONAL)
    tools: tuple[Tool, ...] = field(default=(), metadata=OPTIONAL)
    combined: tuple[Combined, ...] = field(default=(), metadata=OPTIONAL)
    monitor: tuple[Watched, ...] = field(default=(), metadata=OPTIONAL)
    version: str = field(default="", metadata=OPTIONAL)
    where: Location | None = field(default=None, compare=False)
    document: str = field(default="", compare=False, repr=False)

    @property
    def coordinates(self) -> tuple[int, ...]:
        """Indices into `joints` of the model's coordinates q1..qn, in order."""
        return tuple(i for i, joint in enumerate(self.joints) if joint.moving)

    @property
    def coordinate_names(self) -> list[str]:
        """Names of the joints of the coordinates."""
        return [self.joints[i].name for i in self.coordinates]

    @property
    def coordinate_units(self) -> list[str]:
        """Units of the coordinates, rad or m."""
        return [self.joints[i].unit for i in self.coordinates]

    @property
    def order(self) -> tuple[int, ...]:
        """Indices into `joints`, every antecedent before its successors, else in YAML order."""
        done: list[int] = []
        while len(done) < len(self.joints):
            done += [
                i
                for i, joint in enumerate(self.joints)
                if i not in done and (joint.antecedent is None or joint.antecedent in done)
            ]
        return tuple(done)

    def without_effects(self) -> Arm:
        """The arm with no effect of its own or of its joints, and nothing monitored, which may be theirs."""
        bare = tuple(replace(j, effects=()) for j in self.joints)
        return replace(self, joints=bare, effects=(), monitor=())
