"""The place where jobs run."""

from __future__ import annotations

import os
from dataclasses import dataclass


@dataclass(frozen=True)
class Where:
    """processes: of this machine, None for one per processor. dask: address of a scheduler that has the
    work instead, tcp://host:8786 say.
    """

    processes: int | None = None
    dask: str | None = None

    def count(self, jobs: int) -> int:
        """Processes of this machine that `jobs` jobs are worth."""
        return max(1, min(self.processes or _available(), jobs))


HERE = Where(1)  # in this process alone


def _available() -> int:
    """Processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # macOS, Windows
        return os.cpu_count() or 1
