"""What an effect is: one law in SymPy, from which everything else is derived.

The law is a generalised force (positive where it opposes the input) over the variables of its
coordinate. It is linear in its linear parameters: their columns of the regressor are its derivatives.
Nonlinear parameters are fixed by the description; states advance by `step`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import sympy as sp


@dataclass(frozen=True)
class Variables:
    """What a law may depend on, in the coordinate that the effect belongs to.

    position, velocity, acceleration: of the motor coordinate q_m for an effect on the motor side, of
    the joint coordinate q on the joint side. time [s]; state: the effect's own states.
    """

    position: sp.Symbol
    velocity: sp.Symbol
    acceleration: sp.Symbol
    time: sp.Symbol
    state: Mapping[str, sp.Symbol]


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    unit: {f} stands for the unit of the generalised force, {x} for that of the coordinate. symbol: its
    name among the standard parameters, before the joint's number (linear parameters only). default:
    None where the description must give a value for a nonlinear parameter. bounds: sensible values.
    """

    name: str
    unit: str
    text: str
    symbol: str = ""
    default: float | None = None
    bounds: tuple[float, float] = (0.0, float("inf"))


class Effect(ABC):
    """One effect of the catalogue. A subclass is a law and its description, nothing else."""

    name: ClassVar[str]
    text: ClassVar[str]
    reference: ClassVar[str]
    side: ClassVar[str] = "motor"  # or "joint"
    linear: ClassVar[tuple[Parameter, ...]]
    nonlinear: ClassVar[tuple[Parameter, ...]] = ()
    states: ClassVar[tuple[str, ...]] = ()

    @abstractmethod
    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """Generalised force for the parameters `p`, by name."""

    def step(self, x: Variables, p: Mapping[str, sp.Expr], dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """The states after dt [s] at constant velocity; every name of `states`."""
        return {}

    def potential(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """Energy stored [J], up to a constant; zero for what is not conservative."""
        return sp.Integer(0)

    def values(self, given: Mapping[str, float]) -> dict[str, float]:
        """Nominal values of the linear parameters from the description's, where it gives them."""
        names = {parameter.name for parameter in self.linear}
        return {name: value for name, value in given.items() if name in names}

    @classmethod
    def accepted(cls) -> tuple[Parameter, ...]:
        """The parameters that a description may set."""
        return (*cls.linear, *cls.nonlinear)
