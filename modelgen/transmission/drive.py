"""A drive states the motor coordinate q_m(q) in SymPy, and all that other parts ask of its kind."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Self, get_type_hints

import sympy as sp

from modelgen.symbolic import Range, Scalar, number
from modelgen.transmission.actuator import Actuator
from modelgen.transmission.bars import Bar
from modelgen.transmission.figures import Figure

KINDS: dict[str, type[Drive]] = {}  # by name, in the order of definition


@dataclass(frozen=True)
class MotorLimits:
    """Limits in the motor coordinate: unit/s, unit/s^2, A."""

    velocity: float | None = None
    acceleration: float | None = None
    current: float | None = None


NO_LIMITS = MotorLimits()


@dataclass(frozen=True)
class Drive(ABC):
    """A drive of the description. Each kind is a frozen dataclass: its figures, then those of the motor.

    The generalised force at q_m is torque_constant i. Everything else follows from q_m(q), see
    `Transmission`. `drive: {type: ...}`, its checks and the JSON Schema follow from the class.
    """

    name: ClassVar[str]  # its type in the description; a class that has one is a kind
    text: ClassVar[str]
    driven: ClassVar[bool] = True  # whether there is a motor; else the input is the joint's effort
    unit: ClassVar[str] = "rad"  # of the motor coordinate; "unit" where that may be anything
    force_unit: ClassVar[str] = "J per rad per A"  # of the torque constant
    joint_type: ClassVar[str | None] = None  # of the joints that it can drive, None for either
    origin: ClassVar[str] = ""  # figure that is counted as q is; none where q_m may begin anywhere
    runtime: ClassVar[tuple[str, ...]] = ()  # figures that can be inputs of the generated code
    typical_inertia: ClassVar[float] = 1e-4  # at the motor coordinate, in its unit, of a self-test's arm

    if TYPE_CHECKING:  # fields that each kind has behind its figures

        @property
        def torque_constant(self) -> float:
            """Generalised force at the motor coordinate per input."""

        @property
        def limits(self) -> MotorLimits:
            """Limits in the motor coordinate."""

    def __init_subclass__(cls) -> None:
        """A class with a name is a kind of drive."""
        if "name" in cls.__dict__:
            KINDS[cls.name] = cls

    # -- the law --------------------------------------------------------------------------

    @abstractmethod
    def motor_from_joint(self, q: sp.Expr) -> sp.Expr:
        """q_m as a function of q."""

    @abstractmethod
    def joint_from_motor(self, q_m: sp.Expr) -> sp.Expr:
        """q as a function of q_m: the inverse of `motor_from_joint` on the drive's range."""

    def of_length(self) -> tuple[sp.Expr, sp.Expr] | None:
        """Motor coordinate per metre of the actuator, and at the length zero; None where it has no length."""
        return None

    def inverse_gain(self, q: sp.Symbol) -> sp.Expr:
        """1/K [A per N m or N]."""
        return 1 / (self.torque_constant * sp.diff(self.motor_from_joint(q), q))

    # -- where it works -------------------------------------------------------------------

    def reach(self) -> Range | None:
        """Lowest and highest q [rad or m] for figures that are numbers, within the dead centres.

        None where q has no end. Raises ValueError, a FigureError where one figure is to blame, where there
        is no such mechanism.
        """
        return None

    def stroke(self) -> Range | None:
        """Lowest and highest q_m where the description gives them; else they follow from `reach`."""
        return None

    @classmethod
    def refusal(cls, joint_type: str) -> str:
        """Why it cannot drive a joint of this type, "" where it can."""
        if cls.joint_type in (None, joint_type):
            return ""
        return f"found a drive {cls.name} on a {joint_type} joint, expected a {cls.joint_type} one"

    def guards(self, q: sp.Expr) -> tuple[sp.Expr, ...]:
        """Positive within the reach: for code that has the `runtime` figures as inputs."""
        return ()

    def motor_guards(self, q_m: sp.Expr) -> tuple[sp.Expr, ...]:
        """Positive where there is a q."""
        return ()

    # -- what it is called ----------------------------------------------------------------

    @property
    def title(self) -> str:
        """The kind in a few words."""
        return f"{self.name} drive"

    @property
    def decides_reach(self) -> str:
        """The figures on which `reach` depends, in words."""
        return ", ".join(self.figures())

    @property
    def decides_motor(self) -> str:
        """Figures that may be wrong where a log leaves the motor's range, in words; "" for none."""
        return f"the drive's {', '.join(self.figures())}" if self.figures() else ""

    # -- its figures ----------------------------------------------------------------------

    @classmethod
    def figures(cls) -> dict[str, Figure]:
        """Figures that the description gives, by name."""
        return _figures(cls)

    def changed(self, change: Callable[[str, Scalar], Scalar], names: tuple[str, ...] | None = None) -> Self:
        """The drive with other figures: those of `names`, else all but signs.

        change: from a figure's name, with 0 and 1 behind those of a pair, and its value to the new value.
        """
        new: dict[str, Any] = {}
        figures = self.figures()
        for name in [k for k, f in figures.items() if f.kind != "sign"] if names is None else names:
            value = getattr(self, name)
            if isinstance(value, tuple):
                new[name] = tuple(change(f"{name}{i}", x) for i, x in enumerate(value))
            else:
                new[name] = change(name, value)
        return replace(self, **new)

    def symbolic(self) -> Self:
        """The drive with SymPy expressions for all figures that may be symbolic."""
        names = tuple(name for name, figure in self.figures().items() if figure.symbolic)
        return self.changed(lambda _, value: sp.sympify(value), names)

    def numeric(self, symbols: Mapping[str, float]) -> Self:
        """The drive with numbers for figures. symbols: values of the arm's named geometry."""
        return self.changed(lambda _, value: number(value, symbols))

    def with_runtime(self, change: Callable[[str, Scalar], Scalar]) -> Self:
        """The drive with other `runtime` figures, symbols say; `change` as of `changed`."""
        return self.changed(change, self.runtime)

    def numbers(self) -> tuple[float, ...]:
        """The figures in their order, pairs as two; of a drive whose figures are numbers."""
        found: list[float] = []
        for name in self.figures():
            value = getattr(self, name)
            found += map(float, value if isinstance(value, tuple) else (value,))
        return tuple(found)

    def free_symbols(self) -> set[str]:
        """Names of the arm's symbols in its figures."""
        found: set[str] = set()

        def seen(_: str, value: Scalar) -> Scalar:
            found.update(symbol.name for symbol in sp.sympify(value).free_symbols)
            return value

        self.changed(seen)
        return found

    def with_torque_constant(self, value: float) -> Self:
        """The drive with another torque constant. Raises ValueError where there is no motor."""
        if not self.driven:
            raise ValueError("there is no motor")
        changes: dict[str, Any] = {"torque_constant": value}
        return replace(self, **changes)

    # -- what effects change of it, and find in it ----------------------------------------

    def shifted(self, by: float) -> Self:
        """The drive of a joint whose true coordinate is `by` [rad, m] more than q."""
        return self.changed(lambda _, value: value - by, (self.origin,)) if self.origin else self

    @property
    def actuator(self) -> Actuator | None:
        """The linear actuator that swings about its base, None where it has none."""
        return None

    def linkage(self, q: sp.Expr) -> tuple[Bar, ...]:
        """Bars between motor and joint at q, of a drive whose figures are numbers; none of a gear."""
        return ()

    def with_actuator(self, actuator: Actuator) -> Self:
        """The drive with another actuator, of those kinds that have one."""
        raise ValueError(f"a {self.title} has no linear actuator")


@cache
def _figures(kind: type[Drive]) -> dict[str, Figure]:
    """Fields that are annotated as figures, in their order."""
    found = {}
    for name, hint in get_type_hints(kind, include_extras=True).items():
        notes = [note for note in getattr(hint, "__metadata__", ()) if isinstance(note, Figure)]
        if notes:
            found[name] = notes[0]
    return found
