"""One sine and one cosine for each revolute joint, whatever asks for them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache

import sympy as sp

from modelgen.description.objects import Arm, Scalar
from modelgen.geometry.scalars import Scalars
from modelgen.graph import Expr


class Trigonometry:
    """Sines and cosines of q_i plus a constant.

    The library is called once for the joint's own angle q_i + theta (for q_i alone where theta is
    a multiple of a right angle); every other constant follows by the sum of angles.
    With `given`, sine and cosine of q are the inputs `sin_q` and `cos_q`. `lags`: how far links stay
    behind their drives, by coordinate; the angles are those of the links.
    """

    def __init__(
        self, arm: Arm, scalars: Scalars, given: bool = False, lags: Mapping[int, Expr] | None = None
    ) -> None:
        self.graph = scalars.graph
        self.scalars = scalars
        self.lags = lags or {}
        self.base: list[Scalar] = []
        self.pairs: list[tuple[Expr, Expr]] = []
        for n, i in enumerate(arm.coordinates):
            theta = arm.joints[i].theta
            quarter = isinstance(theta, float) and abs(math.remainder(theta, math.pi / 2)) < 1e-12
            shift: Scalar = 0.0 if quarter or given else theta
            lag = self.lags.get(n)
            if given:
                pair = self.graph.input("sin_q", n), self.graph.input("cos_q", n)
                if lag is not None:
                    s, c = self.graph.call("sin", lag), self.graph.call("cos", lag)
                    pair = pair[0] * c - pair[1] * s, pair[1] * c + pair[0] * s
            else:
                q = self.graph.input("q", n)
                angle = (q if lag is None else q - lag) + scalars(shift)
                pair = self.graph.call("sin", angle), self.graph.call("cos", angle)
            self.base.append(shift)
            self.pairs.append(pair)

    def of(self, coordinate: int, shift: Scalar = 0.0) -> tuple[Expr, Expr]:
        """Sine and cosine of q_coordinate + shift."""
        sine, cosine = self.pairs[coordinate]
        s, c = self.scalars.sin_cos(shift - self.base[coordinate])
        return sine * c + cosine * s, cosine * c - sine * s

    def lookup(self, coordinate: int, symbol: sp.Symbol, angle: sp.Expr) -> tuple[Expr, Expr] | None:
        """Sine and cosine of `angle` = +-symbol + constant, the drive's; None for any other angle."""
        if coordinate in self.lags:
            return None
        found = _turned(angle, symbol)
        if found is None:
            return None
        forwards, shift = found
        sine, cosine = self.of(coordinate, shift)
        return (sine if forwards else -sine), cosine


@lru_cache(maxsize=1024)
def _turned(angle: sp.Expr, symbol: sp.Symbol) -> tuple[bool, Scalar] | None:
    """Sign (whether plus) and constant of +-(symbol + constant); None for any other angle."""
    slope = sp.diff(angle, symbol)
    if slope not in (1, -1):
        return None
    shift = sp.expand(slope * angle - symbol)
    if shift.has(symbol):
        return None
    return slope == 1, float(shift) if shift.is_number else shift
