"""What a cause must show on rows that its fit has not seen."""

from modelgen.diagnosis.validation.agreement import agreement
from modelgen.diagnosis.validation.check import Check
from modelgen.diagnosis.validation.conditions import Conditions, Judgement, instrumented
from modelgen.diagnosis.validation.cross_validation import Part, Split, folds

__all__ = ["Check", "Conditions", "Judgement", "Part", "Split", "agreement", "folds", "instrumented"]
