"""Every threshold of the diagnosis, by stage: name, value, unit, meaning and source."""

from __future__ import annotations

from dataclasses import dataclass, field

from modelgen.dataset import DatasetThresholds
from modelgen.diagnosis.options.thresholds.adequacy import AdequacyThresholds
from modelgen.diagnosis.options.thresholds.candidates import CandidateThresholds
from modelgen.diagnosis.options.thresholds.equations import EquationThresholds
from modelgen.diagnosis.options.thresholds.evidence import EvidenceThresholds
from modelgen.diagnosis.options.thresholds.experiment import ExperimentThresholds
from modelgen.diagnosis.options.thresholds.extended import ExtendedThresholds
from modelgen.diagnosis.options.thresholds.selection import SelectionThresholds
from modelgen.diagnosis.options.thresholds.validation import ValidationThresholds
from modelgen.thresholds import Group

__all__ = [
    "USUAL",
    "AdequacyThresholds",
    "CandidateThresholds",
    "DatasetThresholds",
    "EquationThresholds",
    "EvidenceThresholds",
    "ExperimentThresholds",
    "ExtendedThresholds",
    "SelectionThresholds",
    "Thresholds",
    "ValidationThresholds",
    "in_band",
]


@dataclass(frozen=True)
class Thresholds(Group):
    """Thresholds of the dataset and of the eight stages of the diagnosis. See docs/thresholds.md.

    `Thresholds().with_values({"selection.min_delta_bic": 10.0})` asks for more evidence.
    """

    dataset: DatasetThresholds = field(default_factory=DatasetThresholds)
    equations: EquationThresholds = field(default_factory=EquationThresholds)
    evidence: EvidenceThresholds = field(default_factory=EvidenceThresholds)
    candidates: CandidateThresholds = field(default_factory=CandidateThresholds)
    validation: ValidationThresholds = field(default_factory=ValidationThresholds)
    selection: SelectionThresholds = field(default_factory=SelectionThresholds)
    adequacy: AdequacyThresholds = field(default_factory=AdequacyThresholds)
    extended: ExtendedThresholds = field(default_factory=ExtendedThresholds)
    experiment: ExperimentThresholds = field(default_factory=ExperimentThresholds)


USUAL = Thresholds()


def in_band(percent: float, narrowed: float) -> float:
    """Percent of the RMSE in a narrowed band that is `percent` in the usual one.

    A band `narrowed` times as wide has that many times the power of white noise, and the cause as much as
    before: what is worth naming does not become less for being seen better.
    """
    odds = narrowed * ((1.0 - percent / 100.0) ** -2 - 1.0)  # power of the cause over that of the noise
    return 100.0 * (1.0 - float((1.0 + odds) ** -0.5))
