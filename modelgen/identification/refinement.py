"""Output-error refinement from logs, and what it says as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from modelgen.dataset import Settings, choose, prepare, read
from modelgen.dataset.recorded import recorded
from modelgen.description import Arm
from modelgen.functions.parameters_file import values_of
from modelgen.identification.output_error.refine import Refinement, refine
from modelgen.options import RefinementOptions
from modelgen.progress import Progress, silent
from modelgen.simulation import Scores, plant


def refine_logs(
    arm: Arm,
    logs: Sequence[Any],
    options: RefinementOptions | None = None,
    progress: Progress = silent,
) -> Refinement:
    """Base parameters tuned until the simulated motion is that of the logs. Raises InputError."""
    o = options or RefinementOptions()
    progress("reading", 0, None)
    made = plant(arm, values_of(o.parameters, [arm.name]) or None)
    records = [read(log, arm, o.mapping) for log in logs]
    chosen = choose(records, Settings())
    prepared = [prepare(record, chosen) for record in records]
    progress("refining", 0, None)
    found = refine(
        made,
        prepared,
        free=o.free,
        window=o.window,
        progress=lambda rounds, _: progress(f"refining, step {rounds}", 0, None),
    )
    return replace(found, records=tuple(map(recorded, records)))


def to_json(found: Refinement) -> dict[str, Any]:
    """refinement.json."""
    arm = found.plant.arm

    def by_joint(s: Scores, k: int, end: str) -> dict[str, Any]:
        f_gof = float(s.f_gof[k]) if np.isfinite(s.f_gof[k]) else 0.0
        return {f"f_gof{end}": f_gof, f"mae{end}": float(s.mae[k]), f"rmse{end}": float(s.rmse[k])}

    return {
        "schema": 1,
        "arm": arm.name,
        "parameters": [
            {"name": x.name, "start": x.start, "value": x.value, "std": x.std, "unit": x.unit}
            for x in found.parameters
        ],
        "joints": [
            {"joint": k + 1, "unit": arm.joints[i].unit}
            | by_joint(found.before, k, "_before")
            | by_joint(found.after, k, "")
            for k, i in enumerate(arm.coordinates)
        ],
        "steps": found.rounds,
        "converged": found.converged,
        "stopped": found.stopped or None,
    }
