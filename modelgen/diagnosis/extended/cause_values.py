"""Values of causes: one of each parameter, which is that of the extended model where that has it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate
from modelgen.diagnosis.equations import Rows
from modelgen.diagnosis.selection import Cause, Selection
from modelgen.effects import applied_effects
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import weighted_fit

ROUNDING = 1e-12  # of an unknown's factor


@dataclass(frozen=True)
class OwnParameter:
    """base: index of the base parameter. cause: number of the cause, whose parameter `name` it is. least: it
    is not less.
    """

    base: int
    cause: int
    name: str
    least: float


def own_parameters(model: Model, trials: Sequence[FittedCandidate]) -> Iterator[OwnParameter]:
    """Those of the causes' linear parameters that no other parameter goes with. model: the extended one."""
    alone = {
        model.standard[b.representative].name: k
        for k, b in enumerate(model.grouping.base)
        if len(b.terms) == 1
    }
    for effect in applied_effects(model.arm):
        number = None if effect.joint is None else model.arm.coordinates.index(effect.joint) + 1
        for cause, trial in enumerate(trials):
            if trial.candidate.place != (effect.effect.name, number) or trial.candidate.elastic:
                continue
            for parameter, symbol in effect.parameters:
                if symbol.name in alone and parameter.name in trial.candidate.names:
                    yield OwnParameter(alone[symbol.name], cause, parameter.name, parameter.bounds[0])


def bounded_fit(rows: Sequence[Rows], own: Sequence[OwnParameter]) -> Array:
    """Unknowns (k,) that explain the rows best with none of the causes' parameters below its bound: one that
    would be is zero.
    """
    tables, baseline = [r.columns for r in rows], rows[0].baseline
    held: set[int] = set()
    while True:
        theta = weighted_fit(rows, tables)
        base = baseline.base(theta)
        below = {p.base for p in own if base[p.base] < p.least} - held
        if not below:
            return theta
        held |= below
        free = np.abs(baseline.lift[sorted(held)]).max(axis=0) < ROUNDING
        tables = [r.columns * free for r in rows]


def valued(selection: Selection) -> Selection:
    """The selection with the values of its causes as the extended model is fitted: by the plain equations."""
    causes = [replace(c, trial=t) for c, t in zip(selection.causes, selection.solved, strict=True)]
    return replace(selection, causes=causes)


def as_fitted(selection: Selection, model: Model, base: Array) -> Selection:
    """The selection with the values that the extended model has. base: its base parameters (p,)."""
    causes: list[Cause] = list(selection.causes)
    for own in own_parameters(model, [c.trial for c in causes]):
        trial = causes[own.cause].trial
        values = trial.gain.values.copy()
        values[trial.candidate.names.index(own.name)] = max(base[own.base], own.least)
        causes[own.cause] = replace(
            causes[own.cause], trial=replace(trial, gain=replace(trial.gain, values=values))
        )
    return replace(selection, causes=causes)
