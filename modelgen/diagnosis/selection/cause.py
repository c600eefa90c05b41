"""Causes that were selected, and the system that holds them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, system_of
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.selection.history import History, taken_back


@dataclass
class Cause:
    """A candidate that passed. rivals: (candidate, delta BIC behind) that passed as well at its turn; lesser:
    that could not be named then and may be there all the same.

    delta_bic: what leaving it out of the final model costs; cross_gain, expected_gain: percent of the RMSE on
    rows that its fit had not seen, as measured and as it must be if the cause is there as found.
    """

    trial: FittedCandidate
    delta_bic: float
    cross_gain: float
    expected_gain: float
    rivals: list[tuple[FittedCandidate, float]] = field(default_factory=list)
    lesser: list[tuple[FittedCandidate, float]] = field(default_factory=list)


def together(trials: Sequence[FittedCandidate], rest: System, *, fair: bool = False) -> float:
    """Delta BIC of all of them. rest: the system without them; fair: of its `fair` equations."""
    columns = [np.concatenate([t.columns[k] for t in trials], axis=2) for k in range(len(rest.rows))]
    positive = [above for t in trials for above in t.candidate.positive]
    extra = float(sum(len(t.values) for t in trials))
    passing = any(t.candidate.passing for t in trials)
    if fair:
        gain = rest.fair.gain(columns, extra, positive)
    else:
        gain = rest.gain(columns, extra, positive, passing=passing)
    return -np.inf if gain is None else gain.delta_bic


@dataclass(frozen=True)
class Selection:
    """The causes and the final system. turns: all candidates with evidence, best first, by turn."""

    causes: list[Cause]
    system: System
    turns: History

    @property
    def columns(self) -> list[slice]:
        """Places of the causes' columns among the system's."""
        counts = [c.trial.columns[0].shape[2] for c in self.causes]
        ends = self.system.equations.unknowns + np.cumsum([0, *counts])
        return [slice(int(begin), int(end)) for begin, end in pairwise(ends)]

    @property
    def solved(self) -> list[FittedCandidate]:
        """The causes' candidates with the values that the system has; elastic ones as they were simulated."""
        found = []
        for cause, own in zip(self.causes, self.columns, strict=True):
            trial, values = cause.trial, self.system.theta[own]
            if not trial.candidate.elastic:
                values = np.where(trial.candidate.positive, np.maximum(values, 0.0), values)
                trial = replace(trial, gain=replace(trial.gain, values=values))
            found.append(trial)
        return found

    def without(self, lost: Sequence[Cause], why: str) -> Selection:
        """Take causes out; the turns say why."""
        kept = [c for c in self.causes if all(c is not other for other in lost)]
        system = system_of(self.system.equations, [c.trial for c in kept])
        turns = self.turns
        for c in lost:
            turns = taken_back(turns, c.trial.candidate.place, why)
        return Selection(kept, system, turns)


def with_trials(selection: Selection, trials: Sequence[FittedCandidate], equations: Equations) -> Selection:
    """The selection with other values of its causes, in these equations."""
    system = system_of(equations, trials)
    causes = [replace(c, trial=t) for c, t in zip(selection.causes, trials, strict=True)]
    return replace(selection, causes=causes, system=system)
