"""How a long function says how far it is."""

from __future__ import annotations

from collections.abc import Callable

# What is done now, how much of it is done, of how much in all; None where that is not known.
Progress = Callable[[str, float, float | None], None]


def silent(text: str, done: float, total: float | None) -> None:
    """Progress that nobody looks at."""
