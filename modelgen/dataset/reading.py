"""From columns of a log to a Record: joint and motor coordinates, inputs, one uniform time axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modelgen.dataset import checks
from modelgen.dataset.drives import Drive, drives_of
from modelgen.dataset.objects import Array, Record
from modelgen.dataset.signals import Signals, find_signals
from modelgen.dataset.specs import Spec, parse
from modelgen.dataset.tables import open_table
from modelgen.dataset.timing import Axis, held_resampled, smooth_resampled, uniform_axis
from modelgen.description import Arm
from modelgen.errors import InputError

BLOCK = 100_000  # rows read at a time


def read(spec: str, arm: Arm, mapping: Path | None = None) -> Record:
    """The record that `FILE` or `FILE@t0:t1` names, in the arm's coordinates.

    Columns are those of docs/logs.md, or what the mapping file makes of the log's own. Raises InputError
    for anything that is missing, doubled, not finite, out of order, constant, too short or out of range.
    """
    part = parse(spec)
    reader = open_table(part.path)
    drives = drives_of(arm)
    signals = find_signals(part.text, reader.names, arm, drives)
    wanted = tuple(dict.fromkeys(signals.wanted))
    blocks = []
    for block in reader.blocks(wanted, BLOCK):
        inside = (block[:, 0] >= part.begin) & (block[:, 0] < part.end)
        blocks.append(block[inside | np.isnan(block[:, 0])])
    table = np.concatenate(blocks) if blocks else np.empty((0, len(wanted)))
    checks.check_length(part.text, len(table))
    checks.check_finite(part.text, table[:, 0], wanted, table)
    axis = uniform_axis(part.text, table[:, 0])
    columns = {name: table[:, k] for k, name in enumerate(wanted)}
    return _record(part, arm, drives, signals, columns, axis)


@dataclass(frozen=True)
class _Columns:
    """Columns by name, moved to the uniform axis."""

    stamps: Array
    columns: dict[str, Array]
    axis: Axis

    def smooth(self, names: Sequence[str | None]) -> Array:
        table = np.stack([self._column(name) for name in names], axis=1)
        return smooth_resampled(self.stamps, table, self.axis.t) if self.axis.resampled else table

    def held(self, names: Sequence[str | None]) -> Array:
        table = np.stack([self._column(name) for name in names], axis=1)
        return held_resampled(self.stamps, table, self.axis.t) if self.axis.resampled else table

    def _column(self, name: str | None) -> Array:
        return np.zeros_like(self.stamps) if name is None else self.columns[name]


def _record(
    part: Spec, arm: Arm, drives: Sequence[Drive], signals: Signals, columns: dict[str, Array], axis: Axis
) -> Record:
    file = part.text
    on_axis = _Columns(columns["t"], columns, axis)
    logged = on_axis.smooth(signals.position)
    motor_side = tuple(name.startswith("qm") for name in signals.position)
    q, motor = logged.copy(), logged.copy()
    for k, drive in enumerate(drives):
        if motor_side[k]:
            q[:, k] = drive.joint(logged[:, k])
        else:
            motor[:, k] = drive.motor(logged[:, k])
    checks.check_constant(file, arm, signals.position, logged, "position")
    remarks = checks.check_range(file, arm, signals.position, logged, q)
    if axis.resampled:
        remarks.append(
            f"the time axis jitters by up to {axis.jitter:.2g} periods: "
            f"resampled at {1 / _step(axis.t):.6g} Hz"
        )
    step = _step(axis.t)
    effort = on_axis.held(signals.effort) if any(signals.effort) else None
    gain = None
    units: tuple[str, ...] = ()
    if effort is not None:
        driven = tuple(n if d.driven else None for n, d in zip(signals.effort, drives, strict=True))
        checks.check_constant(file, arm, driven, effort, "effort")
        gain = np.ones_like(effort)
        for k, (name, drive) in enumerate(zip(signals.effort, drives, strict=True)):
            if name is not None and name.startswith("tau") and drive.driven:
                gain[:, k] = drive.gain(q[:, k])
        units = effort_units(arm, drives, signals.effort)
    elif any(drive.driven for drive in drives):
        raise InputError(
            f"{file}: found no effort, expected i<n> or tau<n>: {arm.name} is driven; "
            "a free motion needs an arm whose moving joints have no drive"
        )
    return Record(
        name=file,
        t=axis.t,
        q=q,
        motor=motor,
        input=None if effort is None or gain is None else effort / gain,
        gain=gain,
        effort_unit=units,
        dq=None if signals.dq is None else on_axis.smooth(signals.dq),
        ddq=None if signals.ddq is None else on_axis.smooth(signals.ddq),
        temperature=None if signals.temperature is None else on_axis.smooth(signals.temperature),
        motor_side=motor_side,
        hold=0.5 * step if effort is not None else 0.0,
        remarks=tuple(remarks),
        arm=arm,
        held=effort is not None,
    )


def effort_units(arm: Arm, drives: Sequence[Drive], names: Sequence[str | None]) -> tuple[str, ...]:
    """Unit of what the log carried, by joint: A, or N m or N at the joint."""
    units = []
    for i, drive, name in zip(arm.coordinates, drives, names, strict=True):
        current = drive.driven and not (name or "").startswith("tau")
        units.append("A" if current else "N" if arm.joints[i].type == "prismatic" else "N m")
    return tuple(units)


def _step(t: Array) -> float:
    return float(t[-1] - t[0]) / (len(t) - 1)
