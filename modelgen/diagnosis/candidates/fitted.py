"""A candidate with values for its parameters: what it explains, and whether the arm admits it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import Candidate, Values
from modelgen.diagnosis.candidates.prior_odds import beyond_plausible, place_penalty
from modelgen.diagnosis.evidence.likelihood import Evidence
from modelgen.diagnosis.evidence.system import System
from modelgen.effects import described
from modelgen.errors import InputError
from modelgen.evaluation import with_effect
from modelgen.numeric import Array

WHOLLY = (0.5, 2.0)  # share of what was simulated, of an elastic joint or play, that is found


@dataclass(frozen=True)
class FittedCandidate:
    """A candidate with values for what is searched. columns: (M, n, k) of every training record.

    gain: its evidence, after `prior_penalty` (see `prior_odds`). around: values at which columns
    that follow no line were taken.
    """

    candidate: Candidate
    values: Values
    columns: Sequence[Array]
    gain: Evidence
    prior_penalty: float = 0.0
    around: Values = field(default_factory=dict)

    @property
    def odds(self) -> float:
        """By which rivals are compared, see `plausible.elsewhere`."""
        return self.gain.delta_bic - place_penalty(self.candidate)

    @property
    def parameters(self) -> dict[str, float]:
        """All values: fixed, searched and estimated."""
        estimated = named(self.candidate, self.gain.values)
        return self.candidate.definition.physical({**self.candidate.fixed, **self.values, **estimated})


def named(candidate: Candidate, values: Array) -> dict[str, float]:
    """Estimated values (k,) by the parameters of their columns."""
    return dict(zip(candidate.names, (float(v) for v in values), strict=False))


def beside(trial: FittedCandidate, system: System) -> Evidence | None:
    """What a candidate explains beside another system's columns, with the values it was found at."""
    c = trial.candidate
    return system.gain(trial.columns, float(len(trial.values)), c.positive, passing=c.passing)


def sensible(trial: FittedCandidate, arm: Arm) -> bool:
    """Whether something is left where values may not be negative, and the arm admits them."""
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
        return bool(WHOLLY[0] < trial.gain.values[0] < WHOLLY[1])
    return not c.definition.vanishes(named(c, trial.gain.values))
