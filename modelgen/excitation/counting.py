"""How far starts are that run in processes of this machine: an iteration adds a byte to its start's file."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory

# Starts that are done, iterations that are done in all, and of how many.
Progress = Callable[[int, int, int], None]
_EVERY = 0.5  # s between two looks at the files


class Counts:
    """Iterations of every start, of at most so many each. folder: of their files, None where nobody asks."""

    def __init__(self, starts: int, most: int, folder: Path | None) -> None:
        self._most, self._folder = most, folder
        self._done = [False] * starts

    def file(self, start: int) -> str:
        """Path that the process of a start writes to; empty where nobody asks."""
        return "" if self._folder is None else str(self._folder / str(start))

    def ended(self, start: int) -> None:
        """All iterations of a start count as done, however many it took."""
        self._done[start] = True

    def now(self) -> tuple[int, int, int]:
        """What Progress is called with."""
        counts = [self._most if done else min(self._size(k), self._most) for k, done in enumerate(self._done)]
        return sum(self._done), sum(counts), self._most * len(counts)

    def _size(self, start: int) -> int:
        with suppress(OSError):  # the start has not begun
            return Path(self.file(start)).stat().st_size
        return 0


@contextmanager
def counted(starts: int, most: int, progress: Progress | None) -> Iterator[Counts]:
    """Calls `progress` now and then, from a thread of its own, until the starts are done.

    most: iterations of one start. Processes of other machines write nothing: of them whole starts count.
    """
    if progress is None:
        yield Counts(starts, most, None)
        return
    with TemporaryDirectory() as folder:
        counts, stopped = Counts(starts, most, Path(folder)), threading.Event()

        def look() -> None:
            while not stopped.wait(_EVERY):
                progress(*counts.now())

        thread = threading.Thread(target=look, daemon=True)
        thread.start()
        try:
            yield counts
        finally:
            stopped.set()
            thread.join()
        progress(*counts.now())


def one_more(file: str) -> None:
    """An iteration is done. file: of Counts, empty for none."""
    if not file:
        return
    with suppress(OSError):  # a machine without that folder
        place = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        os.write(place, b".")
        os.close(place)
