"""Parts of records that are held out in turn."""

from __future__ import annotations


def blocks(length: int, count: int) -> list[tuple[int, int]]:
    """Begin and end of `count` consecutive blocks, equal to within one, of `length` rows."""
    return [(length * k // count, length * (k + 1) // count) for k in range(count)]


def groups(records: int, most: int) -> list[list[int]]:
    """Records (numbers from 0) to hold out together: each alone, or every other one where there are more
    than `most`.
    """
    every = list(range(records))
    return [[i] for i in every] if records <= most else [every[k::2] for k in range(2)]
