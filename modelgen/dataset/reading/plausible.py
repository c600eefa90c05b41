"""Efforts that cannot be what they seem: unsigned readings of negative values, other units, outliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.drives import NumericDrive
from modelgen.dataset.mapping.units import plausible_times
from modelgen.dataset.objects import Record
from modelgen.dataset.processing.saturation import cut_off
from modelgen.dataset.thresholds import DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array

BITS = (16, 24, 32, 12, 10, 8)
OVER = 0.9  # of the range, that readings of a counter jump where it overflows
WHOLE = 0.97  # of a counter's range, that is there at least
STANDING = 5.0  # times as many as one step before it, that stand at an end where readings are cut off
Scale = tuple[float, float]
STEADY = 0.2  # of the range without overflows, that readings change from one to the next


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


def check_counters(
    file: str, names: Sequence[str], table: Array, asked: Sequence[str | None], scales: Mapping[str, Scale]
) -> None:
    """Columns (N, k), the first of them times [s], whose readings as logged must not be unsigned where they
    are negative, nor overflow. asked: names of the columns that are. scales: factor and offset that a mapping
    file has. Raises InputError.
    """
    for k, name in enumerate(names):
        if name not in asked:
            continue
        factor, offset = scales.get(name, (1.0, 0.0))
        said = counter(name, table[:, 0], (table[:, k] - offset) / factor)
        if said:
            raise InputError(f"{file}: {said}")


def counter(name: str, t: Array, values: Array) -> str:
    """What is wrong with a column (N,) of readings as logged, if it is a counter that is read wrongly; else
    nothing. t: times (N,) [s].
    """
    with np.errstate(over="ignore"):  # a wrong digit makes any number
        bits = unsigned_bits(np.round(values, 6))
    if bits is not None:
        return (
            f"the column {name} runs from {values.min():.6g} to {values.max():.6g} with nothing in the "
            f"middle: negative values read as unsigned, so that -1 is {2**bits - 1}; declare `bits: {bits}` "
            "for it in a mapping file (--mapping)"
        )
    found = overflows(values)
    if found is None:
        return ""
    m, more = int(found.places[0]), len(found.places) - 1
    return (
        f"the column {name} goes from {values[m]:.6g} to {values[m + 1]:.6g} after t = {t[m]:.9g} s"
        f"{f', and so in {more} more places' if more else ''}: a counter of {found.bits} bits overflows "
        "there; use the parts beside it, FILE@t0:t1, or log it with more bits or in coarser steps"
    )


@dataclass(frozen=True)
class Overflow:
    """A counter of so many bits that overflows after samples `places`."""

    bits: int
    places: NDArray[np.intp]


def overflows(values: Array) -> Overflow | None:
    """A counter that overflows in readings as logged (N,); None where none does.

    Nearly all of its range is there, and from one end the readings go on smoothly at the other, for more than
    one of them: a lone one is corrected. Readings that are cut off stand at the end.
    """
    width, steps = float(np.ptp(values)), np.diff(values)
    over = np.abs(steps) > OVER * width
    if width <= 0.0 or not over.any() or not (over & ~np.roll(over, 1) & ~np.roll(over, -1)).any():
        return None
    step = _step(values)
    bits = next((b for b in BITS if step and WHOLE < (width / step + 1.0) / 2.0**b < 1.0 + 1e-4), None)
    if bits is None:
        return None
    whole = np.unwrap(values, period=step * 2.0**bits)
    extent = min(width, float(np.ptp(np.quantile(whole, (0.01, 0.99)))))
    if np.quantile(np.abs(np.diff(whole)), 0.99) > STEADY * extent:
        return None
    for inward in (values.max() - values, values - values.min()):
        last, before = (np.sum(np.rint(inward / step) == k) for k in (0, 1))
        if last > STANDING * (before + 1):
            return None
    return Overflow(bits, np.flatnonzero(over))


def _step(values: Array) -> float:
    """What readings (N,) with nothing in the middle are multiples of; 0 where they are of nothing."""
    steps = np.diff(np.unique(values))
    steps = steps[steps > 1e-9 * float(np.abs(values).max())]
    near = steps[steps < 20.0 * steps.min()] if len(steps) else steps
    if len(near) < 8:
        return 0.0
    number = near / near.min()
    even = np.abs(number - np.rint(number)).max() < 0.05
    return float(near.sum() / np.rint(number).sum()) if even else 0.0


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
