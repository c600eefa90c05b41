"""Free motions: what of their speeds is noise, and which rows are free of the hand that holds the arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import binary_dilation

from modelgen.dataset import Prepared, Record, Settings, choose, prepare
from modelgen.dataset.processing.rest import long_runs
from modelgen.diagnosis.options.thresholds import EquationThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array


def settings_of_swings(records: Sequence[Record], settings: Settings, limits: EquationThresholds) -> Settings:
    """Settings with rest speeds beyond the noise: a swing begins and ends at rest, where noise alone is seen.

    The positions' filter rounds off the speed where friction changes sides, and so shifts its zero: it is as
    wide as the noise allows.
    """
    rate, times = 1.0 / records[0].step, limits.rest_noise_deviations
    for ratio in limits.position_cutoff_ratios:
        wide = replace(settings, position_cutoff=ratio * (settings.cutoff or 0.0))
        if ratio * (settings.cutoff or 0.0) < limits.max_position_cutoff * rate:
            gates, noise = choose(list(records), wide).rest_speeds, times * noise_of_speeds(records, wide)
            if all(x < limits.max_noise_over_rest_speed * g for g, x in zip(gates, noise, strict=True)):
                break
    else:
        wide = settings
        gates, noise = choose(list(records), wide).rest_speeds, times * noise_of_speeds(records, wide)
    return replace(wide, rest_gate=tuple(max(g, float(x)) for g, x in zip(gates, noise, strict=True)))


def noise_of_speeds(records: Sequence[Record], settings: Settings) -> Array:
    """Standard deviation of the speeds' noise by coordinate, (n,), the largest of all records.

    What lies above the parallel cut-off, which the motion of a swinging arm does not reach.
    """
    found = []
    for record in records:
        p = prepare(record, settings)
        above = p.picked(p.dq) - p.parallel(p.dq)
        # median: the step of an acceleration at a stop is no noise
        found.append(1.4826 * np.median(np.abs(above), axis=0))
    return np.asarray(np.max(found, axis=0))


def released(record: Record, settings: Settings) -> Record:
    """Cut a record from the release to the last standstill: filters must not see the hand that held the arm.

    It moves where it does for half a period of the cut-off or longer; noise alone is faster for moments.
    Raises InputError where no joint moves.
    """
    p = prepare(record, settings)
    moves = np.asarray((np.abs(p.dq) >= np.asarray(p.settings.rest_speeds)).any(axis=1))
    least = max(1, round(0.5 / ((p.settings.cutoff or 1.0) * record.step)))
    moving = np.flatnonzero(long_runs(moves, least))
    if not len(moving):
        raise InputError(f"{record.name}: all joints rest; expected a free motion from a release to rest")
    return record.part(int(moving[0]), int(moving[-1]) + 1)


def away_from_rest(p: Prepared) -> Prepared:
    """The record without rows whose filters see a rest: before the release a hand carries the arm."""
    step = p.record.step
    longest, reach = max(2, round(p.settings.rest_time / step)), p.settings.trimmed(step)
    kept = p.moving.copy()
    for j, gate in enumerate(p.settings.rest_speeds):
        rest = long_runs(np.abs(p.dq[:, j]) < gate, longest)
        kept[:, j] &= ~binary_dilation(rest, iterations=reach)[p.rows]
    return replace(p, moving=kept)
