"""A zero-phase low-pass filter that is evaluated at the kept samples alone.

A Butterworth filter run forwards and backwards has the impulse response

    h(k) = sum over its poles p of r H(1/p) p^abs(k), and a small direct part at k = 0,

r the residue of the filter H at p: partial fractions of H(z) H(1/z) (Oppenheim and Schafer 2010, sections
3.3 and 5.6). What lies before a sample and what lies after it are then sums weighted by powers of the
poles, which go from kept sample to kept sample by one multiplication: nothing is computed for the samples
that decimation throws away. The ends of the record are those of scipy.signal.sosfiltfilt: an odd extension,
constant beyond it.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy import signal

from modelgen.dataset.processing.filters import low_pass, reach
from modelgen.native import compiler, plain_columns
from modelgen.numeric import Array, Complex

WIDTHS = (2, 4, 8)  # columns that compiled C takes together, the same sums in each
FEWEST = 4  # decimation from which this is worth it
NOTHING = 1e-18  # weights below this part of the largest are left out


@dataclass(frozen=True)
class Decimation:
    """The filter at the J + 1 samples `first`, `first` + factor, ... of N.

    poles: (m,), of each conjugate pair one; gains: (m,) their r H(1/p), doubled for a pair; direct: what the
    sample itself adds. ahead: (S, m), weights by which the samples `begin` to `begin` + S make the sums
    before the first kept sample, itself included; behind: (S', m), likewise from `after` on, the sums after
    the last one, itself excluded. inner: (factor, 2 m), what a sample of the `factor` ones after a kept
    sample, the next kept one included, adds to that one's sums before it and to the other's after it.
    """

    first: int
    factor: int
    steps: int
    poles: Complex
    gains: Complex
    direct: float
    begin: int
    ahead: Complex
    after: int
    behind: Complex
    inner: Complex

    def __call__(self, columns: Array) -> Array:
        """Columns (N, k) at the kept samples (J + 1, k); one that is not finite somewhere comes as NaN."""
        if compiler() is not None:
            with suppress(RuntimeError):  # a compiler that knows no vectors, say
                return self._compiled(columns)
        with np.errstate(invalid="ignore", over="ignore"):
            return self._filtered(columns)

    def _compiled(self, columns: Array) -> Array:
        table = np.ascontiguousarray(columns.T, dtype=np.float64)
        result = np.empty((self.steps + 1, len(table)))
        for k in range(0, len(table), WIDTHS[-1]):
            part = table[k : k + WIDTHS[-1]]
            width = next(w for w in WIDTHS if w >= len(part))
            spare = [part[-1:].T] * (width - len(part))  # fills up what is compiled
            found = plain_columns(width).filtered([part.T, *spare], **vars(self))
            result[:, k : k + width] = found[:, : len(part)]
        return result

    def _filtered(self, columns: Array) -> Array:
        m, k = len(self.poles), columns.shape[1]
        rows = columns[self.first : self.first + self.steps * self.factor + 1]
        before, after = np.empty((2, m, self.steps + 1, k), dtype=np.complex128)
        before[:, 0] = _weighted(self.ahead, columns[self.begin : self.begin + len(self.ahead)])
        after[:, -1] = _weighted(self.behind, columns[self.after : self.after + len(self.behind)])
        pieces = np.ascontiguousarray(rows[1:]).reshape(self.steps, self.factor, k)
        table = np.concatenate([self.inner.real, self.inner.imag], axis=1).T
        sums = np.matmul(table, pieces)
        result = self.direct * rows[:: self.factor]
        for i, (pole, gain) in enumerate(zip(self.poles**self.factor, self.gains, strict=True)):
            before[i, 1:] = sums[:, i] + 1j * sums[:, 2 * m + i]
            after[i, :-1] = sums[:, m + i] + 1j * sums[:, 3 * m + i]
            carried = signal.lfilter([1.0], [1.0, -pole], before[i], axis=0)
            carried += signal.lfilter([1.0], [1.0, -pole], after[i, ::-1], axis=0)[::-1]
            result += (gain * carried).real
        return np.asarray(result)


def _weighted(weights: Complex, columns: Array) -> Complex:
    return np.asarray(weights.real.T @ columns + 1j * (weights.imag.T @ columns))


def decimation(count: int, rows: np.ndarray, cutoff: float, rate: float, order: int) -> Decimation | None:
    """The filter of `filters.low_pass` at `rows` of `count` samples; None where it is no gain.

    That is without a filter, with little decimation, for rows that are not evenly spaced, and in records
    shorter than the filter's memory.
    """
    if not cutoff or len(rows) < 2 or rows[1] - rows[0] < FEWEST or np.ptp(np.diff(rows)):
        return None
    if reach(cutoff, rate, order, 1e-6) > count - 1:
        return None
    return _made(count, int(rows[0]), int(rows[1] - rows[0]), len(rows) - 1, cutoff, rate, order)


def kept(columns: Array, rows: np.ndarray, cutoff: float, rate: float, order: int) -> Array:
    """Columns (N, k) low-passed, at the `rows` (M,) alone: (M, k)."""
    made = decimation(len(columns), rows, cutoff, rate, order)
    if made is not None and columns.shape[1]:
        return made(columns)
    return np.asarray((low_pass(columns, cutoff, rate, order) if cutoff else columns)[rows])


@lru_cache(maxsize=16)
def _made(
    count: int, first: int, factor: int, steps: int, cutoff: float, rate: float, order: int
) -> Decimation:
    zeros, poles, gain = signal.butter(order, cutoff, fs=rate, output="zpk")
    # H = constant + sum of residues / (1 - p / z), in w = 1 / z.
    constant = gain * np.prod(zeros / poles).real
    residues = np.array(
        [gain * np.prod(1 - zeros / p) / np.prod(1 - np.delete(poles, i) / p) for i, p in enumerate(poles)]
    )
    mirrored = np.array([gain * np.prod(1 - zeros * p) / np.prod(1 - poles * p) for p in poles])
    upper = poles.imag > 1e-12 * np.abs(poles)
    one = upper | (np.abs(poles.imag) <= 1e-12 * np.abs(poles))
    p = poles[one]
    c = (residues * mirrored)[one] * np.where(upper[one], 2.0, 1.0)
    padding = min(count - 1, reach(cutoff, rate, order, 1e-6))
    last = first + steps * factor
    begin, ahead = _end(p, first, padding)
    far, behind = _end(p, count - 1 - last, padding)
    behind = behind[::-1]
    # The last kept sample is counted once, by the sums before it.
    behind[len(behind) - 1 + far - (count - 1 - last)] -= 1.0
    inside = np.arange(1, factor + 1)[:, None]
    inner = np.concatenate([p ** (factor - inside), p**inside], axis=1)
    after = count - far - len(behind)
    return Decimation(first, factor, steps, p, c, constant * gain, begin, ahead, after, behind, inner)


def _end(p: Complex, place: int, padding: int) -> tuple[int, Complex]:
    """Weights of the sums up to `place`, itself included, over a record's beginning and its odd extension.

    Returns the first sample that counts, and the weights (S, m) from there on.
    """
    weights = np.zeros((max(place, padding) + 1, len(p)), dtype=np.complex128)
    weights[: place + 1] = p ** np.arange(place, -1, -1)[:, None]
    mirrored = p ** (place + np.arange(1, padding + 1))[:, None]
    weights[1 : padding + 1] -= mirrored
    beyond = p ** (place + padding + 1) / (1 - p)
    weights[0] += 2 * mirrored.sum(axis=0) + 2 * beyond
    weights[padding] -= beyond
    counts = np.flatnonzero(np.abs(weights).max(axis=1) > NOTHING)
    return int(counts[0]), weights[counts[0] :]
