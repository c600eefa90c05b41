"""A case is drawn again until the hidden thing has the size that is asked for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from blind.case import Case

MET = 0.1  # share of s - 1 to which an arm is taken


def check_asked(kind: str, kinds: Sequence[str], size: float | None) -> None:
    """Raises ValueError for a kind that is none of these, or a size of at most 1."""
    if kind not in kinds:
        raise ValueError(f"unknown kind {kind!r}: one of {', '.join(kinds)}")
    if size is not None and size <= 1:
        raise ValueError("a size is above 1")


def first_met(drawn: Iterable[Case | None], size: float | None) -> Case | None:
    """The first case of this size, any where none is asked for; else the nearest; None of none.

    drawn: None for an arm that runs away, or has no place for the effect.
    """
    best: Case | None = None
    for case in drawn:
        if case is None:
            continue
        got = case.truth.size
        if size is None or got is None or abs(got - size) < MET * (size - 1):
            return case
        if best is None or abs(got - size) < abs((best.truth.size or 0) - size):
            best = case
    return best
