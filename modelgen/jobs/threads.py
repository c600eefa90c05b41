"""Linear algebra by one thread."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits


@contextmanager
def one_thread() -> Iterator[None]:
    """Within it, or in a function that it decorates, linear algebra has one thread in this process and its
    forks: several fight over the processors that forks are on, and their sums differ in the last digits.
    """
    with threadpool_limits(1):
        yield
