"""When the efforts of a log were read: the delay at which the model explains them best.

The delay of each joint's efforts is fitted beside the parameters by Gauss and Newton's steps. Its column is
the slope of the efforts as the model has them, in which their noise has no part. The columns of inertia and
friction are slopes of others, and what is left for the delay is little: its deviation says how little. What
the rounding of the positions does to it is seen by rounding them again (Cook and Stefanski 1994). What the
model lacks is no noise, and pulls the delays of all parts of a log the same way: the deviation holds how much
they change where every joint may have any law of its own position, speed and load, and dry friction that
turns late (Hausman 1978). A delay of more than a sample that leaves nearly as much as none stands for what is
missing, and is not given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Record, Settings, choose, prepare
from modelgen.dataset.processing.instants import (
    CONVENTIONS,
    EffortInstant,
    LateChannel,
    beyond,
    fitting,
    with_hold,
)
from modelgen.dataset.processing.rounding import position_steps
from modelgen.dataset.processing.sequence import in_sequence
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.delay_fit import DelayFit
from modelgen.identification.late_channels import late_channels
from modelgen.identification.rounded_positions import rounded_anew
from modelgen.numeric import Array

ELEMENTS = 25_000_000  # of the regressor at full rate, beyond which the beginnings of the records do
DRAWS = 4  # of further roundings of the positions, where the data would tell without
ALIKE = 0.25  # samples, half of what is between two conventions: joints that are so near agree
APART = 4.0  # deviations by which a joint may be from all, if it is a matter of the log


def effort_instant(
    records: Sequence[Record], arm: Arm, limits: DatasetThresholds = USUAL
) -> EffortInstant | None:
    """When the efforts of the records, which are read alike, were read; None of free motions.

    What nobody has said is as the data say, where they can tell, and as the default else.
    """
    first = records[0]
    if any(r.input is None for r in records):
        return None
    if first.hold_known or not any(r.uneven for r in records):
        return _instant(records, arm, limits)
    # Between uneven stamps conventions differ by more than a delay: that one is right which the data have
    # when the efforts are read so.
    as_read, used = _instant(records, arm, limits), str(first.effort_hold)
    found = {used: as_read}
    for hold in CONVENTIONS:
        read = records if hold == used else [with_hold(r, hold) for r in records]
        x = as_read if hold == used else _instant(read, arm, limits)
        if x.delay is None or x.std is None or not x.alike:
            continue
        delay = x.delay - read[0].hold / x.step + CONVENTIONS[hold]
        if fitting(delay, x.std, x.step, limits) == hold:
            found[hold] = replace(x, hold=hold, delay=delay, fits=hold)
    right = [hold for hold, x in found.items() if x.fits == hold]
    if not right:
        return as_read
    best = min(right, key=lambda hold: abs((found[hold].delay or 0.0) - CONVENTIONS[hold]))
    return found[best] if best == used else replace(found[best], known="data")


def _instant(records: Sequence[Record], arm: Arm, limits: DatasetThresholds) -> EffortInstant:
    """The same of efforts, read as the records have them."""
    first = records[0]
    known = EffortInstant(first.effort_hold, first.hold_known, first.step)
    found = _delay(records, arm, limits)
    if found is None:
        return known
    if isinstance(found, list):
        return replace(known, alike=False, channels=tuple(found))
    delay, std, alike, joints = found
    fits, used = fitting(delay, std, first.step, limits) if alike else None, first.hold / first.step
    late = tuple((name, d, s) for name, d, s, believed in joints if believed and beyond(d, s, used))
    if fits is None and not all(believed for *_, believed in joints):
        return replace(known, late=late, alike=False, missing=True)
    if not alike and not known.known and (others := _of_the_others(joints, first.step, limits)) is not None:
        return others
    said = EffortInstant(known.hold, known.known, known.step, delay, std, fits, alike, late)
    if fits is None or known.known or fits == known.hold:
        return said
    return EffortInstant(fits, "data", known.step, delay, std, fits)


def _of_the_others(
    joints: Sequence[tuple[str, float, float, bool]], step: float, limits: DatasetThresholds
) -> EffortInstant | None:
    """The instant by the joints whose efforts are near a convention, where they agree on it: the efforts of
    those that are a sample from all of them are late, and say nothing of it. None where no joint is late.
    """
    late = [x for x in joints if all(beyond(x[1], x[2], place) for place in CONVENTIONS.values())]
    others = [x for x in joints if x not in late]
    if not late or not others:
        return None
    delays, deviations = (np.array([x[k] for x in others]) for k in (1, 2))
    common, std = _common(delays, deviations)
    if (np.abs(delays - common) > np.maximum(APART * deviations, ALIKE)).any():
        return None
    fits = fitting(common, std, step, limits)
    if not isinstance(fits, str):
        return None
    found = tuple((name, delay, deviation) for name, delay, deviation, _ in late)
    return EffortInstant(fits, "data", step, common, std, fits, alike=False, late=found)


def at_instants(records: Sequence[Record], found: EffortInstant | None) -> list[Record]:
    """The records with their efforts at the instants found, and how far these may be off."""
    if found is None:
        return list(records)
    driven = [r if r.input is None or found.known != "data" else with_hold(r, found.hold) for r in records]
    return [r if r.input is None else replace(r, hold_std=found.doubt * r.step) for r in driven]


def _delay(
    records: Sequence[Record], arm: Arm, limits: DatasetThresholds
) -> list[LateChannel] | tuple[float, float, bool, list[tuple[str, float, float, bool]]] | None:
    """Channels that are older than the others; else the common delay and its deviation [samples], whether the
    joints agree, and name, delay and deviation of each that tells, and whether it is to be believed; None
    where there is none.
    """
    chosen = Options().evaluated
    model, evaluator = build_model(arm, chosen), Evaluator(reduced(arm, chosen))
    n, p = records[0].n, len(model.grouping.base)
    longest = max(limits.min_samples, ELEMENTS // (n * p * len(records)))
    beginnings = [r.part(0, min(len(r.t), longest)) for r in records]
    try:
        settings = choose(list(records), Settings(thresholds=limits))
        prepared = in_sequence([prepare(r, settings) for r in beginnings])
        fit = DelayFit(prepared, model, evaluator)
        delays, deviations = fit.delays()
        channels = late_channels(fit, delays, deviations, arm.coordinate_names)
        if channels:
            return channels
        if not np.isfinite(deviations).any():
            return None
        if _common(delays, deviations)[1] <= limits.max_instant_std and position_steps(records[0]).any():
            square = np.zeros(n)
            for seed in range(DRAWS):
                anew = [prepare(rounded_anew(r, seed), settings) for r in prepared]
                again = [replace(x, before=r.before) for x, r in zip(anew, prepared, strict=True)]
                square += (DelayFit(again, model, evaluator).delays(free=False)[0] - delays) ** 2 / DRAWS
            deviations = np.sqrt(deviations**2 + np.where(np.isfinite(square), square, np.inf))
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return None  # what is wrong is said where the parameters are found
    told = np.isfinite(deviations)
    if not told.any():
        return None
    common, std = _common(delays, deviations)
    apart = np.maximum(APART * deviations, ALIKE)
    names = np.array(arm.coordinate_names)[told].tolist()
    used = records[0].hold / records[0].step
    believed = ~fit.missing | (np.abs(delays - used) <= 1.0)
    columns = (x[told].tolist() for x in (delays, deviations, believed))
    joints = list(zip(names, *columns, strict=True))
    return common, std, bool((np.abs(delays - common) <= apart)[told].all()), joints


def _common(delays: Array, deviations: Array) -> tuple[float, float]:
    """Mean of the joints' delays and its deviation."""
    weights = 1.0 / deviations**2
    used = np.where(weights > 0.0, delays, 0.0)
    return float(weights @ used / weights.sum()), float(weights.sum() ** -0.5)
