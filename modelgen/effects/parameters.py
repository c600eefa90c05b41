"""Parameters of effects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import sympy as sp

Values = Mapping[str, sp.Expr]  # of an effect's parameters, by name
ANY = (-float("inf"), float("inf"))
POSITIVE = (1e-12, float("inf"))


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    unit: {f} stands for the unit of the generalised force, {x} for that of the coordinate, {q} for that of
    the joint's where the coordinate is the motor's. symbol: its name among the standard parameters, before
    the joint's number (linear parameters only). default: None where the description must give a value for a
    nonlinear parameter. bounds: sensible values. structural: chooses the form of the law, or where it acts;
    no program leaves it open. joint: it is the number of a coordinate, from 1, for which people read the
    joint's name.

    What a diagnosis does with it. grid: where it begins to look for the value of a nonlinear parameter, in
    units of `scale`, ascending, of either sign: "speed" (95 % of the coordinate's speeds are below), "span"
    (of the coordinate), "time" (the record's length), "stiffness" (largest effort over the span) or "1"; a
    grid of one value is used as it is. turns: an angle, whose grid goes once round in equal steps, above
    zero; a value less a turn is the same. forms: values that are tried one by one, as different forms of the
    law; None leaves the default.
    step: of the slope about zero by which a parameter is estimated that is neither linear nor searched for;
    without one, a thousandth of the value that `Traits.shown` has. usual: size that a description's error
    usually has; None where nothing is known of it.
    """

    name: str
    unit: str
    text: str
    symbol: str = ""
    default: float | None = None
    bounds: tuple[float, float] = (0.0, float("inf"))
    structural: bool = False
    joint: bool = False
    scale: str = "1"
    grid: tuple[float, ...] = ()
    turns: bool = False
    forms: tuple[float | None, ...] = ()
    step: float | None = None
    usual: float | None = None


def at(**values: float) -> Mapping[str, float]:
    """Values of parameters by name, for `Traits.shown`."""
    return MappingProxyType(values)
