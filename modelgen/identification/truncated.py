"""Efforts in steps that were cut off towards zero, not rounded: they are half a step too small."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.rounding import LONGEST, resolution
from modelgen.identification.beside import Beside
from modelgen.identification.objects import Doubt

HALF = 0.5  # of a step, that a reading cut towards zero is too small by on average
CLEARLY, NEAR = 4.0, 0.15  # deviations, and steps, between which and half a step a shortfall is taken for it
KNOWN = 0.1  # steps, of a deviation beyond which half a step is as good as none
EITHER = 0.02  # of the samples, that have an effort of either sign at least
SEEN = 1e-4  # of the efforts' RMS, of a step below which half of it is nothing


def truncated(found: Beside, train: Sequence[Prepared]) -> dict[int, Doubt]:
    """Questions by joint (from 0) whose efforts are smaller than the model's by half of their step, of either
    sign.

    Rounding errs as often to one side as to the other. Dry friction has the sign of the speed, and is fitted
    beside.
    """
    steps = [_step(train, j, size) for j, size in enumerate(found.logged)]
    asked = [j for j, step in enumerate(steps) if step and _both_signs(found, j)]
    if not asked:
        return {}
    shown, first, said = found.explained(np.sign), train[0].record, dict[int, Doubt]()
    assert first.arm is not None
    for j in asked:
        step, unit = steps[j], first.effort_unit[j]
        short, std = -shown.amount[j] * found.gain[j] / step, shown.std[j] * found.gain[j] / step
        if not 0.0 < std < KNOWN or short < CLEARLY * std or abs(short - HALF) > max(CLEARLY * std, NEAR):
            continue
        name, size = first.arm.coordinate_names[j], f"{float(f'{step:.3g}'):g}"
        half, column = f"{float(f'{HALF * step:.3g}'):g}", f"i{j + 1}" if unit == "A" else f"tau{j + 1}"
        text = (
            f"The efforts of {name} are smaller than the model's, of either sign, by {short:.2f} ± {std:.1g} "
            f"of their step of {size} {unit}: were they cut off towards zero where they should be rounded? "
            f"Log them rounded or in finer steps; a mapping file adds what is lost: {{column: {column} + "
            f"{half} * sign({column})}}."
        )
        said[j] = Doubt(text, [name])
    return said


def _step(train: Sequence[Prepared], j: int, size: float) -> float:
    """Step of the readings of a joint in the log's unit, 0 where it is none beside efforts of this RMS."""
    logged = [x[:LONGEST, j] for p in train if (x := p.record.logged_effort) is not None]
    if not logged:
        return 0.0
    step = resolution(np.concatenate(logged)) or 0.0
    return step if step > SEEN * size else 0.0


def _both_signs(found: Beside, j: int) -> bool:
    """Whether the model's efforts of a joint have either sign while it moves."""
    efforts = np.concatenate([e[r.awake[:, j], j] for e, r in zip(found.efforts, found.records, strict=True)])
    above = float(np.mean(efforts > 0.0)) if len(efforts) else 0.0
    return EITHER < above < 1.0 - EITHER
