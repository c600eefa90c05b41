"""Efforts that are cut off in logs of any length: limits by a part of the blocks, samples block by block."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, Record, Stream
from modelgen.dataset.processing.saturation import ends_of, standing_at
from modelgen.dataset.processing.settings import Chosen
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.identification.cut_off import CutOffError, Limits, ends_in, limits_of, uncut
from modelgen.identification.effort_limits import logged_of
from modelgen.numeric import Array

PART = 16  # blocks that limits are looked for in, at most


@dataclass(frozen=True)
class StreamedLimits:
    """What is left out of blocks. limits: as the model shows them, or None. levels: readings of each joint at
    which an effort is cut off as they alone show it. remarks: on what is left out.
    """

    settings: Chosen
    limits: Limits | None
    levels: Sequence[Sequence[float]]
    remarks: tuple[str, ...] = ()

    def without(self, record: Record) -> Record:
        """The record with the samples named at which efforts are cut off."""
        if record.input is None:
            return record
        if self.limits is not None:
            return replace(record, cut_off=self.limits.of(uncut(record, self.settings), self.levels))
        return replace(record, cut_off=standing(record, self.levels))

    def beyond(self, record: Record) -> Record:
        """A whole record, which is no stream, with the samples named that the model shows to be cut off."""
        if self.limits is None or record.input is None:
            return record
        return replace(record, cut_off=self.limits.of(uncut(record, self.settings)))

    def remarked(self, record: Record) -> Record:
        """The record with remarks on what is left out."""
        return replace(record, remarks=(*record.remarks, *self.remarks))


def standing(record: Record, levels: Sequence[Sequence[float]]) -> NDArray[np.bool_]:
    """Samples (N, n) of a record at these readings of each joint, and those beside them."""
    logged = record.logged_effort
    assert logged is not None
    return np.column_stack([standing_at(x, own) for x, own in zip(logged.T, levels, strict=True)])


def streamed_limits(streams: Sequence[Stream], arm: Arm) -> StreamedLimits:
    """Limits of the efforts of streams that are read alike. Raises InputError as `limits_of` does.

    A limit is the highest or lowest reading of all blocks; whether it is one is asked of some that are spread
    over them.
    """
    chosen = streams[0].settings
    n = len(arm.coordinates)
    low, high = np.full(n, np.inf), np.full(n, -np.inf)
    some: list[Prepared] = []
    every = max(1, -(-sum(len(s) for s in streams) // PART))
    for number, record in enumerate(_records(streams)):
        logged = record.logged_effort
        if logged is None:
            return StreamedLimits(chosen, None, [()] * n)
        low, high = np.minimum(low, logged.min(axis=0)), np.maximum(high, logged.max(axis=0))
        if number % every == 0:
            some.append(uncut(record, chosen))
    levels = _levels(some, low, high)
    ends = [e for e in ends_in(some) if e.reading == (high if e.sign > 0 else low)[e.joint]]
    try:
        limits = limits_of(some, ends, arm)
    except CutOffError:
        raise
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        limits = None  # what is wrong is said where the parameters are found
    if limits is None:
        return StreamedLimits(chosen, None, levels)
    flags = [limits.of(p, levels) for p in some]
    return StreamedLimits(chosen, limits, levels, limits.remarks(some, flags))


def _records(streams: Sequence[Stream]) -> Iterator[Record]:
    for stream in streams:
        yield from stream.records()


def _levels(some: Sequence[Prepared], low: Array, high: Array) -> list[tuple[float, ...]]:
    """Readings of each joint at which an effort is cut off as those of some blocks show it, if none of all
    blocks is beyond.
    """
    found = []
    for j in range(len(low)):
        logged = np.concatenate([logged_of(p)[:, j] for p in some])
        q = np.concatenate([p.record.q[:, j] for p in some])
        shown = [level for level, _ in ends_of(logged, q)]
        found.append(tuple(level for level in shown if level in (low[j], high[j])))
    return found
