"""Curves as the data of SVG paths: whole tenths of a pixel, each point from the one before."""

from __future__ import annotations

import numpy as np

from modelgen.numeric import Array

MOST = 2400  # points of a curve; of more, the least and the largest of equal parts are drawn


def line(x: Array, y: Array) -> str:
    """A line through the points (N,) [pixel], broken where one is not finite."""
    x, y = thinned(x, y)
    known = np.isfinite(x) & np.isfinite(y)
    if not known.any():
        return ""
    a, b = (np.where(known, np.rint(10.0 * np.nan_to_num(v)), 0.0).astype(np.int64) for v in (x, y))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(np.int8)))
    parts = []
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        steps = np.stack([np.diff(a[begin:end]), np.diff(b[begin:end])], axis=1)
        moved = " ".join(f"{dx} {dy}" for dx, dy in steps[steps.any(axis=1)].tolist()) or "0 0"
        parts.append(f"M{a[begin]} {b[begin]}l{moved.replace(' -', '-')}")
    return "".join(parts)


def dots(x: Array, y: Array) -> str:
    """Points (N,) [pixel] as lines of no length, which round ends make dots."""
    known = np.isfinite(x) & np.isfinite(y)
    places = np.rint(10.0 * np.stack([x[known], y[known]], axis=1)).astype(np.int64)
    return "".join(f"M{a} {b}h0" for a, b in places.tolist())


def thinned(x: Array, y: Array, most: int = MOST) -> tuple[Array, Array]:
    """At most that many points; of each of equal parts its least and its largest, so that no peak is lost."""
    if len(x) <= most:
        return x, y
    kept = []
    for part in np.array_split(np.arange(len(x)), most // 2):
        finite = part[np.isfinite(y[part])]
        if len(finite) < len(part):
            kept.append(part[~np.isfinite(y[part])][:1])
        if len(finite):
            kept.append(finite[[np.argmin(y[finite]), np.argmax(y[finite])]])
    rows = np.unique(np.concatenate(kept))
    return x[rows], y[rows]
