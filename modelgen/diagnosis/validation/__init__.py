"""What a cause must show on rows that its fit has not seen."""

from modelgen.diagnosis.validation.agreement import agreement
from modelgen.diagnosis.validation.check import Check
from modelgen.diagnosis.validation.cross_validation import Part, Split, folds
from modelgen.diagnosis.validation.gates import Gates, Judgement, instrumented

__all__ = ["Check", "Gates", "Judgement", "Part", "Split", "agreement", "folds", "instrumented"]
