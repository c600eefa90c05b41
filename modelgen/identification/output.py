"""identification.json."""

from __future__ import annotations

from typing import Any

import numpy as np

from modelgen.identification.instrumental import Comparison
from modelgen.identification.objects import Identification, Validation
from modelgen.identification.summary import questions, verdict


def to_json(found: Identification) -> dict[str, Any]:
    """identification.json."""
    test = found.test
    return {
        "schema": 1,
        "arm": found.arm.name,
        "method": found.method,
        "condition_number": found.solution.condition,
        "parameters": [
            {
                "name": e.name,
                "value": e.value,
                "std": e.std,
                "relative_std_percent": e.relative,
                "unit": e.unit,
                "essential": e.essential,
                "left_out": e.dropped,
            }
            for e in found.estimates
        ],
        "test": None if test is None else errors(test),
        "verdict": verdict(found),
        "doubts": questions(found),
        **({} if found.remains is None else {"lack_of_fit": found.remains.to_json()}),
        "least_squares": _least_squares(found.comparison),
        **_noise(found),
        **_gains(found),
        **_physical(found),
    }


def errors(test: Validation) -> dict[str, Any]:
    """RMSE and NRMSE by joint."""
    return {
        "unit": ", ".join(dict.fromkeys(test.unit)),
        "rmse": [float(x) for x in test.rmse],
        "nrmse_percent": [float(x) for x in test.nrmse_percent],
        **_repeats(test),
    }


def _repeats(test: Validation) -> dict[str, Any]:
    """What differs between periods; nothing where none repeats."""
    if test.repeats is None or not np.isfinite(test.repeats).any():
        return {}
    return {"noise_rmse": [float(x) if np.isfinite(x) else None for x in test.repeats]}


def _least_squares(c: Comparison | None) -> dict[str, Any] | None:
    """The test of Durbin, Wu and Hausman; None where there are no instruments."""
    if c is None or not c.degrees:
        return None
    return {
        "biased": c.biased,
        "statistic": c.statistic,
        "degrees": c.degrees,
        "threshold": c.threshold,
        "instrument": "simulated" if c.simulated else "period",
    }


def _noise(found: Identification) -> dict[str, Any]:
    """What gains and thresholds of the watch are set by; nothing without a test record."""
    noise = None if found.test is None else found.test.noise
    if noise is None:
        return {}
    return {
        "noise": {
            "input": list(noise.input),
            "correlation_s": list(noise.correlation),
            "rest_speed": list(noise.rest_speed),
            "observer": {
                "gain": noise.gain,
                "rms": list(noise.rms),
                "largest": list(noise.largest),
                "duration_s": noise.duration,
            },
        }
    }


def _gains(found: Identification) -> dict[str, Any]:
    """Torque constants that were found, in the description's unit."""
    if not found.gains:
        return {}
    return {
        "torque_constants": [
            {"joint": g.joint, "value": g.value, "std": g.std, "described": g.described} for g in found.gains
        ]
    }


def _physical(found: Identification) -> dict[str, Any]:
    """Standard parameters that could exist, and what was wrong with the plain ones."""
    if found.consistent is None:
        return {}
    c = found.consistent
    return {
        "standard_parameters": [
            {"name": p.name, "value": float(x), "unit": p.unit}
            for p, x in zip(found.model.standard, c.standard, strict=True)
        ],
        "consistency": {"plain_solution": list(c.violated), "chi_square_per_parameter": c.distance},
    }
