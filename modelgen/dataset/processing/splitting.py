"""A record from where its motion repeats, and in two: at a boundary of its periods, else in the middle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.periods import repetition, whole_periods
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.specs import cut, parse
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array

_COLUMNS = ("t", "q", "motor", "input", "gain", "dq", "ddq", "temperature", "cut_off", "absent")
REPEATING = 3  # periods of which two can stay together, which shows what is noise


def repeating(
    record: Record, period: float | None = None, limits: DatasetThresholds = USUAL
) -> tuple[Record, float | None]:
    """The record from where its motion repeats, and samples in a period; as it is, and None, where none does.

    A way into the motion that is left out so is remarked on. period: [s], where it is given. Raises
    InputError for a given period that is none.
    """
    found = repetition(record, period, limits)
    if found is None or not found[0]:
        return record, None if found is None else found[1]
    begin, lag = found
    remark = f"{record.name}: {repeats_from(record, found)}, what is before is left out"
    part = cut(replace(record, remarks=(*record.remarks, remark), period=lag), begin, len(record.t))
    return part, lag


def repeats_from(record: Record, found: tuple[int, float]) -> str:
    """Where the motion of a record repeats from. found: as `repetition` has it."""
    begin, lag = found
    return f"the motion repeats every {lag * record.step:.6g} s from t = {record.t[begin]:.9g} s on"


def split(record: Record, period: float | None = None, limits: DatasetThresholds = USUAL) -> list[Record]:
    """A record in two consecutive parts, named after their times, with a remark on where they meet.

    Where the motion repeats they meet after half of its whole periods, or half a period later: three give two
    and one. What comes before it repeats is left out. period: [s], where it is given. Raises InputError for
    fewer than four samples, and for a given period that is none.
    """
    count = len(record.t)
    if count < 4:
        raise InputError(f"{record.name}: {count} samples cannot be split into two parts")
    found = repetition(record, period, limits)
    if found is None:
        return _parts(record, 0, count // 2, "the motion does not repeat")
    begin, lag = found
    whole = whole_periods(count - begin, lag)
    first = whole - whole // 2
    known = replace(record, period=lag)
    counts = f"{whole} periods of {lag * record.step:.6g} s"
    late = f" from t = {record.t[begin]:.9g} s on, what is before is left out" if begin else ""
    said = f"{counts}{late}, {first} before and {whole - first} after"
    if whole < REPEATING:
        said += ": neither part repeats, so that noise is not measured; record three periods, or another log"
    return _parts(known, begin, begin + round(first * lag), said)


def _parts(record: Record, begin: int, middle: int, said: str) -> list[Record]:
    t = record.t[middle]
    at = f"{t:.9g}" if abs(t) < 1e6 else f"{t:.3f}"  # stamps of a clock have ten digits before the point
    remark = f"{record.name}: a single training log, split in two at t = {at} s: {said}"
    told = replace(record, remarks=(remark, *record.remarks))
    return [cut(told, begin, middle), cut(told, middle, len(record.t))]


@contextmanager
def split_said(train: Sequence[Log]) -> Iterator[None]:
    """Refusals of a part that `split` made name the single training log too, as it was given."""
    try:
        yield
    except InputError as error:
        given = [parse(log) for log in train]
        name = f"{error.message} ".split(": ")[0]
        if len(given) != 1 or error.where is not None or name == given[0].text:
            raise
        if not name.startswith(f"{given[0].path}@"):
            raise
        said = f"{given[0].text}, the single training log, is split in two, and of the parts {error.message}"
        raise InputError(said) from None


def as_given(parts: Sequence[Record]) -> list[Record]:
    """Records as they were before `split`: two parts of which one goes on where the other ends are one."""
    if len(parts) != 2 or not any("a single training log, split in two" in x for x in parts[0].remarks):
        return list(parts)
    one, two = parts

    def both(name: str) -> Array | None:
        first, second = getattr(one, name), getattr(two, name)
        return None if first is None or second is None else np.concatenate([first, second])

    columns = {name: both(name) for name in _COLUMNS}
    return [replace(one, **columns)]  # type: ignore[arg-type]
