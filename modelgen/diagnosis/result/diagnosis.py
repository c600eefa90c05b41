"""A diagnosis, as it is reported."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modelgen.dataset.inspection import RecordsInspected
from modelgen.description import Arm
from modelgen.diagnosis.adequacy import LackOfFit, Likeness
from modelgen.diagnosis.equations import Rows
from modelgen.diagnosis.experiment import Experiment
from modelgen.diagnosis.extended import Errors, Estimate, FittedModel, NamedCause, Positions
from modelgen.diagnosis.selection import History
from modelgen.identification.objects import Impossible
from modelgen.numeric import Array
from modelgen.simulation.windows import Windows

VERDICTS = ("named", "suspected", "nothing_missing", "outside_catalogue", "cannot_tell")


@dataclass(frozen=True)
class AsIdentified:
    """What `modelgen identify` has of the arm as described in this band, with samples at rest.

    rmse: (n,) on the test record. cutoff: that identify would choose [Hz]. doubts: questions about what no
    arm has, or the described one has not. late: about channels of the log that are older than the others.
    """

    rmse: Array
    cutoff: float
    doubts: tuple[str, ...] = ()
    late: tuple[str, ...] = ()


@dataclass(frozen=True)
class Diagnosis:
    """Everything that was found.

    lack_of_fit_part: record, and times from and to in its first period [s], of the part that shows most,
    None where it is no part; likeness: what the causes leave is most like; before, after: the arm as
    described and the arm with the causes, fitted to the training records; simulation: of the test record
    with either; test: rows of the test record; ranking: candidates with evidence by step, best first;
    added: effects that the description is extended by, each with its joint and values; residuals: (M, n)
    before and after, as the log has its efforts; laws: (M, n) of each cause, what it alone adds to these,
    empty where it cannot be computed; impossible: questions about values of the extended model that no arm
    has; suspects: what has evidence and failed a check that decides; inertias: of drives before elastic
    joints and play by coordinate (from 1); log: facts of the records; identified: what identify has, None
    for free motions.
    """

    arm: Arm
    verdict: str
    reason: str
    causes: tuple[NamedCause, ...]
    not_identifiable: tuple[tuple[str, str], ...]
    lack_of_fit: LackOfFit | None
    lack_of_fit_part: tuple[str, float, float] | None
    likeness: Likeness | None
    errors: Errors
    simulation: tuple[Windows | None, Windows | None]
    before: FittedModel
    after: FittedModel
    parameters: Mapping[str, Estimate]
    next_experiment: Experiment | None
    test: Rows
    residuals: tuple[Array, Array]
    ranking: History
    added: Sequence[tuple[str, int | None, Mapping[str, float]]]
    log: RecordsInspected
    identified: AsIdentified | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    suspects: tuple[NamedCause, ...] = ()
    positions: Positions | None = None
    inertias: Mapping[int, Estimate] = field(default_factory=dict)
    laws: tuple[Array, ...] = ()
    impossible: tuple[Impossible, ...] = ()

    @property
    def doubts(self) -> tuple[str, ...]:
        """Questions about what no arm has, or the described one has not, and about the log."""
        known = () if self.identified is None else (*self.identified.doubts, *self.identified.late)
        return (*self.impossible, *(text for text in known if text not in self.impossible))

    @property
    def free(self) -> bool:
        """Whether the records are free motions: nothing drives the arm."""
        return self.test.prepared.input is None
