"""A transmission in numbers: its functions over arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp

from modelgen.numeric import Array
from modelgen.symbolic import geometry_symbol, number
from modelgen.transmission.transmission import Transmission

Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class Curves:
    """motor: q_m(q). joint: q(q_m). k1: dq_m/dq. slope: d^2 q_m/dq^2; each from (N,) to (N,).

    torque_constant: generalised force at the motor coordinate per input.
    """

    motor: Curve
    joint: Curve
    k1: Curve
    slope: Curve
    torque_constant: float

    def gain(self, q: Array) -> Array:
        """K(q) (N,): joint effort per input."""
        return self.torque_constant * self.k1(q)


@lru_cache(maxsize=256)
def curves(transmission: Transmission) -> Curves:
    """The functions of one transmission."""
    known = {geometry_symbol(name): value for name, value in transmission.symbols.items()}
    return _bound(_compiled(transmission, (), known), (), transmission)


@lru_cache(maxsize=256)
def curves_over_figures(transmission: Transmission) -> Curves:
    """The functions of one transmission, compiled once for its kind with the figures as inputs: quick where
    figures change often.
    """
    drive = transmission.drive
    if not drive.runtime:
        return curves(transmission)
    signs, values = {}, []
    for name, figure in drive.figures().items():
        value = getattr(drive, name)
        if figure.kind == "sign":
            signs[name] = int(value)
        else:
            values += [number(x, transmission.symbols) for x in (value if figure.pair else (value,))]
    return _bound(_compiled_kind(type(drive), tuple(signs.items())), values, transmission)


@lru_cache(maxsize=16)
def _compiled_kind(kind: Any, signs: tuple[tuple[str, int], ...]) -> tuple[Callable[..., Any], ...]:
    """The functions of any drive of a kind over its figures."""
    symbols: list[sp.Symbol] = []
    given: dict[str, Any] = dict(signs)
    for name, figure in kind.figures().items():
        if name not in given:
            names = [f"{name}0", f"{name}1"] if figure.pair else [name]
            own = [sp.Symbol(x, real=True) for x in names]
            given[name] = tuple(own) if figure.pair else own[0]
            symbols += own
    return _compiled(Transmission(kind(**given, torque_constant=1.0), {}), symbols, {})


def _compiled(
    t: Transmission, figures: Sequence[sp.Symbol], known: Mapping[sp.Symbol, float]
) -> tuple[Callable[..., Any], ...]:
    """motor, joint, k1, slope over their coordinate and these figures, with what is known."""
    expressions = ((t.q, t.motor()), (t.q_m, t.joint()), (t.q, t.k1()), (t.q, t.slope()))
    return tuple(
        sp.lambdify([x, *figures], sp.sympify(y).subs(known), "numpy", cse=True) for x, y in expressions
    )


def _bound(calls: Sequence[Callable[..., Any]], values: Sequence[float], t: Transmission) -> Curves:
    motor, joint, k1, slope = (_curve(call, values) for call in calls)
    return Curves(motor, joint, k1, slope, float(t.torque_constant))


def _curve(call: Callable[..., Any], values: Sequence[float]) -> Curve:
    def evaluate(x: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.broadcast_to(np.asarray(call(x, *values), dtype=np.float64), np.shape(x)).copy()

    return evaluate
