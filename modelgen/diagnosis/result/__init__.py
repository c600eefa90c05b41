"""A diagnosis, as it is reported."""

from modelgen.diagnosis.result.as_json import rounded, to_json
from modelgen.diagnosis.result.diagnosis import VERDICTS, Diagnosis
from modelgen.diagnosis.result.reported import reported

__all__ = ["VERDICTS", "Diagnosis", "reported", "rounded", "to_json"]
