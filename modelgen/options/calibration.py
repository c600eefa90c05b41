"""Options of the calibration of a lever."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.options.field import documented, option


@documented()
@dataclass(frozen=True)
class CalibrationOptions:
    """Known values of a lever beside the log."""

    length_std: float = option(0.01, "How well the lengths of the description are known.", "M", unit="m")
