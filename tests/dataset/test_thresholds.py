"""Every threshold of the dataset acts: another value changes what is refused or chosen."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from diagnosis_support import ARM, coarse, record

from modelgen.dataset import (
    DatasetThresholds,
    Record,
    Settings,
    check_different,
    choose,
    drives_of,
    prepare,
    read,
)
from modelgen.dataset.processing.content import check_coarse, chosen_cutoff, motion_bandwidth
from modelgen.dataset.processing.instants import fitting, with_hold
from modelgen.dataset.processing.periods import period_of
from modelgen.dataset.processing.sequence import in_sequence
from modelgen.dataset.processing.stamps import true_stamps
from modelgen.dataset.processing.timing import Survey
from modelgen.dataset.reading.jumps import jumps
from modelgen.dataset.reading.lone import without_lone
from modelgen.dataset.reading.plausible import check_efforts
from modelgen.dataset.reading.repeats import refresh_of
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.thresholds import Value

Seen = Callable[[DatasetThresholds], Any]
RECORD = record("coulomb_friction", 1, 0.5, 1, "r")
STEP = 0.004


def refusal(act: Callable[[], Any]) -> Any:
    """What it returns, or the sentence by which it refuses."""
    try:
        return act()
    except InputError as error:
        return str(error)


def log(folder: Path, t: Array, q: Array | None = None) -> str:
    """A log of both joints at these times [s]."""
    q = 0.3 * np.sin(np.multiply.outer(t, [1.0, 1.3])) if q is None else q
    table = np.column_stack([t, q, np.cos(q)])
    path = folder / "log.csv"
    lines = ["t,q1,q2,i1,i2", *(",".join(f"{x:.12g}" for x in row) for row in table)]
    path.write_text("\n".join(lines), encoding="utf-8")
    return str(path)


def reading(folder: Path, t: Array, q: Array | None = None) -> Seen:
    spec = log(folder, t, q)

    def seen(limits: DatasetThresholds) -> Any:
        r = refusal(lambda: read(spec, ARM, None, limits))
        return r if isinstance(r, str) else (r.remarks, r.q.tolist())

    return seen


def uneven(size: float) -> Array:
    return STEP * (np.arange(200.0) + size * np.random.default_rng(3).uniform(-0.5, 0.5, 200))


def gap(periods: float) -> Array:
    t = STEP * np.arange(200.0)
    t[100:] += (periods - 1.0) * STEP
    return t


def out_of_range() -> Seen:
    joint = ARM.joints[0]
    arm = replace(
        ARM, joints=(replace(joint, limits=replace(joint.limits, position=(-0.29, 0.29))), ARM.joints[1])
    )

    def seen(limits: DatasetThresholds, spec: str = "") -> Any:
        return refusal(lambda: read(spec, arm, None, limits).remarks)

    return seen


def turned() -> Array:
    """A sensor that starts anew after a turn."""
    q = np.column_stack([0.05 * np.arange(200.0), 0.3 * np.sin(0.1 * np.arange(200.0))])
    q[100:, 0] -= 2 * np.pi
    return q


def chosen(limits: DatasetThresholds, r: Record = RECORD, **given: Any) -> Any:
    usual = DatasetThresholds()
    return refusal(lambda: replace(choose(r, Settings(thresholds=limits, **given)), thresholds=usual))


def moving(limits: DatasetThresholds) -> Any:
    q, motor = (np.repeat(x[::50], 50, axis=0) for x in (RECORD.q, RECORD.motor))
    return prepare(replace(RECORD, q=q, motor=motor), Settings(thresholds=limits)).moving.tolist()


def awake(limits: DatasetThresholds, r: Record = RECORD) -> Any:
    return prepare(r, Settings(cutoff=5.0, turns=False, thresholds=limits)).awake.tolist()


def of_rates(limits: DatasetThresholds) -> Any:
    other = replace(RECORD, t=1.01 * RECORD.t)
    return refusal(lambda: choose([RECORD, other], Settings(thresholds=limits)).factor)


def shared(limits: DatasetThresholds) -> Any:
    other = record(None, 1, 0.0, 2, "s")
    q, given = other.q.copy(), np.asarray(other.input).copy()
    q[100:130], given[100:130] = RECORD.q[:30], np.asarray(RECORD.input)[:30]
    return refusal(lambda: check_different(RECORD, replace(other, q=q, input=given), limits))


def rows(limits: DatasetThresholds) -> Any:
    return refusal(lambda: len(prepare(RECORD.part(0, 700), Settings(cutoff=2.0, thresholds=limits)).rows))


def few_readings(limits: DatasetThresholds) -> Any:
    q = RECORD.q.copy()
    q[:, 0] = np.round(q[:, 0] / 0.1) * 0.1
    return chosen(limits, replace(RECORD, q=q), position_cutoff=0.0)


def drifting() -> Record:
    """Periods that differ by some of their power."""
    t = RECORD.t
    return replace(RECORD, q=RECORD.q + 0.02 * RECORD.q.std(axis=0) * np.sin(0.4 * t)[:, None])


def given_period(limits: DatasetThresholds) -> Any:
    return refusal(lambda: period_of(drifting(), 10.0, limits))


def cases(folder: Path) -> dict[str, tuple[Value, Seen]]:
    """Another value of each threshold, and what it must change."""
    (folder / "range").mkdir()
    spec, range_seen = log(folder / "range", STEP * np.arange(500.0) + 1.0), out_of_range()
    names = ("short", "gap", "jitter", "uneven", "slow", "fast", "turn")
    folders = {name: folder / name for name in names}
    for path in folders.values():
        path.mkdir()
    return {
        "min_samples": (40, reading(folders["short"], STEP * np.arange(30.0))),
        "max_pause": (0.5, paused),
        "max_gap_periods": (3.0, reading(folders["gap"], gap(5.0))),
        "max_jitter": (1e-3, reading(folders["jitter"], uneven(0.02))),
        "max_spline_jitter": (0.1, reading(folders["uneven"], uneven(0.4))),
        "averaging_step": (1.1, averaged),
        "slow_sampling_step": (0.05, reading(folders["slow"], 0.1 * np.arange(100.0))),
        "fast_sampling_step": (0.01, reading(folders["fast"], STEP * np.arange(200.0))),
        "doubled_stamps": (0.9, stamped(4 * STEP * np.floor(np.arange(200.0) / 4))),
        "even_roughness": (0.0, stamped(uneven(0.8))),
        "min_refreshes": (300, repeated()),
        "min_repeats": (5.0, repeated(period=50)),
        "single_refreshes": (1.1, repeated(1, period=50)),
        "whole_refreshes": (1.0, repeated(1, period=50)),
        "refresh_over_resolution": (1e9, repeated(1)),
        "least_repeats": (2.0, repeated(1, often=(1, 2))),
        "moves_after_standing": (1e6, repeated(1, often=(1, 8))),
        "remarked_effort": (1.3, efforts(0.85)),
        "impossible_effort": (1.05, efforts(0.9)),
        "outlying_effort": (50.0, efforts(np.inf, 30.0, 0.0005)),
        "min_lone_samples": (5000, wrong_readings),
        "lone_reading": (1e30, wrong_readings),
        "jump": (1e3, jumping),
        "lone_effort": (1.0, wrong_readings),
        "misread_efforts": (0.15, efforts(2.0, 10.0, 0.1)),
        "milliampere_readings": (1.5, efforts(0.1)),
        "steady_step": (0.01, reading(folders["turn"], STEP * np.arange(200.0), turned())),
        "max_range_excess": (0.001, lambda limits: range_seen(limits, spec)),
        "max_shared_samples": (20, shared),
        "max_rate_difference": (1e-3, of_rates),
        "max_noise_share": (0.1, lambda limits: chosen_cutoff([noisy()], limits)),
        "cutoff_rounding_share": (0.1, lambda limits: chosen_cutoff([coarse(RECORD)], limits)),
        "max_speed_noise_share": (0.1, lambda limits: chosen(limits, coarse(RECORD)).position_cutoff),
        "least_position_cutoff_over_cutoff": (3.0, lambda limits: chosen(limits, rough()).position_cutoff),
        "max_rounding_share": (1.0, lambda limits: refusal(lambda: check_coarse(rough(), 20.0, limits))),
        "bandwidth_power": (0.5, lambda limits: motion_bandwidth(RECORD, limits)),
        "cutoff_over_bandwidth": (25.0, lambda limits: chosen_cutoff([coarse(RECORD)], limits)),
        "min_cutoff_periods": (250.0, lambda limits: chosen_cutoff([coarse(RECORD)], limits)),
        "samples_per_cutoff_period": (100.0, lambda limits: chosen_cutoff([RECORD], limits)),
        "position_cutoff_over_cutoff": (3.0, lambda limits: chosen(limits, cutoff=5.0)),
        "max_position_cutoff": (0.01, lambda limits: chosen(limits, cutoff=5.0)),
        "row_rate_over_cutoff": (5.0, lambda limits: chosen(limits, cutoff=5.0)),
        "trimmed_cutoff_periods": (3.0, lambda limits: chosen(limits, cutoff=5.0)),
        "direction_deviations": (20.0, lambda limits: awake(limits, coarse(RECORD))),
        "max_acceleration_noise": (1e-9, lambda limits: chosen(limits, coarse(RECORD), cutoff=5.0)),
        "rest_speed": (0.1, lambda limits: chosen(limits, cutoff=5.0)),
        "max_readings_at_rest": (50, few_readings),
        "rest_cutoff_periods": (0.5, lambda limits: chosen(limits, cutoff=5.0)),
        "min_rest_time": (0.5, lambda limits: chosen(limits, cutoff=5.0)),
        "max_rest_weight": (0.5, moving),
        "short_rest_cutoff_periods": (0.2, awake),
        "turning_periods": (4.0, lambda limits: awake(limits, with_hold(RECORD, "instant"))),
        "max_instant_std": (0.01, lambda limits: fitting(0.02, 0.05, STEP, limits)),
        "instant_tolerance": (0.02, lambda limits: fitting(0.15, 0.01, STEP, limits)),
        "min_rows": (100, rows),
        "max_period_difference": (1e-6, lambda limits: period_of(drifting(), None, limits)),
        "max_given_period_difference": (1e-4, given_period),
        "min_period_samples": (5000, lambda limits: refusal(lambda: period_of(RECORD, 10.0, limits))),
    }


def repeated(count: int = 4, *, period: int = 200, often: tuple[int, int] = (4, 4)) -> Seen:
    """200 readings of some channels that stand there so often at 1 kHz, from the first to the second number.

    period: readings after which the motion comes again.
    """
    rows = np.random.default_rng(2).integers(often[0], often[1] + 1, 200)
    fresh = np.repeat(STEP * (np.arange(200) % period), rows)
    q = 0.3 * np.sin(np.multiply.outer(fresh, [1.0, 1.3]))
    columns = np.column_stack([q, np.cos(q)])[:, -count:]
    return lambda limits: refresh_of(columns, limits) is not None


def stamped(t: Array) -> Seen:
    """Even samples under other stamps."""
    q = 0.3 * np.sin(np.multiply.outer(STEP * np.arange(len(t)), [1.0, 1.3]))
    return lambda limits: true_stamps(t, q, limits)[1]


def wrong_readings(limits: DatasetThresholds) -> Any:
    """2000 samples of a position and an effort, one of each read wrongly."""
    t = STEP * np.arange(2000.0)
    table = np.column_stack([t, np.sin(t), np.cos(t)])
    table[[150, 250], [1, 2]] += 0.1
    return without_lone("log", table, {1: "q1"}, {2: "i1"}, limits)[1]


def jumping(limits: DatasetThresholds) -> Any:
    """A position that jumps by thirty of its usual steps."""
    t = STEP * np.arange(2000.0)
    return len(jumps(t, np.sin(t) + 30 * STEP * (t > t[700]), limits)[0])


def efforts(limit: float, high: float = 1.0, share: float = 1.0) -> Seen:
    """Currents of 1 A, of `high` A in a share of the readings, against the limit of the drive [A]."""
    joint = ARM.joints[0]
    drive = replace(joint.drive, limits=replace(joint.drive.limits, current=limit))
    arm = replace(ARM, joints=(replace(joint, drive=drive), ARM.joints[1]))
    given = np.ones((2000, 2))
    given[500 : 500 + round(2000 * share), 0] = high
    t, q, ones = STEP * np.arange(2000.0), np.zeros((2000, 2)), np.ones((2000, 2))
    r = Record("log", t, q, q, given, ones, ("A", "A"))
    drives = drives_of(arm)
    return lambda limits: refusal(lambda: check_efforts(r, ("i1", "i2"), arm, drives, limits))


def noisy() -> Record:
    """Positions with a noise of 0.1 mrad."""
    q = RECORD.q + 1e-4 * np.random.default_rng(2).normal(size=RECORD.q.shape)
    return replace(RECORD, q=q, motor_side=(False, False))


def rough() -> Record:
    """Positions of seven bits."""
    q = 2 * np.pi / 128 * np.round(RECORD.q / (2 * np.pi / 128))
    return replace(RECORD, q=q, motor_side=(False, False))


def averaged(limits: DatasetThresholds) -> str:
    found = Survey("log", rate=1.0 / (1.2 * STEP), limits=limits)
    found.add(STEP * np.arange(100.0))
    return found.axis().method


def paused(limits: DatasetThresholds) -> bool:
    """Whether a record runs on from one of its clock that ended a second before."""
    later = replace(RECORD, name="later", t=RECORD.t + RECORD.t[-1] + 1.0)
    settings = Settings(thresholds=limits)
    return in_sequence([prepare(r, settings) for r in (RECORD, later)])[1].before is not None


@pytest.mark.parametrize("name", [entry.name for entry in DatasetThresholds().entries()])
def test_a_threshold_of_the_dataset_acts(name: str, tmp_path: Path) -> None:
    other, seen = cases(tmp_path)[name]
    usual = DatasetThresholds()
    assert seen(usual) == seen(usual)
    assert seen(usual) != seen(usual.with_values({name: other}))
