"""Columns of a log: ranges, resolution, repeated readings; its rate, and the period of its motion."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from modelgen.dataset.drives import drives_of
from modelgen.dataset.inspection.bare_arm import arm_of
from modelgen.dataset.inspection.bare_columns import numbers_in
from modelgen.dataset.inspection.guesses import guessed_unit, kind_of, time_of, unit_in, unit_of_time
from modelgen.dataset.mapping.units import TIMES
from modelgen.dataset.objects import Reader, Record
from modelgen.dataset.processing.periods import repetition
from modelgen.dataset.processing.rounding import resolution
from modelgen.dataset.processing.splitting import repeats_from
from modelgen.dataset.reading.clocks import Channels, repeated_in
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.jumps import jump_of
from modelgen.dataset.reading.plausible import counter, doubtful_unit
from modelgen.dataset.reading.read import read_with_stamps
from modelgen.dataset.reading.sources import opened
from modelgen.dataset.reading.specs import parse
from modelgen.dataset.thresholds import USUAL
from modelgen.description import Arm
from modelgen.numeric import Array

_POSITION = re.compile(r"qm?[1-9][0-9]*")
REST_SAMPLES = 5  # on either side, over which a position that stands does not move
RESTING = 0.01  # of what it moves in as many samples otherwise
COUNTED = ("current", "torque", "velocity")  # whose counters may be read as unsigned, or overflow
SPIKE = 5.0  # of the 99 % quantile of the steps


@dataclass(frozen=True)
class Channel:
    """A column of numbers. unit: empty where nobody has said it. low, high: of the finite readings.

    resolution: what all differences of readings are multiples of, None where there is no such step.
    repeated: share of the readings that equal the one before. missing: readings that are not finite. guess:
    unit by name and size, where nobody has said it. at_rest: share of a position's readings about which it
    stands. spikes: readings far from those beside them, which agree.
    """

    name: str
    unit: str
    low: float
    high: float
    resolution: float | None
    repeated: float
    missing: int
    guess: str = ""
    at_rest: float | None = None
    spikes: int = 0

    def coarse(self, share: float) -> bool:
        """Whether a step of the readings is more than a share of their range."""
        return self.resolution is not None and self.resolution > share * (self.high - self.low) > 0.0


@dataclass(frozen=True)
class Inspected:
    """samples: N. begin, end: first and last stamp [s]. rate: one over the median time between samples [Hz].

    jitter: largest deviation of that time from its median, in medians. backwards: stamps that are not after
    the one before. period: of the motion [s], None where it does not repeat. without_numbers: columns of
    something else. t, columns: stamps (N,) [s] and readings (N,) by name. record: what was read for an arm.
    begins: first stamp in seconds since 1970, None where the stamps do not count from then.
    Rate, jitter and period are NaN or None where the log has no stamps.
    """

    name: str
    samples: int
    begin: float
    end: float
    rate: float
    jitter: float
    backwards: int
    period: float | None
    channels: tuple[Channel, ...]
    without_numbers: tuple[str, ...] = ()
    t: Array = field(default_factory=lambda: np.empty(0), compare=False, repr=False)
    columns: Mapping[str, Array] = field(default_factory=dict, compare=False, repr=False)
    remarks: tuple[str, ...] = ()
    record: Record | None = field(default=None, compare=False, repr=False)
    begins: float | None = None


def inspect(log: Log, arm: Arm | None = None, mapping: Path | str | None = None) -> Inspected:
    """A log as it is: without an arm all its columns, with an arm those that are read for it, in its units.

    A mapping file without an arm makes columns of joints without limits and gears. Raises InputError for a
    log that cannot be opened, and with an arm or a mapping also as `read` does, where some joints, not all,
    may stand throughout.
    """
    if isinstance(log, Record):
        return _of_record(log)
    if arm is None and mapping is not None:
        arm = arm_of(mapping)
    if arm is not None:
        return _of_record(*read_with_stamps(log, arm, mapping, still=True))
    spec = parse(log)
    reader = opened(spec)
    columns, rest = numbers_in(spec, reader)
    remarks, units = [*reader.remarks, *(x for x in rest.values() if x)], _said(reader)
    t = columns.get("t")
    stamps = time_of(columns) if t is None else None
    if stamps is not None:
        unit = unit_of_time(columns[stamps], stamps, units.get(stamps, ""))
        t = TIMES[unit] * (columns[stamps] - columns[stamps][0])
        remarks.append(
            f"no column t: times are those of {stamps}, in {unit} by a guess, from the first one on"
        )
    readings = {name: x for name, x in columns.items() if name != "t"}
    moving = {name: x for name, x in readings.items() if name != stamps and kind_of(name) == "position"}
    remarks += _repeated({name: x for name, x in readings.items() if name != stamps}, tuple(moving))
    named = [values for name, values in readings.items() if _POSITION.fullmatch(name)]
    positions = named or [x for x in moving.values() if np.ptp(x) > 0.0]
    found = _inspected(
        spec.text, t, [_channel(name, units.get(name, ""), x) for name, x in readings.items()], positions
    )
    doubt = "" if math.isnan(found.rate) else doubtful_unit(1.0 / found.rate, USUAL)
    axis = np.arange(len(next(iter(columns.values()))), dtype=np.float64) if t is None else t
    found = replace(found, t=np.asarray(axis, dtype=np.float64), columns=columns)
    remarks += found.remarks
    for name, x in readings.items():
        if kind_of(name) in COUNTED and np.isfinite(x).all() and (said := counter(name, found.t, x)):
            remarks.append(said)
    if t is not None and np.isfinite(t).all() and (np.diff(t) > 0.0).all():
        finite = [(name, x) for name, x in moving.items() if np.isfinite(x).all()]
        remarks += [jump for name, x in finite if (jump := jump_of((name,), t, x[:, None], USUAL))]
    return replace(found, without_numbers=tuple(rest), remarks=(*remarks, *([doubt] if doubt else [])))


def _said(reader: Reader) -> dict[str, str]:
    """Units that the file says of its columns, as a mapping file writes them."""
    said: Mapping[str, str] = getattr(reader, "units", {})
    kinds = {name: "time" if name == "t" else kind_of(name) or "" for name in said}
    found = {name: unit_in(name, kinds[name] or "time", word) for name, word in said.items()}
    return {name: unit for name, unit in found.items() if unit}


def _repeated(columns: Mapping[str, Array], positions: Sequence[str]) -> tuple[str, ...]:
    """Remarks about readings that are refreshed less often than the log is written."""
    finite = {name: x for name, x in columns.items() if np.isfinite(x).all()}
    if not finite:
        return ()
    names = ("t", *finite)
    table = np.stack([np.arange(len(next(iter(finite.values())))), *finite.values()], axis=1)
    of_motion = [k for k, name in enumerate(names) if name in positions]
    efforts = [k for k, name in enumerate(names) if kind_of(name) == "current"]
    return repeated_in(table, Channels(names, of_motion, efforts))


def inspect_record(record: Record, lag: float | None, samples: int | None = None) -> Inspected:
    """The inspection of a record by the columns that it was read from.

    lag: samples in a period of its motion. samples: of the whole, of which the record may be the beginning.
    """
    sides, units = record.motor_side or (False,) * record.n, record.units
    drives = () if record.arm is None else drives_of(record.arm)
    channels = []
    for k in range(record.n):
        if sides[k]:
            channels.append(_channel(f"qm{k + 1}", drives[k].unit if drives else "", record.motor[:, k]))
        else:
            channels.append(_channel(f"q{k + 1}", units[f"q{k + 1}"], record.q[:, k]))
    logged = record.logged_effort
    if logged is not None:
        for k, unit in enumerate(record.effort_unit):
            name = f"{'i' if unit == 'A' else 'tau'}{k + 1}"
            channels.append(_channel(name, unit, logged[:, k]))
    found = _inspected(record.name, record.t, channels, [])
    period = None if lag is None else lag * record.step
    count = found.samples if samples is None else samples
    return replace(
        found,
        samples=count,
        jitter=record.jitter,
        period=period,
        remarks=record.remarks,
        begins=record.begins,
    )


def _of_record(record: Record, t: Array | None = None) -> Inspected:
    """The inspection of a record. t: stamps as logged [s], where they are known."""
    units = record.units
    channels = [_channel(k, units[k], x) for k, x in record.columns.items() if k != "t"]
    found = _inspected(record.name, record.t if t is None else t, channels, [])
    period, said = _period(record)
    remarks = (*record.remarks, *said)
    return replace(found, period=period, remarks=remarks, t=record.t, columns=record.columns, record=record)


def _period(record: Record) -> tuple[float | None, tuple[str, ...]]:
    """Period of a record's motion [s], and a remark where that begins later than the record."""
    found = repetition(record)
    if found is None:
        return None, ()
    return found[1] * record.step, (repeats_from(record, found),) if found[0] else ()


def _inspected(
    name: str, t: Array | None, channels: Sequence[Channel], positions: Sequence[Array]
) -> Inspected:
    nan = math.nan
    if t is None or len(t) < 2 or not np.isfinite(t).all():
        return Inspected(name, 0 if t is None else len(t), nan, nan, nan, nan, 0, None, tuple(channels))
    steps = np.diff(t)
    median = float(np.median(steps))
    jitter = float(np.max(np.abs(steps - median)) / median) if median > 0.0 else nan
    rate = 1.0 / median if median > 0.0 else nan
    period, remarks = None, tuple[str, ...]()
    if positions and median > 0.0 and np.isfinite(positions).all() and len(t) > 8:
        q = np.stack(positions, axis=1)
        period, remarks = _period(Record(name, t, q, q))
    backwards = int(np.count_nonzero(steps <= 0.0))
    begin, end = float(t[0]), float(t[-1])
    about = Inspected(name, len(t), begin, end, rate, jitter, backwards, period, tuple(channels))
    return replace(about, remarks=remarks)


def _channel(name: str, unit: str, values: Array) -> Channel:
    finite = values[np.isfinite(values)]
    if not len(finite):
        return Channel(name, unit, math.nan, math.nan, None, 0.0, len(values))
    repeated = float(np.mean(np.diff(values) == 0.0)) if len(values) > 1 else 0.0
    low, high = float(finite.min()), float(finite.max())
    guess = "" if unit else guessed_unit(name, values)
    rest = _at_rest(finite) if kind_of(name) == "position" and len(finite) == len(values) else None
    missing = len(values) - len(finite)
    return Channel(name, unit, low, high, resolution(finite), repeated, missing, guess, rest, _spikes(finite))


def _at_rest(values: Array) -> float:
    """Share of positions (N,) about which the reading stands over several samples."""
    window = 2 * REST_SAMPLES + 1
    if len(values) <= window or np.ptp(values) == 0.0:
        return 1.0
    spans = np.lib.stride_tricks.sliding_window_view(values, window)
    travel = np.ptp(spans, axis=1)
    return float(np.mean(travel <= RESTING * np.quantile(travel, 0.99)))


@np.errstate(over="ignore", invalid="ignore")  # a wrong digit makes any number
def _spikes(values: Array) -> int:
    """Readings far from both neighbours, on the same side, while the neighbours agree."""
    if len(values) < 5:
        return 0
    before, here, after = values[:-2], values[1:-1], values[2:]
    up, down = here - before, here - after
    usual = float(np.quantile(np.abs(np.diff(values)), 0.99))
    alone = (up * down > 0.0) & (np.minimum(np.abs(up), np.abs(down)) > SPIKE * max(usual, 1e-300))
    return int(np.count_nonzero(alone & (np.abs(after - before) < 0.5 * np.abs(up))))
