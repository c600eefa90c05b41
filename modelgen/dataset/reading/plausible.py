"""Efforts that cannot be what they seem: unsigned readings of negative values, other units, outliers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset.drives import NumericDrive
from modelgen.dataset.mapping.units import plausible_times
from modelgen.dataset.objects import Record
from modelgen.dataset.processing.saturation import cut_off
from modelgen.dataset.thresholds import DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array

BITS = (16, 24, 32, 12, 10, 8)


def doubtful_unit(step: float, limits: DatasetThresholds) -> str:
    """A question where stamps in s, `step` apart from sample to sample, are no log's; else empty."""
    if limits.fast_sampling_step <= step < limits.slow_sampling_step:
        return ""
    fitting = [f"{unit} ({rate:.6g} Hz)" for unit, rate in plausible_times(step).items() if unit != "s"]
    asked = f"are they in {' or '.join(fitting)}, or" if fitting else "are they"
    how = "`time: {unit: ...}`" if step >= limits.slow_sampling_step else "`time: {column: 60 * t}`, say,"
    where = "in a mapping file (--mapping) decides"
    return f"stamps are {step:.6g} apart: {asked} in s ({1 / step:.6g} Hz)? {how} {where}"


def unsigned_bits(values: Array) -> int | None:
    """Bits of a counter whose negative values (N,) were read as unsigned; None where that is not so."""
    low, high = float(values.min()), float(values.max())
    if low < 0.0 or not np.array_equal(values, np.rint(values)):
        return None
    for bits in BITS:
        top = 2.0**bits
        if not 0.75 * top <= high < top:
            continue
        below, above = values[values < 0.25 * top], values[values >= 0.75 * top]
        # A signal that passes zero jumps over the middle; one of this size would be there too.
        if len(below) + len(above) == len(values) and min(len(np.unique(below)), len(np.unique(above))) >= 8:
            return bits
    return None


def check_unsigned(file: str, name: str, values: Array) -> None:
    """Readings as logged must not be unsigned where they are negative. Raises InputError."""
    bits = unsigned_bits(values)
    if bits is not None:
        raise InputError(
            f"{file}: the column {name} runs from {values.min():.6g} to {values.max():.6g} with nothing "
            f"in the middle: negative values read as unsigned, so that -1 is {2**bits - 1}; declare "
            f"`bits: {bits}` for it in a mapping file (--mapping)"
        )


def check_efforts(
    record: Record,
    names: Sequence[str | None],
    arm: Arm,
    drives: Sequence[NumericDrive],
    limits: DatasetThresholds,
) -> list[str]:
    """Inputs within the limits of the drives, and no single impossible reading; remarks.

    Raises InputError, with the unit that would fit.
    """
    if record.input is None:
        return []
    assert record.gain is not None
    remarks = []
    for k, name in enumerate(names):
        if name is None:
            continue
        logged = record.input[:, k] * record.gain[:, k]
        joint, drive = arm.joints[arm.coordinates[k]], drives[k]
        current = joint.drive.limits.current if drive.driven else None
        effort = joint.limits.effort
        if name.startswith("u"):
            current = effort = None
        if current is not None:
            size, limit, unit = np.abs(record.input[:, k]), current, "A"
        elif effort is not None:
            gain = np.abs(drive.gain(record.q[:, k])) if drive.driven else 1.0
            size, limit = np.abs(record.input[:, k]) * gain, effort
            unit = "N" if joint.type == "prismatic" else "N m"
        else:
            size, limit, unit = np.abs(logged), np.inf, record.effort_unit[k]
        m = int(np.argmax(size))
        place = f"{record.name}: {name} is {logged[m]:.6g} {record.effort_unit[k]} at t = {record.t[m]:.9g} s"
        if size[m] > limits.impossible_effort * limit:
            many = float(np.mean(size > limit))
            if (
                many > limits.milliampere_readings
                and np.quantile(size, 0.999) < 1.1e3 * limit
                and unit == "A"
                and name[0] == "i"
            ):
                hint = "these look like milliamperes; declare `unit: mA` in a mapping file (--mapping)"
            elif many > limits.misread_efforts:
                hint = "correct its unit or scale in a mapping file (--mapping), or the limit"
            else:
                hint = "an impossible reading: use the parts beside it, FILE@t0:t1, or correct the limit"
            raise InputError(f"{place}, the limit of joint {joint.name} is {limit:.6g} {unit}; {hint}")
        if size[m] > limits.remarked_effort * limit:
            remarks.append(f"{place.removeprefix(record.name + ': ')}, the limit is {limit:.6g} {unit}")
        ends = cut_off(logged, record.q[:, k])
        if ends is not None:
            remarks.append(
                f"{name} stands at {ends[0]:.6g} {record.effort_unit[k]} in {100 * ends[1]:.2g} % of the "
                "moving samples and never beyond: it seems to be cut off there, and they are left out"
            )
        usual = float(np.quantile(size, 0.999))
        beside = max((float(size[j]) for j in (m - 2, m + 2) if 0 <= j < len(size)), default=0.0)
        if len(size) > 1000 and size[m] > limits.outlying_effort * max(usual, beside) > 0.0:
            raise InputError(
                f"{place}, {size[m] / usual:.0f} times as much as 99.9 % of its readings: an impossible "
                "reading; use the parts beside it, FILE@t0:t1"
            )
    return remarks
