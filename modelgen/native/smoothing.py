"""Filtered columns and their derivatives by C that is compiled for this machine."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.native.library import compiler, shared_library
from modelgen.numeric import Array

LANES = 8
SECTIONS = 8  # at most


def both_ways(columns: Array, sos: Array, states: Array, padding: int) -> Array | None:
    """Columns (N, k) forwards and backwards through sections (s, 6), as scipy.signal.sosfiltfilt does it.

    states: (s, 2) for a constant input of 1 (scipy.signal.sosfilt_zi). None where it cannot be compiled.
    """
    library = _library()
    if library is None or len(sos) > SECTIONS:
        return None
    x = np.ascontiguousarray(columns.T, dtype=np.float64)
    sos, states = np.ascontiguousarray(sos), np.ascontiguousarray(states)
    out, samples = np.empty_like(x), x.shape[1]
    work = np.empty((samples + 2 * padding, LANES))
    sizes = [ctypes.c_long(v) for v in (samples, padding, len(sos))]
    for k in range(0, len(x), LANES):
        part = x[k : k + LANES]
        count = ctypes.c_long(len(part))
        library.both_ways(_at(part), count, *sizes, _at(sos), _at(states), _at(work), _at(out[k:]))
    return out.T


def central(columns: Array, first: Sequence[float], second: Sequence[float]) -> tuple[Array, Array] | None:
    """Sums of first[k-1] (x[i+k] - x[i-k]) and of second[k-1] (x[i+k] - 2 x[i] + x[i-k]) of columns (N, k).

    The outermost samples repeat their neighbours'. None where it cannot be compiled.
    """
    library = _library()
    if library is None:
        return None
    x = np.ascontiguousarray(columns.T, dtype=np.float64)
    d, dd = np.empty_like(x), np.empty_like(x)
    one, two = np.array(first), np.array(second)
    sizes = [ctypes.c_long(v) for v in (*x.shape, len(one))]
    library.central(_at(x), *sizes, _at(one), _at(two), _at(d), _at(dd))
    return d.T, dd.T


@cache
def _library() -> ctypes.CDLL | None:
    if compiler() is None:
        return None
    text = Path(__file__).with_name("smooth.c").read_text(encoding="utf-8")
    try:
        library = shared_library({"smooth.c": text}, "smooth.c", fast=True)
    except RuntimeError:
        return None
    library.both_ways.restype = library.central.restype = None
    return library


def _at(x: NDArray[np.generic]) -> ctypes.c_void_p:
    return ctypes.c_void_p(x.ctypes.data)
