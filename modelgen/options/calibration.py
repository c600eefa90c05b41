"""Options of the calibration of a lever."""

from __future__ import annotations

import math
from dataclasses import dataclass

from modelgen.errors import InputError
from modelgen.options.field import documented, option


@documented()
@dataclass(frozen=True)
class CalibrationOptions:
    """Known values of a lever beside the log."""

    length_std: float = option(0.01, "How well the lengths of the description are known.", "M", unit="m")

    def __post_init__(self) -> None:
        if not (math.isfinite(self.length_std) and self.length_std > 0):
            raise InputError(f"--length-std: found {self.length_std:g}, expected a positive number of metres")
