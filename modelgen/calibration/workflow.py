"""A calibration from a log to a lever, and what it says as data."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from modelgen.calibration.fit import Calibration, calibrate
from modelgen.calibration.lever import lever_of
from modelgen.dataset import dated_columns, parse
from modelgen.dataset.recorded import of_stamps
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.options import CalibrationOptions


def calibrate_log(arm: Arm, joint: int, log: Any, options: CalibrationOptions | None = None) -> Calibration:
    """The lever of `joint` (from 1) from a log with t [s], qm<joint> [motor unit] and q<joint> [rad].

    Raises InputError for a joint without a lever, missing columns, and data that determine nothing.
    """
    o = options or CalibrationOptions()
    lever = lever_of(arm, joint)
    columns, begins = dated_columns(log, (f"qm{joint}", f"q{joint}"))
    motor, measured = columns[f"qm{joint}"], columns[f"q{joint}"]
    try:
        found = calibrate(lever, joint, motor, measured, o.length_std)
    except InputError as error:
        raise InputError(f"{log}: {error}") from None
    return replace(found, record=of_stamps(parse(log).text, columns["t"], begins))


def data(arm: Arm, c: Calibration) -> dict[str, Any]:
    """calibration.json."""

    def number(x: float) -> float | None:
        return x if np.isfinite(x) else None

    return {
        "schema": 1,
        "arm": arm.name,
        "joint": c.joint,
        "samples": len(c.motor),
        "rmse": {
            "unit": "rad",
            "before": number(c.rms_before),
            "before_best_offset": number(c.rms_shifted),
            "after": c.rms_after,
            "improvement_percent": number(c.improvement_percent),
        },
        "rev": {
            "before": c.before.rev,
            "value": c.after.rev,
            "rmse": {str(rev): x for rev, x in sorted(c.candidates.items())},
        },
        "parameters": [
            {"name": e.name, "before": e.before, "value": e.value, "std": e.std, "unit": e.unit}
            for e in c.estimates
        ],
        "samples_per_independent_one": c.correlation,
        "not_determined": list(c.weak),
    }
