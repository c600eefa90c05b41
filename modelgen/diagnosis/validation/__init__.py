"""The gates that a cause must pass on rows its fit has not seen."""

from modelgen.diagnosis.validation.gates import Gates, Judgement, instrumented

__all__ = ["Gates", "Judgement", "instrumented"]
