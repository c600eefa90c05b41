"""Columns of a regressor, filtered and decimated by C that is compiled for this machine."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.native.lanes import LANES, plain_text
from modelgen.native.library import shared_library
from modelgen.numeric import Array, Complex

LARGEST = 1e5  # rad, up to which sine and cosine are exact


class Columns:
    """Columns made of numbers that every sample has, through a filter that is evaluated at kept samples.

    count: of the columns.
    """

    def __init__(self, text: str, count: int) -> None:
        self.text, self.count = text, count
        self._libraries: dict[int, ctypes.CDLL] = {}
        self._local = threading.local()

    @staticmethod
    def fit(q: Array) -> bool:
        """Whether sine and cosine of these coordinates are exact."""
        return bool(max(-q.min(), q.max()) <= LARGEST)

    def values(self, inputs: Sequence[Array]) -> Array:
        """Columns (N, c) at all samples. inputs: the numbers (N, k), in several parts.

        Raises RuntimeError where it cannot be compiled.
        """
        library, (x, samples, table) = self._library(1), _pointers(inputs)
        out = np.empty((samples, self.count))
        row = self._memory("row", self.count * LANES)
        library.evaluate(x, ctypes.c_long(samples), _at(row), _at(out))
        del table  # until here: the library reads it
        return out

    def filtered(
        self,
        inputs: Sequence[Array],
        *,
        first: int,
        factor: int,
        steps: int,
        poles: Complex,
        gains: Complex,
        direct: float,
        begin: int,
        ahead: Complex,
        after: int,
        behind: Complex,
        inner: Complex,
    ) -> Array:
        """Filtered columns (steps + 1, c) at the samples first, first + factor, ...

        inputs: the numbers (N, k), in several parts. The rest: fields of
        modelgen.dataset.decimation.Decimation. Raises RuntimeError where it cannot be compiled.
        """
        m, c = len(poles), self.count
        library, (x, samples, table) = self._library(m), _pointers(inputs)
        scratch = self._memory("scratch", library.scratch_size() // 8)

        def sums(place: NDArray[np.int_], weights: Array) -> tuple[Array, Array]:
            """Sums (c, 4 m, lanes) and last columns (c, lanes) of pieces from `place` (lanes,) on."""
            at = np.ascontiguousarray(place, dtype=np.int_)
            library.add_up(
                x, ctypes.c_long(samples), _at(at), ctypes.c_long(len(weights)), _at(weights), _at(scratch)
            )
            even = c + c % 2
            start = 16 * even * LANES
            found = scratch[start : start + even * 4 * m * LANES].reshape(even, 4 * m, LANES)[:c]
            start += even * 4 * m * LANES
            return found, scratch[start : start + c * LANES].reshape(c, LANES)

        def end(start: int, given: Complex) -> Array:
            """Sums over an end of the record (c, m, 2)."""
            piece = -(-len(given) // LANES)
            spread = np.zeros((LANES, piece, m, 2))
            spread.reshape(-1, m, 2)[: len(given)] = np.stack([given.real, given.imag], axis=2)
            weights = np.zeros((piece, 4 * m, LANES))
            weights[:, : 2 * m] = spread.reshape(LANES, piece, 2 * m).transpose(1, 2, 0)
            found, _ = sums(start + piece * np.arange(LANES), weights)
            return np.ascontiguousarray(found[:, : 2 * m].sum(axis=2)).reshape(c, m, 2)

        head, tail = end(begin, ahead), end(after, behind)
        _, here = sums(np.full(LANES, first), np.zeros((1, 4 * m, LANES)))
        out = np.empty((steps + 1, c))
        out[0] = direct * here[:, 0] + (head @ [1, 1j] @ gains).real
        length = steps // LANES + 1
        turn = poles**factor
        slowest = float(np.max(np.abs(turn)))
        fading = min(length, int(np.ceil(np.log(1e-20) / np.log(slowest))))
        weights = np.repeat(_pairs(inner).reshape(factor, 4 * m)[:, :, None], LANES, axis=2)
        work, y = self._memory("work", length * c * 2 * m * LANES), self._memory("y", length * c * LANES)
        library.filtered(
            x,
            ctypes.c_long(samples),
            ctypes.c_long(first),
            ctypes.c_long(factor),
            ctypes.c_long(steps),
            _at(weights),
            ctypes.c_double(direct),
            _at(kept := _pairs(turn)),
            _at(own := _pairs(gains)),
            _at(far := _pairs(turn**length)),
            _at(head),
            _at(tail),
            ctypes.c_long(fading),
            _at(scratch),
            _at(work),
            _at(y),
            _at(out),
        )
        del kept, own, far, table  # until here: the library reads them
        return out

    def _memory(self, name: str, size: int) -> Array:
        """Doubles (size,), the first on a vector's boundary; kept from call to call: its pages are there."""
        block: Array | None = getattr(self._local, name, None)
        if block is None or len(block) < size + LANES:
            block = np.empty(size + LANES)
            setattr(self._local, name, block)
        skipped = -(block.ctypes.data // 8) % LANES
        return block[skipped : skipped + size]

    def _library(self, modes: int) -> ctypes.CDLL:
        if modes not in self._libraries:
            text = f"{self.text}enum {{ MODES = {modes} }};\n{_source()}"
            library = shared_library({"columns.c": text}, "columns.c", fast=True)
            library.scratch_size.restype = ctypes.c_long
            library.evaluate.restype = library.add_up.restype = library.filtered.restype = None
            self._libraries[modes] = library
        return self._libraries[modes]


@cache
def plain_columns(count: int) -> Columns:
    """Columns as they are given."""
    return Columns(plain_text(count), count)


@cache
def _source() -> str:
    return Path(__file__).with_name("decimate.c").read_text(encoding="utf-8")


def _pointers(inputs: Sequence[Array]) -> tuple[ctypes.Array[ctypes.c_void_p], int, list[Array]]:
    """Addresses of each number's samples, how many samples there are, and the arrays that hold them."""
    table = [np.ascontiguousarray(part.T, dtype=np.float64) for part in inputs]
    samples = table[0].shape[1]
    places = [part.ctypes.data + 8 * samples * k for part in table for k in range(len(part))]
    return (ctypes.c_void_p * len(places))(*places), samples, table


def _pairs(values: Complex) -> Array:
    """Real and imaginary parts side by side."""
    return np.ascontiguousarray(np.stack([values.real, values.imag], axis=-1))


def _at(x: NDArray[np.generic]) -> ctypes.c_void_p:
    return ctypes.c_void_p(x.ctypes.data)
