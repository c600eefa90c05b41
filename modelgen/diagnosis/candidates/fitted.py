"""A candidate with values for its parameters: what it explains, and whether the arm admits it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from modelgen.diagnosis.candidates.candidate import Candidate, Values
from modelgen.diagnosis.candidates.prior_odds import beyond_plausible, place_penalty
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import Evidence, System
from modelgen.effects import Parameter, described
from modelgen.errors import InputError
from modelgen.evaluation import with_effect
from modelgen.numeric import Array


@dataclass(frozen=True)
class FittedCandidate:
    """A candidate with values for what is searched. columns: (M, n, k) of every training record.

    gain: its evidence, after `prior_penalty` (see `prior_odds`). around: values at which columns
    that follow no line were made.
    """

    candidate: Candidate
    values: Values
    columns: Sequence[Array]
    gain: Evidence
    prior_penalty: float = 0.0
    around: Values = field(default_factory=dict)

    @property
    def odds(self) -> float:
        """Evidence by which rivals are compared, see `place_penalty`."""
        return self.gain.delta_bic - place_penalty(self.candidate)

    @property
    def delay(self) -> float | None:
        """Time [s] by which the effort comes late, where that is all it does."""
        return self.candidate.definition.delays(self.parameters)

    @property
    def parameters(self) -> dict[str, float]:
        """All values: fixed, searched and estimated."""
        estimated = named(self.candidate, self.gain.values)
        return self.candidate.definition.physical({**self.candidate.fixed, **self.values, **estimated})


def named(candidate: Candidate, values: Array) -> dict[str, float]:
    """Estimated values (k,) by the parameters of their columns."""
    return dict(zip(candidate.names, (float(v) for v in values), strict=False))


def below_zero(trial: FittedCandidate) -> bool:
    """Whether what the effect claims was estimated below zero."""
    found = named(trial.candidate, trial.gain.values)
    return any(found.get(name, 0.0) < 0.0 for name in trial.candidate.definition.claims)


def with_causes(equations: Equations, trials: Sequence[FittedCandidate]) -> list[Array]:
    """The model's own columns and the causes' side by side, by record."""
    return [
        np.concatenate([r.columns, *(t.columns[i] for t in trials)], axis=2)
        for i, r in enumerate(equations.rows)
    ]


def system_of(equations: Equations, trials: Sequence[FittedCandidate], noise: System | None = None) -> System:
    """The equations with the causes' columns. noise: a system whose noise they have."""
    return System(equations, with_causes(equations, trials), noise)


def beyond_bounds(trial: FittedCandidate) -> list[Parameter]:
    """Parameters that act in no proportion, whose values no arm has."""
    found = trial.parameters
    return [
        p
        for p in trial.candidate.definition.nonlinear
        if p.name in found and not p.bounds[0] <= found[p.name] <= p.bounds[1]
    ]


def beside(trial: FittedCandidate, system: System) -> Evidence | None:
    """Evidence of a candidate beside another system's columns, with the values it was found at."""
    c = trial.candidate
    return system.gain(trial.columns, float(len(trial.values)), c.positive, passing=c.passing)


def sensible(trial: FittedCandidate, equations: Equations) -> bool:
    """Whether something is left where values may not be negative, and the arm admits them."""
    arm = equations.arm
    c, found = trial.candidate, trial.parameters
    bounds = {p.name: p.bounds for p in c.definition.accepted()}
    if not all(low <= found[name] <= high for name, (low, high) in bounds.items() if name in found):
        return False
    if beyond_plausible(c, found, arm):
        return False
    if c.curved:
        try:
            described(with_effect(arm, c.effect, c.joint, found))
        except InputError:
            return False
    if c.elastic:
        low, high = equations.thresholds.candidates.compliant_share
        return bool(low < trial.gain.values[0] < high)
    return not c.definition.vanishes(named(c, trial.gain.values))
