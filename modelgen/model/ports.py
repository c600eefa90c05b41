"""Ports place the forces of effects and say how much of each every coordinate feels (virtual work)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross
from modelgen.model.composite import mass_matrix
from modelgen.model.dynamics import joint_efforts
from modelgen.model.motion import Rates, link_motions
from modelgen.model.screws import Screw


@dataclass(frozen=True)
class Port:
    """One or more scalar rates: rows[a][n] is what a unit speed of coordinate n adds to rate a.

    bound: the variables of the law in the graph. accelerations: which of them are the derivatives of the
    first rates; the joints' accelerations enter these by the same rows.
    """

    rows: tuple[Mapping[int, Expr], ...]
    bound: Mapping[sp.Symbol, Expr]
    accelerations: tuple[sp.Symbol, ...]


class Surroundings:
    """Surroundings of a coordinate that a law may know of: the efforts and inertia beyond it.

    With `parameters`, link by link, they are computed; without, loads are the input "load", and what
    only the parameters tell does not exist.
    """

    def __init__(
        self, frames: Frames, rates: Rates, parameters: Sequence[Sequence[Expr]] | None = None
    ) -> None:
        self.frames = frames
        self.rates = rates
        self.parameters = parameters
        self._cache: dict[str, list[Expr]] = {}
        self._mass: list[list[Expr]] | None = None

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.frames.coordinates)

    @property
    def complete(self) -> bool:
        """Whether the parameters are known."""
        return self.parameters is not None

    def weight(self, n: int) -> Expr | None:
        """Effort of coordinate n that the links' weight takes [N m, N]; None where it is an input."""
        zeros = [self.frames.graph.zero] * self.n
        # the links at rest: their drives move as fast as they lag
        rest = [self.frames.lag_rates.get(k, zero) for k, zero in enumerate(zeros)]
        return self._efforts("weight", Rates(rest, zeros), n)

    def transmitted(self, n: int) -> Expr | None:
        """Effort of coordinate n that moves the links [N m, N]; None without parameters."""
        return self._efforts("transmitted", self.rates, n)

    def inertia(self, n: int) -> list[Expr] | None:
        """Column n of the links' mass matrix; None without parameters."""
        if self.parameters is None:
            return None
        if self._mass is None:
            self._mass = mass_matrix(self.frames, self.parameters)
        return [self._mass[k][n] for k in range(self.n)]

    def _efforts(self, name: str, rates: Rates, n: int) -> Expr | None:
        if self.parameters is None:
            return None
        if name not in self._cache:
            motions = link_motions(self.frames, rates)
            self._cache[name] = joint_efforts(self.frames, motions, self.parameters)
        return self._cache[name][n]


def origin_velocities(frames: Frames, dq: Sequence[Expr], spins: Sequence[Vector]) -> list[Vector]:
    """Velocity of the origin of every link's frame, in its own axes [m/s].

    dq: rates of the joints, of their links where these lag; spins: of the links, in their axes [rad/s].
    """
    zero = frames.graph.zero
    found: dict[int | None, Vector] = {None: (zero, zero, zero)}
    for i in frames.order:
        frame = frames[i]
        before = frame.antecedent
        spin: Vector = (zero, zero, zero) if before is None else spins[before]
        v = frame.to_link(add(found[before], cross(spin, frame.origin)))
        if frame.coordinate is not None and frame.prismatic:
            v = (v[0], v[1], v[2] + dq[frame.coordinate])
        found[i] = v
    return [found[i] for i in range(len(spins))]


def point_rows(screws: Mapping[int, Screw], place: Vector) -> tuple[Mapping[int, Expr], ...]:
    """Rows of the velocity x, y, z of a point of a link, then of the link's spin, in its axes. screws: of the
    link, by coordinate.
    """
    velocities = {n: (*add(v, cross(e, place)), *e) for n, (e, v) in screws.items()}
    rows = [{n: v[axis] for n, v in velocities.items()} for axis in range(6)]
    return tuple({n: e for n, e in row.items() if not e.is_zero} for row in rows)
