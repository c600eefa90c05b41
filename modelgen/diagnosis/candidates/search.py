"""Candidates tried against one system: their values searched for, and what they then explain."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import TypeAlias

import numpy as np

from modelgen.diagnosis.candidates.candidate import (
    Candidate,
    Values,
    at_links,
    grid_unit,
    richer_instead,
    search_of,
)
from modelgen.diagnosis.candidates.columns import candidate_columns, of_part, unchanging, where_there
from modelgen.diagnosis.candidates.fitted import FittedCandidate, below_zero, named
from modelgen.diagnosis.candidates.periodogram import waves
from modelgen.diagnosis.candidates.prior_odds import prior_penalty
from modelgen.diagnosis.evidence import System
from modelgen.numeric import Array

# Budgets of the searches: how finely values are found decides nothing.
REFINEMENTS = 9  # golden sections: to 1.3 % of a grid's interval
GOLDEN = (math.sqrt(5) - 1) / 2
REACH, FAR = 2.5, 8.0  # factors either way over which a scanned value and others are searched
SECTIONS = 5  # golden sections over each of several values in turn
ROUNDS = 2  # over all values in turn
HALVINGS = 6  # between two values of a scan
SECANTS = 2  # times a column that follows no line is taken at the value found
SETTLED = 1.0  # change of evidence that needs no more of it
Columns: TypeAlias = dict[object, list[Array] | None]  # of every record, by candidate and values


class Search:
    """Tries candidates against one system, with the arm's parameters as they are found in it.

    known: columns for these rows, by candidate and values. They outlive a search: those that change with the
    arm's parameters serve the next one to pass over what explains nothing, whatever the parameters are.
    elastic: joints with an elastic joint or play among the system's causes.
    """

    def __init__(
        self,
        system: System,
        known: Columns | None = None,
        elastic: Collection[int | None] = (),
    ) -> None:
        self.system = system
        self.known = {} if known is None else known
        self.equations = system.equations
        self.rows = system.rows
        self.limits = system.equations.thresholds.candidates
        self.elastic = elastic
        self.base = system.base
        self.fresh = True  # whether columns that change are made anew
        self.aged = False  # whether some were not
        self.renewed: set[object] = set()  # made with the parameters of this search

    def trial(self, candidate: Candidate) -> FittedCandidate | None:
        """The best that the candidate can do; None where it adds nothing of its own.

        What some records have too little of, the others have too much of.
        """
        found = self._tried(candidate)
        if found is None or not candidate.coming or not below_zero(found):
            return found
        every = frozenset(range(len(self.rows)))
        return self._tried(replace(candidate, absent=every - candidate.absent))

    def _tried(self, candidate: Candidate) -> FittedCandidate | None:
        self.fresh, self.aged = False, False
        found = self._trial(candidate)
        if found is not None and self.aged and found.gain.delta_bic >= self.limits.min_refined_delta_bic:
            self.fresh = True
            found = self._trial(candidate)
        if found is None or found.gain.delta_bic < self.limits.min_refined_delta_bic or not candidate.curved:
            return found
        for _ in range(SECANTS):
            before, extra = found, float(len(found.values))
            found = self._at(candidate, found.values, extra, found.parameters) or found
            if abs(found.gain.delta_bic - before.gain.delta_bic) < SETTLED:
                break
        return found

    def learn(self, columns: Columns) -> None:
        """Takes columns over that this search made in another process."""
        self.known.update(columns)
        self.renewed |= columns.keys()

    def _trial(self, candidate: Candidate) -> FittedCandidate | None:
        if candidate.definition.periodic:
            return self._periodic(candidate)
        if candidate.elastic:
            if at_links(candidate.joint, self.rows) and candidate.joint in self.elastic:
                return None  # what is left of one looks like the other
            found = self._compliant(candidate)
            richer = [] if found is None else richer_instead(candidate, self.equations)
            # impacts of a loose link look elastic; the other way round they do not
            others = [other for other in map(self._compliant, richer) if other is not None]
            return (
                None
                if found and any(ahead(other, found, self.limits.certain_delta_bic) for other in others)
                else found
            )
        if not candidate.searched:
            return self._at(candidate, {}, 0.0)
        (parameter,) = candidate.searched[:1]
        unit = grid_unit(parameter.scale, candidate.effect, candidate.joint, self.equations)
        if not unit > 0:
            return None
        grid = [unit * g for g in parameter.grid]
        trials = [self._at(candidate, {parameter.name: x}, 1.0) for x in grid]
        best = _best(trials)
        if best is None or best.gain.delta_bic < self.limits.min_refined_delta_bic:
            return best
        value = grid[trials.index(best)]
        alike = sorted(abs(x) for x in grid if (x < 0.0) == (value < 0.0))
        low, high = bracket(alike, alike.index(abs(value)), turns=parameter.turns)
        return self._refined(candidate, parameter.name, low, high, best, 1.0)

    def _at(
        self, candidate: Candidate, values: Values, extra: float, around: Values | None = None
    ) -> FittedCandidate | None:
        if around is None:
            columns = self._columns(candidate, values)
        else:
            columns = candidate_columns(candidate, around, self.equations, self.base)
        most = np.sqrt(np.sqrt(np.finfo(np.float64).max))  # what runs away leaves no room for squares
        if columns is None or not all((np.abs(c) < most).all() for c in columns):
            return None
        gain = self.system.gain(columns, extra, candidate.positive, passing=candidate.passing)
        if gain is None:
            return None
        held = gain.values == 0.0
        if held.any():  # by its bounds, or for the records cannot show it: stays zero in every fit to come
            columns = [np.where(held, 0.0, c) for c in columns]
        charged = prior_penalty(candidate, named(candidate, gain.values), self.equations.arm)
        gain = replace(gain, delta_bic=gain.delta_bic - charged)
        return FittedCandidate(candidate, dict(values), columns, gain, charged, dict(around or {}))

    def _columns(self, candidate: Candidate, values: Values) -> list[Array] | None:
        given = {**candidate.fixed, **values}
        key = *candidate.place, tuple(sorted(given.items()))
        stays = unchanging(candidate, self.equations.evaluator)
        if key not in self.known or (self.fresh and not stays and key not in self.renewed):
            every = replace(candidate, part=(), absent=frozenset())
            self.known[key] = candidate_columns(every, values, self.equations, self.base)
            self.renewed.add(key)
        elif not stays and key not in self.renewed:
            self.aged = True
        found = self.known[key]
        return None if found is None else where_there(candidate, of_part(candidate, found))

    def _refined(
        self, candidate: Candidate, name: str, low: float, high: float, best: FittedCandidate, extra: float
    ) -> FittedCandidate:
        """Golden section over the logarithm of values with the sign of the best."""
        sign = math.copysign(1.0, best.values[name])

        def at(x: float) -> FittedCandidate | None:
            return self._at(candidate, {**best.values, name: sign * math.exp(x)}, extra)

        return golden(at, math.log(low), math.log(high), best)

    def _compliant(self, candidate: Candidate) -> FittedCandidate | None:
        """A scan over the grids, then a section over each value in turn.

        Where some values let the records have about as much as was simulated, those are kept to.
        """
        search = search_of(candidate, self.rows)
        units = {
            p.name: grid_unit(p.scale, candidate.effect, candidate.joint, self.equations) for p in search
        }
        if not all(unit > 0 for unit in units.values()):
            return None
        extra = float(len(search))
        first, *others = (p.name for p in search)
        along, *across = ([units[p.name] * g for g in p.grid] for p in search)
        scanned, found = [], []
        for values in product(*across):
            held = dict(zip(others, values, strict=True))
            line = [self._at(candidate, {first: x, **held}, extra) for x in along]
            own: list[FittedCandidate | None] = [t for t in line if t is not None and self._whole(t)]
            found += own or [self._between(line, first, extra)]
            scanned += line
        best, whole = _best(found), True
        if best is None and not at_links(candidate.joint, self.rows):
            best, whole = _best(scanned), False
        if best is None or best.gain.delta_bic < self.limits.min_refined_delta_bic:
            return best
        for turn in range(ROUNDS):
            for name in (p.name for p in reversed(search)):
                reach = (REACH if name == first or turn else FAR) ** (0.5**turn)

                def at(x: float, name: str = name, held: FittedCandidate = best) -> FittedCandidate | None:
                    found = self._at(candidate, {**held.values, name: math.exp(x)}, extra)
                    return found if found is None or not whole or self._whole(found) else None

                middle = math.log(best.values[name])
                best = golden(at, middle - math.log(reach), middle + math.log(reach), best, SECTIONS)
        return best

    def _whole(self, found: FittedCandidate) -> bool:
        """Whether about as much was found as was simulated."""
        low, high = self.limits.compliant_share
        return bool(low < found.gain.values[0] < high)

    def _between(
        self, scanned: Sequence[FittedCandidate | None], name: str, extra: float
    ) -> FittedCandidate | None:
        """Where less of what was simulated is found at one value of a scan and more at the next, one between
        them at which all of it is. None where no neighbours are so.
        """
        for low, high in pairwise(t for t in scanned if t is not None):
            if low.gain.values[0] < 1.0 < high.gain.values[0]:
                return self._halved(low, high, name, extra)
        return None

    def _halved(
        self, low: FittedCandidate, high: FittedCandidate, name: str, extra: float
    ) -> FittedCandidate | None:
        for _ in range(HALVINGS):
            middle = math.sqrt(low.values[name] * high.values[name])
            found = self._at(low.candidate, {**low.values, name: middle}, extra)
            if found is None or self._whole(found):
                return found
            if found.gain.values[0] < 1.0:
                low = found
            else:
                high = found
        return None

    def _periodic(self, candidate: Candidate) -> FittedCandidate | None:
        assert candidate.joint is not None
        j = candidate.joint - 1
        residual, position, speed = [], [], []
        for r, e in zip(self.rows, self.system.residuals, strict=True):
            m = r.moving[:, j]
            residual.append(e[m, j])
            position.append(r.prepared.picked(r.prepared.motor)[m, j])
            speed.append(r.prepared.picked(r.prepared.dmotor)[m, j])
        together = [np.concatenate(x) for x in (residual, position, speed)]
        cutoff = self.rows[0].prepared.settings.cutoff or self.rows[0].prepared.rate / 2
        per_harmonic = 2 * np.pi / candidate.fixed["revolution"]
        best: FittedCandidate | None = None
        price, worth = self.limits.wave_search_price, self.limits.min_refined_delta_bic
        step = np.pi / max(float(np.ptp(together[1])), 1e-12) if len(together[1]) else 0.0
        for wave in waves(together[0], together[1], together[2], cutoff, self.limits):
            harmonic = wave / per_harmonic  # no whole number where a stage of a gear makes it
            found = self._at(candidate, {"harmonic": harmonic}, price)
            if found is not None and found.gain.delta_bic > worth:
                width = step / 2 / per_harmonic
                low, high = harmonic - width, harmonic + width
                found = self._refined(candidate, "harmonic", low, high, found, price)
            best = _best([best, found])
        return best


def ahead(one: FittedCandidate, other: FittedCandidate, certain: float) -> bool:
    """Whether one explains more than the other by more than what is certain."""
    return one.gain.delta_bic - other.gain.delta_bic > certain


def bracket(grid: Sequence[float], k: int, *, turns: bool) -> tuple[float, float]:
    """Between the neighbours of the k-th value; at an end from it on, but for angles, which go round."""
    last = len(grid) - 1
    if turns and k == 0:
        return grid[last], grid[1] + math.tau
    if turns and k == last:
        return grid[last - 1], grid[0] + math.tau
    return grid[max(0, k - 1)], grid[min(last, k + 1)]


def golden(
    at: Callable[[float], FittedCandidate | None],
    low: float,
    high: float,
    best: FittedCandidate,
    sections: int = REFINEMENTS,
) -> FittedCandidate:
    """The best trial of a golden section search on [low, high]."""
    a, b = low, high
    inner = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)]
    found = [at(inner[0]), at(inner[1])]
    for _ in range(sections):
        scores = [-math.inf if t is None else t.gain.delta_bic for t in found]
        best = _best([best, *found]) or best
        if scores[0] > scores[1]:
            b = inner[1]
            inner = [b - GOLDEN * (b - a), inner[0]]
            found = [at(inner[0]), found[0]]
        else:
            a = inner[0]
            inner = [inner[1], a + GOLDEN * (b - a)]
            found = [found[1], at(inner[1])]
    return _best([best, *found]) or best


def _best(trials: Sequence[FittedCandidate | None]) -> FittedCandidate | None:
    there = [t for t in trials if t is not None]
    return max(there, key=lambda t: t.gain.delta_bic) if there else None
