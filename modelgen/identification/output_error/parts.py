"""Measured motions cut into parts that are simulated one by one, and each into intervals of shooting."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.prepare import held_inputs
from modelgen.dataset.processing.released import free_samples
from modelgen.errors import InputError
from modelgen.numeric import Array

RATE = 250.0  # Hz, beyond which samples are left out: the steps between them are exact enough


@dataclass(frozen=True)
class Guess:
    """states: (W, 2n), where each interval begins."""

    states: Array

    def moved(self, step: Array, alpha: float) -> Guess:
        """The parts moved by alpha times a step (W, 2n)."""
        return Guess(self.states + alpha * step)


@dataclass(frozen=True)
class Part:
    """t: (K,) [s]. q: (K, n) as measured. dq: (K, n) filtered. input: (K, n), held over the interval that
    follows. intervals: first and last sample of each; the last is the next one's first."""

    name: str
    t: Array
    q: Array
    dq: Array
    input: Array
    intervals: tuple[tuple[int, int], ...]

    def single(self) -> Part:
        """One interval only."""
        return replace(self, intervals=((0, len(self.t) - 1),))

    def guess(self) -> Guess:
        """The measured states."""
        begins = [begin for begin, _ in self.intervals]
        return Guess(np.hstack([self.q[begins], self.dq[begins]]))


def parts(p: Prepared, window: float | None, interval: float) -> list[Part]:
    """The parts of a record: windows of so many seconds, or the whole from its release on.

    Of a free motion what counts is as of `free_samples`. Raises InputError for windows of less than ten
    samples.
    """
    stride = max(1, int((1.0 / p.record.step) / RATE))
    begin, end = free_samples(p) if p.input is None else (0, len(p.time))
    rows = np.arange(begin, end, stride)
    q, dq, t = p.record.q[rows], p.dq[rows], p.time[rows]
    given = held_inputs(p)
    # held over the samples left out: their mean
    u = np.add.reduceat(given[:end], rows, axis=0) / np.diff(np.append(rows, end))[:, None]
    step = float(t[1] - t[0])
    count = len(t) - 1 if window is None else round(window / step) if np.isfinite(window) else 0
    if count < 10:
        if window is None:
            raise InputError(f"{p.record.name}: found {count} samples, expected 10 at least")
        raise InputError(
            f"--window {window:g}: found {count} samples in a window of {p.record.name}, expected 10 "
            f"at least, which are {10 * step:.3g} s"
        )
    found = []
    for first in range(0, max(1, len(t) - count // 2), count):
        last = min(len(t) - 1, first + count)
        if last - first < 10:
            continue
        length = max(5, round(interval / step))
        edges = [*range(0, max(1, last - first - length // 2), length), last - first]
        take = slice(first, last + 1)
        cut = tuple(pairwise(edges))
        found.append(Part(p.record.name, t[take], q[take], dq[take], u[take], cut))
    return [_standing(part) if p.input is None else part for part in found]


def _standing(part: Part) -> Part:
    """Take the speed that noise gives joints at rest away: it would tear them loose."""
    dq = part.dq.copy()
    slow = np.abs(dq) < 0.01 * np.abs(dq).max(axis=0)
    dq[slow] = 0.0
    return replace(part, dq=dq)
