"""Results that are made once and remembered for a while."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

import numpy as np

from modelgen.evaluation.motion import Motion
from modelgen.numeric import Array

T = TypeVar("T")


class Recent(Generic[T]):
    """The results that were made last, by key. functools.lru_cache could not be sent to other processes."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._found: dict[Hashable, tuple[object, T]] = {}

    def __call__(self, key: Hashable, make: Callable[[], T], held: object = None) -> T:
        """Result of `make`. held: object that is kept with it, where the key is its place in memory alone."""
        if key not in self._found:
            if len(self._found) >= self._most:
                del self._found[next(iter(self._found))]
            self._found[key] = held, make()
        return self._found[key][1]

    def along(self, what: Hashable, motion: Motion, parameters: Array, make: Callable[[], T]) -> T:
        """Result for a motion and parameters."""
        return self((what, id(motion), np.asarray(parameters).tobytes()), make, motion)
