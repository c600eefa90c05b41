"""Pictures to be drawn later, or by another process while this one goes on."""

from __future__ import annotations

import multiprocessing
from collections.abc import Mapping
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any

import numpy as np

from modelgen.figures import figure, svg
from modelgen.jobs import Where, ignore_interrupt


@dataclass(frozen=True)
class Sketch:
    """A figure of `size` [inch] with rows x columns axes. calls: what they are told: row, column, method."""

    rows: int
    columns: int
    size: tuple[float, float]
    calls: list[tuple[int, int, str, tuple[Any, ...], dict[str, Any]]] = field(default_factory=list)

    def axes(self) -> Any:
        """Stand-ins of the axes as a rows x columns array; they return nothing."""
        made = np.empty((self.rows, self.columns), dtype=object)
        for row in range(self.rows):
            for column in range(self.columns):
                made[row, column] = _Axes(self, row, column)
        return made

    def drawn(self) -> str:
        """The picture as SVG text."""
        made, axes = figure(self.rows, self.columns, self.size)
        for row, column, method, args, named in self.calls:
            getattr(axes[row, column], method)(*args, **named)
        return svg(made)


class _Axes:
    """Notes down what axes are told."""

    def __init__(self, sketch: Sketch, row: int, column: int) -> None:
        self._place = sketch, row, column

    def __getattr__(self, method: str) -> Any:
        sketch, row, column = self._place

        def note(*args: Any, **named: Any) -> None:
            sketch.calls.append((row, column, method, args, named))

        return note


class Pen:
    """Draws sketches: in processes of its own where there are processors for it, else when they are fetched.

    hands: how many such processes to start; they load what they need at once, before the first sketch comes.
    """

    def __init__(self, hands: int = 0) -> None:
        self._sketches: dict[str, Sketch] = {}
        self._drawn: dict[str, Future[str]] = {}
        self._pool: ProcessPoolExecutor | None = None
        if hands and Where().count(2) > 1:
            # a fork would inherit the locks of this process's threads
            context = multiprocessing.get_context("spawn")
            with suppress(OSError, NotImplementedError):  # no process to be had: as without one
                pool = ProcessPoolExecutor(hands, mp_context=context, initializer=ignore_interrupt)
                for _ in range(hands):
                    pool.submit(Sketch(1, 1, (1.0, 1.0)).drawn)
                self._pool = pool

    def __enter__(self) -> Pen:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._pool is not None:
            # not waited for, it may write a traceback of its own as this process ends (CPython 3.11)
            self._pool.shutdown(wait=True, cancel_futures=True)

    def give(self, sketches: Mapping[str, Sketch]) -> None:
        """Sketches to draw, by name; not again those whose name it was given before."""
        new = {name: sketch for name, sketch in sketches.items() if name not in self._sketches}
        self._sketches.update(new)
        if self._pool is not None:
            with suppress(BrokenProcessPool):
                for name, sketch in new.items():
                    self._drawn[name] = self._pool.submit(sketch.drawn)

    def fetch(self, name: str) -> str:
        """The SVG text of a sketch, the same wherever it was drawn."""
        if name in self._drawn:
            with suppress(BrokenProcessPool):  # no memory for it, or ended by someone
                return self._drawn[name].result()
        return self._sketches[name].drawn()
