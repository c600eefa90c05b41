"""Logs of any length in constant memory: overlapping blocks, processed as the whole would be."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import replace
from functools import cached_property
from pathlib import Path

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.filters import reach
from modelgen.dataset.processing.prepare import Prepared, prepare
from modelgen.dataset.processing.resampling import REACH
from modelgen.dataset.processing.settings import Chosen, Settings, choose
from modelgen.dataset.processing.timing import Axis, Survey
from modelgen.dataset.reading import checks
from modelgen.dataset.reading.clocks import clocks
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.read import channels_of, check_length, record_of
from modelgen.dataset.reading.sources import open_source
from modelgen.dataset.thresholds import USUAL
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array

# What the filters' memory may hold of samples outside of a block. Second derivatives magnify what is
# left in the positions by the square of their cut-off over the motion's frequency.
FORGOTTEN_EFFORT = 1e-12
FORGOTTEN_POSITION = 1e-16
LONGEST_SAMPLE = 1 << 18  # samples that the settings are chosen from


class Stream:
    """A log as a sequence of Prepared blocks.

    Their rows, one block after the other, are those of the whole log prepared at once, and filtered columns
    agree with the whole's to 1e-9 of their size: neighbouring blocks overlap by `overlap` samples. A first
    pass finds the time axis and checks the log; where columns are read one by one (Parquet), only the time
    is read then, and the others are checked block by block. log, mapping: as in `read`. settings: None or
    unset values are chosen from the first quarter million samples. block: samples per block, at least. Raises
    InputError as `read` does. Iterate as often as needed; every iteration reads the file.
    """

    def __init__(
        self,
        log: Log,
        arm: Arm,
        settings: Settings | Chosen | None = None,
        mapping: Path | str | None = None,
        block: int = 16_384,
    ) -> None:
        limits = USUAL if settings is None else settings.thresholds
        self._source = open_source(log, arm, mapping, limits)
        self.spec, self.arm = self._source.spec.text, arm
        self._asked, self._least, self._doubt = settings, block, 0.0
        self.axis = self._survey()
        self.samples = self.axis.count

    def settled(self, settings: Settings | Chosen | None) -> Stream:
        """The same log with other settings, without a further pass over it."""
        result = copy(self)
        for name in ("settings", "overlap", "block"):
            result.__dict__.pop(name, None)
        result._asked = settings
        return result

    def at_instants(self, hold: str | float | None, doubt: float) -> Stream:
        """The same log with its efforts read as `hold` says, None: as before, and how far they may be off
        [sampling periods].
        """
        result = copy(self)
        result.__dict__.pop("beginning", None)
        result._source = self._source if hold is None else replace(self._source, hold=hold)
        result._doubt = doubt
        return result

    @cached_property
    def settings(self) -> Chosen:
        """The settings as used, with every choice made."""
        return choose(self.beginning, self._asked)

    @property
    def remarks(self) -> tuple[str, ...]:
        """For the user."""
        return self.beginning.remarks

    @cached_property
    def overlap(self) -> int:
        """Samples on each side of a block that its filters reach, and that rest is looked for in."""
        return overlap(self.settings, self.axis.step)

    @cached_property
    def block(self) -> int:
        """Samples of a block without its overlap: so many that blocks keep the same of their samples."""
        factor = self.settings.factor
        return -(-max(self._least, 4 * self.overlap) // factor) * factor

    def __len__(self) -> int:
        """Number of blocks."""
        return len(self._begins())

    def __iter__(self) -> Iterator[Prepared]:
        for record in self.records():
            yield prepare(record, self.settings)

    def records(self) -> Iterator[Record]:
        """The blocks before they are processed, overlap included."""
        trim, begins = self.settings.trimmed(self.axis.step), self._begins()
        content = _Content(self)
        rows = _Rows(content.checked(self._source.blocks()), self.axis)
        for number, begin in enumerate(begins, 1):
            end = min(begin + self.block, self.samples - trim)
            low, high = max(0, begin - self.overlap), min(self.samples, end + self.overlap)
            table, t = rows.table(low, high)
            record, _ = record_of(self._source, self.arm, table, self.axis, t)
            name = f"{self.spec} block {number} of {len(begins)}"
            hold_std = self._doubt * record.step
            yield replace(record, name=name, core=(begin - low, end - low), first=low, hold_std=hold_std)
        content.check_changes()

    def _begins(self) -> range:
        """First samples of the blocks, without their overlap."""
        trim = self.settings.trimmed(self.axis.step)
        return range(trim, self.samples - trim, self.block)

    def _survey(self) -> Axis:
        """First pass: running time; the signals too where all columns are read anyway. Raises InputError."""
        limits = self._source.thresholds
        found = Survey(self.spec, self._source.rate, self._source.gap, limits)
        alone = self._source.reader.by_column
        content = _Content(self)
        blocks = self._source.blocks(time_alone=True) if alone else content.checked(self._source.blocks())
        for block in blocks:
            if alone:
                checks.check_finite(self.spec, block[:, 0], ("t",), block, found.count)
            found.add(block[:, 0])
        check_length(self._source, found.count)
        if not alone:
            content.check_changes()
        return found.axis()

    @cached_property
    def beginning(self) -> Record:
        """The beginning of the log, for what is chosen from its content."""
        blocks = _Content(self).checked(self._source.blocks())
        table, t = _Rows(blocks, self.axis).table(0, min(self.samples, LONGEST_SAMPLE))
        self._check_repeats(table)
        return replace(record_of(self._source, self.arm, table, self.axis, t)[0], name=self.spec)

    def _check_repeats(self, table: Array) -> None:
        """Readings must not repeat: rows are used as they are. Raises InputError."""
        source = self._source
        channels = channels_of(source)
        found = clocks(table, channels.positions, channels.efforts, source.thresholds)
        if not found:
            return
        if len(found) == len(source.wanted) - 1:
            which = "every reading"
        elif set(found) <= set(channels.positions):
            which = "a reading of the positions"
        else:
            which = f"a reading of {', '.join(source.wanted[k] for k in sorted(found))}"
        most = max(x.every for x in found.values())
        raise InputError(
            f"{self.spec}: {which} stands there {most:.4g} times, which is not mended in logs "
            "that are read block by block; give a part of it, FILE@t0:t1, or write new readings alone"
        )


class _Content:
    """Contents of a log's columns, block after block."""

    def __init__(self, stream: Stream) -> None:
        self.stream, self.source = stream, stream._source
        self.count = 0
        self.low = np.full(len(self.source.wanted), np.inf)
        self.high = -self.low

    def checked(self, blocks: Iterator[Array]) -> Iterator[Array]:
        """The blocks. Raises InputError where a number is not finite."""
        for block in blocks:
            checks.check_finite(self.stream.spec, block[:, 0], self.source.wanted, block, self.count)
            self.count += len(block)
            self.low = np.minimum(self.low, block.min(axis=0))
            self.high = np.maximum(self.high, block.max(axis=0))
            yield block

    def check_changes(self) -> None:
        """Positions and efforts must change. Raises InputError."""
        span = dict(zip(self.source.wanted, np.stack([self.low, self.high], axis=1), strict=True))
        signals = self.source.signals
        for names, what in ((signals.position, "position"), (signals.effort, "effort")):
            ends = np.stack([span[name] if name else np.zeros(2) for name in names], axis=1)
            checks.check_constant(self.stream.spec, self.stream.arm, names, ends, what, self.count)


class _Rows:
    """Rows of a log in order, the last ones kept while blocks overlap."""

    def __init__(self, blocks: Iterator[Array], axis: Axis) -> None:
        self.blocks, self.axis = blocks, axis
        self.held = np.empty((0, 0))
        self.first = 0  # number of the first held row

    def table(self, low: int, high: int) -> tuple[Array, Array]:
        """Rows (N, k) for the samples low to high (excluded) of the axis, and those samples' times (M,)."""
        t = self.axis.times(low, high)
        if self.axis.method == "none":
            self._read_to(lambda held: self.first + len(held) >= high)
            begin, end = low - self.first, high - self.first
            self._drop(begin)
            return self.held[: end - begin], t
        margin = REACH * self.axis.step
        self._read_to(lambda held: bool(held[-1, 0] > t[-1] + margin))
        begin = max(0, int(np.searchsorted(self.held[:, 0], t[0] - margin)) - REACH)
        self._drop(begin)
        end = int(np.searchsorted(self.held[:, 0], t[-1] + margin)) + REACH
        return self.held[:end], t

    def _read_to(self, enough: Callable[[Array], bool]) -> None:
        while not len(self.held) or not enough(self.held):
            block = next(self.blocks, None)
            if block is None:
                return
            self.held = np.concatenate([self.held, block]) if len(self.held) else block

    def _drop(self, rows: int) -> None:
        self.held = self.held[rows:]
        self.first += rows


def overlap(settings: Chosen, step: float) -> int:
    """Samples on each side of a block that its filters reach, and that rest is looked for in."""
    rate = 1.0 / step
    samples = settings.half_width + 4 + round(settings.rest_time * rate)
    if settings.cutoff:
        samples += reach(settings.cutoff, rate, settings.order, FORGOTTEN_EFFORT)
    if settings.position_cutoff:
        samples += reach(settings.position_cutoff, rate, settings.position_order, FORGOTTEN_POSITION)
    return samples
