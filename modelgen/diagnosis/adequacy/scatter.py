"""How much residuals differ between periods, phase by phase: noise need not be alike everywhere.

One reading far off, or noise that grows with the speed, leaves as much in the mean over the periods as its
share is; measured by what all rows differ, it would be a lack of fit. What rows of a record, a part of its
period or half a part differ is their noise where it is clearly more than that of all, and sums over
unlike noise have fewer degrees of freedom (Satterthwaite 1946).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import special

from modelgen.numeric import Array


@dataclass(frozen=True)
class Phases:
    """Sums of one joint in a record (rows of the period,): between and within periods, their degrees of
    freedom, and what rounding is expected to add between.
    """

    record: int
    between: Array
    within: Array
    free_between: Array
    free_within: Array
    rounding: Array


@dataclass(frozen=True)
class Chance:
    """What noise leaves between periods, for each independent phase: its mean square, and the degrees of
    freedom of sums of it between and within periods.
    """

    square: float
    between: float
    within: float


@dataclass
class Scatter:
    """Noise of one joint by record and phase, as clear as `significance` asks.

    squares, free: mean square and degrees of freedom of each kind of noise, the usual one first; kinds: by
    record which of them a phase has (rows of the period,).
    """

    phases: Sequence[Phases]
    significance: float
    parts: int
    squares: list[float] = field(init=False)
    free: list[float] = field(init=False)
    kinds: list[NDArray[np.intp]] = field(init=False)

    def __post_init__(self) -> None:
        self.kinds = [np.zeros(len(one.within), dtype=np.intp) for one in self.phases]
        for _ in range(self.parts):  # a place that has more makes that of all rows too large
            before = self.kinds
            usual = [(one, kinds == 0) for one, kinds in zip(self.phases, before, strict=True)]
            free = sum(float(one.free_within[there].sum()) for one, there in usual)
            if free <= 0.0:
                break
            self.squares = [sum(float(one.within[there].sum()) for one, there in usual) / free]
            self.free = [free]
            self.kinds = [np.zeros_like(kinds) for kinds in before]
            for one, kinds in zip(self.phases, self.kinds, strict=True):
                for pieces in (1, self.parts, 2 * self.parts):
                    for begin, end in parts(len(kinds), pieces)[::2]:
                        self._look(one, kinds, slice(begin, end))
            if all(map(np.array_equal, before, self.kinds)):
                break
        # Errors of the parameters, which noise anywhere makes, repeat where there is little of it too.
        free = sum(float(one.free_within.sum()) for one in self.phases)
        every = sum(float(one.within.sum()) for one in self.phases) / free
        self.squares = [every, *(max(every, own) for own in self.squares[1:])]
        self.free[0] = free

    def at(self, record: int, phases: NDArray[np.intp]) -> Chance:
        """Of some phases of the record of that place among those that repeat."""
        return self._chance([(self.phases[record].free_between[phases], self.kinds[record][phases])])

    def everywhere(self) -> Chance:
        """Of all phases of all records."""
        rows = [(one.free_between, kinds) for one, kinds in zip(self.phases, self.kinds, strict=True)]
        return self._chance(rows)

    def _look(self, one: Phases, kinds: NDArray[np.intp], piece: slice) -> None:
        """Give a piece of a record a noise of its own where it is clearly another than that of its place."""
        count = float(one.free_within[piece].sum())
        if count <= 0.0:
            return
        own, here = float(one.within[piece].sum()) / count, int(kinds[piece][0])
        ratio = own / self.squares[here] if self.squares[here] > 0.0 else 1.0
        if ratio > self._quantile(count, self.free[here]):
            kinds[piece] = len(self.squares)
            self.squares.append(own)
            self.free.append(count)
        elif here and ratio < 1.0 / self._quantile(self.free[here], count):
            kinds[piece] = 0  # beside a place that has more

    def _quantile(self, first: float, second: float) -> float:
        return float(special.fdtri(first, second, 1.0 - self.significance))

    def _chance(self, rows: Sequence[tuple[Array, NDArray[np.intp]]]) -> Chance:
        squares, free = np.array(self.squares), np.array(self.free)
        count = np.sum([np.bincount(kinds, weights, len(squares)) for weights, kinds in rows], axis=0)
        sums = count * squares
        total = float(sums.sum())
        return Chance(
            total / float(count.sum()),
            total**2 / float((sums * squares).sum()),
            total**2 / float((sums**2 / free).sum()),
        )


def parts(rows: int, count: int) -> list[tuple[int, int]]:
    """First and last phase (exclusive, beyond the end: of the next period) of each of `count` parts of `rows`
    phases, each followed by the one halfway to the next.
    """
    edges = [round(half * rows / (2 * count)) for half in range(2 * count + 2)]
    return [(edges[half], edges[half + 2]) for half in range(2 * count)]
