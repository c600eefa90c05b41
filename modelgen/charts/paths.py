"""Curves as the data of SVG paths: whole tenths of a pixel, each point from the one before."""

from __future__ import annotations

import numpy as np

from modelgen.numeric import Array

TRIANGLES = ("after", "law")  # roles whose points lie among the dots of another
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


def dots(x: Array, y: Array, role: str = "") -> str:
    """Points (N,) [pixel], each with the mark of its role."""
    known = np.isfinite(x) & np.isfinite(y)
    places = np.rint(10.0 * np.stack([x[known], y[known]], axis=1)).astype(np.int64)
    return "".join(mark(role, a, b) for a, b in places.tolist())


def mark(role: str, x: float, y: float, pixel: float = 10.0) -> str:
    """A point at a place, in units of which a pixel has so many: a triangle for what is no dot in grey
    too, else a line of no length, which round ends make a dot.
    """
    if role not in TRIANGLES:
        return f"M{x:.9g} {y:.9g}h0"
    return f"M{x:.9g} {y - 3.3 * pixel:.9g}l{2.9 * pixel:g} {5.0 * pixel:g}h{-5.8 * pixel:g}z"


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
