"""Values of elastic joints and play beside the arm's parameters.

What such a joint adds to the inputs follows from the efforts that it transmits, and these from parameters
that took over some of what it does while it was not known: a link that seemed half as heavy lets a joint seem
twice as soft, or a gap a tenth as wide. Both are found together: for every value that is tried, the
parameters settle beside what is simulated with it, half a step at a time. A gap behind a link's own position
stays as it was found: it shows at its edges alone, and any width between them leaves the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from scipy.optimize import minimize

from modelgen.diagnosis.candidates import (
    Candidate,
    FittedCandidate,
    Values,
    ahead,
    beside,
    candidate_columns,
    sensible,
    with_causes,
)
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.options.thresholds import Thresholds
from modelgen.diagnosis.selection.cause import Cause
from modelgen.diagnosis.selection.elastic_fit import ElasticFit, smooth
from modelgen.diagnosis.validation import Judgement
from modelgen.jobs import HERE, Where, forked
from modelgen.numeric import Array
from modelgen.regression.weighted import stacked, weighted_fit, weights_of

# A gap has minima of its own at other widths, and what was found beside a rigid arm's parameters may be far
# from what is best beside the right ones: times the value that was found, where the search begins.
STARTS = {"play": (0.3, 1.0, 3.0, 10.0), "stiffness": (0.3, 1.0, 3.0)}
FIRST, SETTLING, TURNS = 8, 4, 1  # half steps of the parameters: at what was found, at a start, at a trial
EDGE = 0.4  # of the first simplex, in logarithms
MOST = 45  # trials
FINE, EVEN = 0.03, 1e-4  # in logarithms, of the values and of what is left
SINGULAR = 1e-10
LEAST = 1e-300
Judged = tuple[FittedCandidate, Judgement]
_Begun = tuple[Values, float, Array]  # values, what they leave, parameters beside them


def refine(causes: Sequence[Cause], equations: Equations) -> None:
    """Finds the values of the gaps among the causes anew, beside all others; see `stiffness` for the rest."""
    for cause in causes:
        if "play" in cause.trial.values and "stiffness" in cause.trial.values:
            others = [c.trial for c in causes if c is not cause]
            found = best_beside(cause.trial, [cause.trial.values], others, equations)
            cause.trial = found or cause.trial


def best_beside(
    trial: FittedCandidate,
    starts: Sequence[Values],
    others: Sequence[FittedCandidate],
    equations: Equations,
) -> FittedCandidate | None:
    """An elastic joint or a gap with its best values beside others, whose columns stay; None where a rigid
    joint leaves less. starts: where the search may begin.
    """
    place = _Beside(equations, others, trial)
    return place.best([place.begun(values) for values in starts])


def refined(
    trials: Sequence[FittedCandidate],
    astray: Sequence[FittedCandidate],
    causes: Sequence[Cause],
    system: System,
    where: Where = HERE,
) -> list[FittedCandidate]:
    """Find the best values of elastic joints and gaps at a joint where one of them is ahead of all trials.

    Where a rigid joint leaves less than all of them, whatever is ahead of the other trials. None beside
    another one: what is left of that looks like the next. astray: those whose search ended at senseless
    values; one begins again where a law that comes to it at a limit was found. where: processes among which
    they are shared.
    """
    others = [c.trial for c in causes]
    if any(t.candidate.elastic for t in others):
        return []
    left = sorted(trials, key=lambda t: -t.gain.delta_bic)
    while left and left[0].candidate.elastic:
        joint = left[0].candidate.joint
        there = [t for t in left if "stiffness" in t.values and t.candidate.joint == joint]
        there += [t for t in astray if t.candidate.joint == joint and _of_richer(t, there)]
        better = _better(there, [_Beside(system.equations, others, t) for t in there], where)
        gains = [beside(t, system) for t in better]
        found = [replace(t, gain=gain) for t, gain in zip(better, gains, strict=True) if gain]
        if found:
            return [t for t in found if sensible(t, system.equations)]
        left = [t for t in left if not t.candidate.elastic or t.candidate.joint != joint]
    return []


def _better(
    trials: Sequence[FittedCandidate], places: Sequence[_Beside], where: Where
) -> list[FittedCandidate]:
    """Keep the trials that leave less than a rigid joint, with their best values."""
    begins = [
        (k, values)
        for k, trial in enumerate(trials)
        for values in (trial.values, *_starts(trial), *_of_richer(trial, trials))
    ]

    def begun(number: int) -> _Begun:
        k, values = begins[number]
        return places[k].begun(values)

    all_begun = forked(begun, len(begins), where)

    def best(k: int) -> FittedCandidate | None:
        return places[k].best([b for (of, _), b in zip(begins, all_begun, strict=True) if of == k])

    return [t for t in forked(best, len(trials), where) if t is not None]


def member(first: Judged, eligible: Sequence[Judged], limits: Thresholds) -> Judged:
    """The first, or of the two laws at its place one of which is the other's limit the one that is there.

    The simpler one, an elastic joint, which is a gap of no width, unless the other's evidence is certainly
    more, or what it carries to rows that were not seen. eligible: most evidence first.
    """
    other = next((pair for pair in eligible if alternatives(first[0].candidate, pair[0].candidate)), None)
    if other is None:
        return first
    plain = first[0].candidate.definition is other[0].candidate.definition.simpler
    simpler, richer = (first, other) if plain else (other, first)
    times = limits.selection.min_gap_gain_ratio
    more = ahead(richer[0], simpler[0], limits.candidates.certain_delta_bic)
    more = more or richer[1].gain > times * simpler[1].gain
    return richer if more else simpler


def alternatives(one: Candidate, other: Candidate) -> bool:
    """Whether they are laws at the same place, one of them the other's limit: a gap and an elastic joint."""
    laws = one.definition, other.definition
    return one.joint == other.joint and (laws[0].simpler is laws[1] or laws[1].simpler is laws[0])


def _starts(trial: FittedCandidate) -> list[dict[str, float]]:
    """Values to begin at, where those that were found may be near another minimum."""
    names = [name for name in STARTS if name in trial.values]
    return [
        {**trial.values, **{n: trial.values[n] * f for n, f in zip(names, factors, strict=True)}}
        for factors in product(*(STARTS[name] for name in names))
    ]


def _of_richer(trial: FittedCandidate, trials: Sequence[FittedCandidate]) -> list[dict[str, float]]:
    """Values of a law that comes to this one at a limit: a gap of no width is an elastic joint. Its
    search, over more values, may have found a resonance that this one's has missed.
    """
    law = trial.candidate.definition
    richer = [t.values for t in trials if t.candidate.definition.simpler is law]
    return [{n: v[n] for n in trial.values} for v in richer if v.keys() >= trial.values.keys()]


class _Beside:
    """One of them beside the arm and the other causes, whose columns stay."""

    def __init__(
        self,
        equations: Equations,
        others: Sequence[FittedCandidate],
        trial: FittedCandidate,
    ) -> None:
        self.equations, self.trial, self.others = equations, trial, others
        self.rows = rows = equations.rows
        table, whole = with_causes(equations, others), with_causes(equations, [*others, trial])
        self.weights = weights_of(rows, whole, weighted_fit(rows, whole))
        self.left, self.right = stacked(rows, table, self.weights)
        norms = np.linalg.norm(self.left, axis=0)
        norms[norms == 0] = 1.0
        self.inverse = np.linalg.pinv(self.left / norms, rcond=SINGULAR) / norms[:, None]
        self.joint = np.concatenate(
            [np.full(int(r.moving[:, j].sum()), j) for r in rows for j in range(r.effort.shape[1])]
        )
        self.count = np.maximum(np.bincount(self.joint), 1)
        self.rigid = self.inverse @ self.right
        self.least = self._left(self.right - self.left @ self.rigid)  # by a rigid joint

    def begun(self, values: Values) -> _Begun:
        """The parameters settled beside values at which a search may begin."""
        return values, *self.at(values, self.rigid, FIRST if values is self.trial.values else SETTLING)

    def best(self, begun: Sequence[_Begun]) -> FittedCandidate | None:
        """The trial with the values that leave least, and its columns at the parameters that go with them.
        None where a rigid joint leaves less.

        begun: where the search may begin, its own values and others. Where all of several leave more than a
        rigid joint does, a search only leads back to that, and is left out.
        """
        values, least, near = min(begun, key=lambda b: b[1])
        if len(begun) > 1 and least > self.least:
            return None
        if smooth(self.trial, self.equations):
            return self._fitted(values, near)
        names = sorted(values)

        def leaves(logarithms: Array) -> float:
            nonlocal least, values, near
            tried = dict(zip(names, np.exp(logarithms).tolist(), strict=True))
            left, beside = self.at(tried, near, TURNS)
            if left < least:
                least, values, near = left, tried, beside
            return min(left, 1e6)

        first = np.log([values[name] for name in names])
        simplex = np.vstack([first, first + EDGE * np.eye(len(first))])
        options = {"initial_simplex": simplex, "maxfev": MOST, "xatol": FINE, "fatol": EVEN}
        minimize(leaves, first, method="Nelder-Mead", options=options)
        if least > self.least:
            return None
        made = self._columns(values, near)
        return self.trial if made is None else replace(self.trial, values=values, columns=made)

    def _fitted(self, values: Values, near: Array) -> FittedCandidate | None:
        """The best of values that change what it does slightly, together with the parameters."""
        (found,), theta = ElasticFit(self.equations, [replace(self.trial, values=values)], self.others).fit(
            near
        )
        least = self._left(self.right - self.left @ theta - self._stacked(found.columns))
        return None if least > self.least else found

    def at(self, values: Values, theta: Array, turns: int) -> tuple[float, Array]:
        """Least sum over the joints of the logarithm of what is left, on the way of the parameters (k,) from
        these to where they settle, and the parameters there.
        """
        least, best = np.inf, theta
        for turn in range(turns + 1):
            made = self._columns(values, theta)
            if made is None:
                break
            simulated = self._stacked(made)
            left = self._left(self.right - self.left @ theta - simulated)
            if left < least:
                least, best = left, theta
            if turn < turns:
                theta = (theta + self.inverse @ (self.right - simulated)) / 2
        return least, best

    def _left(self, error: Array) -> float:
        """Sum over the joints of the logarithm of the RMS of errors (R,)."""
        return float(np.log(np.maximum(np.bincount(self.joint, error**2) / self.count, LEAST)).sum() / 2)

    def _columns(self, values: Values, theta: Array) -> list[Array] | None:
        base = self.equations.base(theta)
        made = candidate_columns(self.trial.candidate, values, self.equations, base)
        return None if made is None or not all(np.isfinite(c).all() for c in made) else made

    def _stacked(self, made: Sequence[Array]) -> Array:
        return np.concatenate(
            [
                c[r.moving[:, j], j, 0] * self.weights[j]
                for r, c in zip(self.rows, made, strict=True)
                for j in range(r.effort.shape[1])
            ]
        )
