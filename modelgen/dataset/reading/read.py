"""Columns of a log become a Record: joint and motor coordinates, inputs, one uniform time axis."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.content import noise_alone
from modelgen.dataset.processing.rounding import step_of
from modelgen.dataset.processing.stamps import EVEN, strayed, true_stamps
from modelgen.dataset.processing.timing import Axis, Survey, survey
from modelgen.dataset.reading import checks
from modelgen.dataset.reading.absent import without_absent
from modelgen.dataset.reading.clocks import Channels, fresh
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.jumps import jump_of
from modelgen.dataset.reading.lone import without_lone
from modelgen.dataset.reading.lost import Missing, at_their_instants, lost_rows, missing_rows
from modelgen.dataset.reading.on_axis import OnAxis
from modelgen.dataset.reading.plausible import check_counters, check_efforts, doubtful_unit
from modelgen.dataset.reading.repeats import without_doubled
from modelgen.dataset.reading.sources import BLOCK, Source, open_source, since_1970
from modelgen.dataset.reading.specs import Spec
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array


def read(
    log: Log,
    arm: Arm,
    mapping: Path | str | None = None,
    thresholds: DatasetThresholds = USUAL,
    *,
    still: bool = False,
) -> Record:
    """The record that `FILE` or `FILE@t0:t1` names, or a table of columns holds, in the arm's coordinates.

    Columns are those of docs/logs.md, or what the mapping file makes of the log's own. Raises InputError
    for anything that is missing, doubled, not finite, out of order, constant, too short or out of range. A
    record is given back as it is; one of another arm is refused. still: whether some joints, not all, may
    stand throughout, with a remark.
    """
    return read_with_stamps(log, arm, mapping, thresholds, still=still)[0]


def read_with_stamps(
    log: Log,
    arm: Arm,
    mapping: Path | str | None = None,
    thresholds: DatasetThresholds = USUAL,
    *,
    still: bool = False,
) -> tuple[Record, Array]:
    """The record of a log as `read` has it, and its stamps (N,) [s] as they were logged."""
    if isinstance(log, Record):
        return _of_arm(log, arm), log.t
    source = open_source(log, arm, mapping, thresholds)
    spec = source.spec.text
    blocks = list(source.blocks())
    table = np.concatenate(blocks) if blocks else np.empty((0, len(source.wanted)))
    check_length(source, len(table))
    checks.check_finite(spec, table[:, 0], source.wanted, table)
    stamps = table[:, 0]
    positions, efforts = (
        {k: name for k, name in enumerate(source.wanted) if name in part}
        for part in (source.signals.position, source.signals.effort)
    )
    table, doubled = without_doubled(table)
    new = fresh(table, channels_of(source), thresholds) if np.all(np.diff(table[:, 0]) > 0.0) else None
    together, repeats = False, 1.0
    if new is not None:
        table, repeats, source = new.table, new.every, replace(source, hold=new.hold)
        together = new.together and not source.stated
    table, stamped = _true_stamps(source, table)
    _check_counters(source, table)
    table, lone = without_lone(spec, table, positions, efforts, thresholds)
    found = [*doubled, *(() if new is None else new.remarks), *stamped, *lone]
    check_length(source, len(table))
    axis = survey(Survey(spec, source.rate, source.gap, thresholds), table[:, 0], BLOCK)
    missing = None
    if axis.method == "none":
        missing = missing_rows(_positions(source, table), thresholds)
        t, said = at_their_instants(table[:, 0], missing)
        if said:
            found.append(said)
            table = np.column_stack([t, table[:, 1:]])
            axis = survey(Survey(spec, source.rate, source.gap, thresholds), t, BLOCK)
    if axis.method != "none" and source.rate is None and repeats == 1.0:
        rate = _rate_of_file(source)
        axis = survey(Survey(spec, rate, source.gap, thresholds), table[:, 0], BLOCK)
    if together:
        # Position and effort that are new together were read together, which no controller's output is.
        source = replace(source, hold="instant")
        found.append(
            "the effort is new where the position is: it counts as read at the same instant (hold: instant)"
        )
    record, logged = record_of(source, arm, table, axis, axis.times(), missing)
    if together:
        record = replace(record, hold_known="readings")
    if found:
        record = replace(record, remarks=(*found, *record.remarks), repeats=repeats)
    stands = (np.ptp(logged, axis=0) == 0.0) | noise_alone(logged)
    held = tuple(int(k) for k in np.flatnonzero(stands)) if still and record.n > 1 else ()
    checks.check_constant(spec, arm, source.signals.position, logged, "position", held=held)
    if record.input is not None:
        checks.check_constant(spec, arm, source.signals.effort, record.input, "effort", held=held)
    if held:
        names = ", ".join(arm.joints[arm.coordinates[k]].name for k in held)
        said = f"{spec}: left out for {names}, at rest throughout: only other records tell of that"
        record = replace(record, remarks=(*record.remarks, said))
    return record, stamps


def check_length(source: Source, samples: int) -> None:
    """Refuse a record with too few samples. Raises InputError, which says of a part what there is."""
    least = source.thresholds.min_samples
    if samples >= least:
        return
    message = f"{source.spec.text}: found {samples} samples, expected at least {least}"
    stamps = _stamps_of_file(source) if _is_part(source.spec) else ()
    if len(stamps):
        message += f"; the log has {len(stamps)}, from {min(stamps):.9g} to {max(stamps):.9g} s"
    raise InputError(message)


def _is_part(spec: Spec) -> bool:
    return (spec.begin, spec.end) != (-math.inf, math.inf)


def _stamps_of_file(source: Source) -> Array:
    """The stamps (N,) [s] of the whole file of which the source is a part."""
    whole = replace(source, spec=replace(source.spec, begin=-math.inf, end=math.inf))
    # rows of others are no samples: messages on the topic of a bag, blank cells
    blocks = list(whole.blocks(time_alone=not source.in_turn))
    stamps = np.concatenate(blocks)[:, 0] if blocks else np.empty(0)
    found: Array = stamps[np.isfinite(stamps)]
    return found


def _rate_of_file(source: Source) -> float | None:
    """Samples per second by the median step of the whole file: its parts have one rate. None for a whole."""
    if not _is_part(source.spec):
        return None
    steps = np.diff(_stamps_of_file(source))
    steps = steps[steps > 0.0]
    return 1.0 / float(np.median(steps)) if len(steps) else None


def channels_of(source: Source) -> Channels:
    """Which of the source's columns are positions and efforts, and of which joints."""
    names, signals = source.wanted, source.signals
    pairs = zip(signals.position, signals.effort, strict=True)
    return Channels(
        names,
        [names.index(name) for name in dict.fromkeys(signals.position)],
        [names.index(name) for name in dict.fromkeys(signals.effort) if name is not None],
        [(names.index(at), names.index(effort)) for at, effort in pairs if effort is not None],
        source.hold,
        source.stated,
    )


def _positions(source: Source, table: Array) -> Array:
    """Positions (N, n) of a table of the source's columns (N, k), by joint, as logged."""
    return table[:, [source.wanted.index(name) for name in source.signals.position]]


def _check_counters(source: Source, table: Array) -> None:
    """Efforts and speeds (N, k) that are no counters read wrongly. Raises InputError."""
    asked = [*source.signals.effort, *(source.signals.dq or ())]
    check_counters(source.spec.text, source.wanted, table, asked, getattr(source.reader, "scales", {}))


def _true_stamps(source: Source, table: Array) -> tuple[Array, list[str]]:
    """The table at instants that the positions agree with, and remarks."""
    if source.rate is not None or len(table) < 2:
        return table, []
    even, remark = true_stamps(table[:, 0], _positions(source, table), source.thresholds)
    return (table, []) if remark is None else (np.column_stack([even, table[:, 1:]]), [remark])


def _of_arm(record: Record, arm: Arm) -> Record:
    """A record of the arm's coordinates. Raises InputError."""
    expected = arm.coordinate_names
    given = record.arm
    found = None if given is None else given.coordinate_names
    if record.n != len(expected) or found not in (None, expected):
        here = f"{record.n} coordinates" + ("" if found is None else f" ({', '.join(found)})")
        raise InputError(
            f"{record.name}: found a record of {here}, expected {len(expected)} ({', '.join(expected)})"
        )
    return record


def record_of(
    source: Source, arm: Arm, table: Array, axis: Axis, t: Array, missing: Missing | None = None
) -> tuple[Record, Array]:
    """The record of a table of the source's columns (N, k), and its positions as logged (M, n).

    t: times of the axis that it shall have (M,) [s], all or a part. missing: rows of the table that its
    positions show to be missing, None where they are still to be looked for. Raises InputError where
    positions leave the arm's limits.
    """
    file, limits = source.spec.text, source.thresholds
    signals, drives = source.signals, source.drives
    _check_counters(source, table)
    table, unread, left_out = without_absent(file, table, channels_of(source))
    on_axis = OnAxis(source, {name: table[:, k] for k, name in enumerate(source.wanted)}, axis, t)
    logged = on_axis.smooth(signals.position)
    counts: tuple[float, ...] = ()
    if axis.method != "none":  # which blurs them
        counts = tuple(step_of(on_axis.columns[name]) for name in signals.position)
    motor_side = tuple(name.startswith("qm") for name in signals.position)
    q, motor = logged.copy(order="K"), logged.copy(order="K")
    for k, drive in enumerate(drives):
        if motor_side[k]:
            q[:, k] = drive.joint(logged[:, k])
        elif drive.ratio is not None:
            motor[:, k] *= drive.ratio
        else:
            motor[:, k] = drive.motor(logged[:, k])
    checks.check_jumps(file, arm, signals.position, q, t, limits.steady_step)
    as_read = _positions(source, table)
    jump = jump_of(signals.position, table[:, 0], as_read, limits)
    lost = ""
    if axis.method == "none":
        lost = lost_rows(table[:, 0], missing_rows(as_read, limits) if missing is None else missing)
    margin = limits.max_range_excess
    left = checks.check_range(file, arm, drives, signals.position, logged, q, margin)
    left += checks.trembling(file, signals.position, as_read)
    remarks = [*source.remarks, *left, *left_out, *(x for x in (jump, lost) if x)]
    if axis.method != "none":
        remarks.append(
            f"{file}: {strayed(axis.jitter)}: resampled at {1 / axis.step:.6g} Hz"
            if axis.jitter >= EVEN
            else f"{file}: resampled at {1 / axis.step:.6g} Hz"
        )
    doubt = doubtful_unit(axis.step, limits)
    if doubt and not source.timed:
        raise InputError(f"{file}: {doubt}; `modelgen inspect LOG --skeleton FILE` writes one to start from")
    if doubt:
        remarks.append(f"a sample every {axis.step:.6g} s, by the unit that the mapping file declares")
    gain, given, hold = None, None, 0.0
    if any(signals.effort):
        effort, hold = on_axis.efforts(signals.effort)
        gain = np.ones_like(effort)
        for k, (name, drive) in enumerate(zip(signals.effort, drives, strict=True)):
            kind = (name or "").rstrip("0123456789")
            if kind == "tau" and drive.driven:
                ratio = drive.ratio
                gain[:, k] = drive.gain(q[:, k]) if ratio is None else drive.torque_constant * ratio
            elif kind == "taum":
                # of an actuator with a length the force, for all motor units in a metre of it
                gain[:, k] = drive.torque_constant * (1.0 if drive.of_length is None else drive.of_length[0])
        given = effort / gain
    elif any(drive.driven for drive in drives):
        raise InputError(
            f"{file}: found no effort, expected i<n> or tau<n>: {arm.name} is driven; "
            "a free motion needs an arm whose moving joints have no drive"
        )
    record = Record(
        name=file,
        t=t,
        q=q,
        motor=motor,
        input=given,
        gain=gain,
        effort_unit=effort_units(source, arm) if given is not None else (),
        dq=None if signals.dq is None else on_axis.smooth(signals.dq),
        ddq=None if signals.ddq is None else on_axis.smooth(signals.ddq),
        temperature=None if signals.temperature is None else on_axis.smooth(signals.temperature),
        motor_side=motor_side,
        hold=hold,
        remarks=tuple(remarks),
        arm=arm,
        held=source.hold in ("following", "previous"),
        jitter=axis.jitter,
        effort_hold=source.hold,
        hold_known="mapping" if source.stated else "",
        counts=counts,
        begins=since_1970(source.reader, float(t[0])) if len(t) else None,
        jump=jump or lost,
        absent=on_axis.touched(signals.effort, unread),
        uneven=on_axis.uneven(signals.effort) if given is not None else None,
    )
    beyond = check_efforts(record, signals.effort, arm, drives, limits)
    return (replace(record, remarks=(*remarks, *beyond)) if beyond else record), logged


def effort_units(source: Source, arm: Arm) -> tuple[str, ...]:
    """Unit of what the log carried, by joint: A, N m or N at the joint, or what the mapping declared."""
    units = []
    for i, drive, name in zip(arm.coordinates, source.drives, source.signals.effort, strict=True):
        joint = "N" if arm.joints[i].type == "prismatic" else "N m"
        kind = (name or "").rstrip("0123456789")
        by_name = "A" if kind == "i" or (drive.driven and name is None) else joint
        units.append(by_name if kind == "tau" or name is None else source.effort_units.get(name, by_name))
    return tuple(units)
