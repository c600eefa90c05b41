"""CSV logs: a header of names, then rows of numbers, read block by block, each with a cell for every name."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from modelgen.dataset.objects import Layout, Wanted
from modelgen.dataset.reading.pipes import plain_file
from modelgen.dataset.reading.shape import Shape, shape_of, wrong_count
from modelgen.dataset.reading.specs import unreadable
from modelgen.dataset.reading.text import cells_of, lines_of, moment, number
from modelgen.dataset.reading.turns import in_turn
from modelgen.description.document import one_line
from modelgen.errors import InputError, Location
from modelgen.numeric import Array

_CLOCK = re.compile(r"\d[:./-]\d+[:./-]\d")


class CsvReader:
    """A table in a text file, whose shape follows from its first lines.

    Lines that begin with # and empty lines are skipped. Raises InputError where there is no header, and where
    the shape is uncertain.
    """

    by_column = False

    def __init__(self, path: Path, layout: Layout | None = None) -> None:
        self.path = path
        try:
            self._file = plain_file(path)
        except (OSError, ValueError) as error:
            raise unreadable(path, error) from None
        self.shape: Shape = shape_of(path, self._file, layout or Layout())
        self.names = self.shape.names
        self.units = self.shape.units
        self._found: dict[str, None] = dict.fromkeys(self.shape.remarks)

    @property
    def origins(self) -> dict[str, float]:
        """What columns of dates count from [s since 1970, UTC]."""
        return {self.names[k]: date.timestamp() for k, date in self.shape.dates.items()}

    @property
    def origin(self) -> float:
        """What the column t counts from, the same."""
        return self.origins.get("t", 0.0)

    @property
    def sparse(self) -> bool:
        """Whether columns are blank in many rows."""
        return bool(self.shape.sparse)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was found out about the file, and assumed."""
        return tuple(self._found)

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns, block after block. Raises InputError with the place of a bad cell."""
        indices = [self.names.index(name) for name in wanted.names]
        if self.shape.sparse.intersection(indices):
            # Among rows in turn every channel is blank somewhere, the one that is read most often least.
            blank = frozenset(indices[1:]) if self.shape.seldom.intersection(indices) else self.shape.sparse
            whole = list(self._rows(indices, rows, blank))
            table = np.concatenate(whole) if whole else np.empty((0, len(indices)))
            table, remark = in_turn(str(self.path), wanted, table)
            self._found[remark] = None
            yield from (table[k : k + rows] for k in range(0, len(table), rows))
            return
        yield from self._rows(indices, rows)

    def _rows(self, indices: list[int], rows: int, blank: frozenset[int] = frozenset()) -> Iterator[Array]:
        line = self.shape.header
        with lines_of(self._file, self.shape.encoding) as stream:
            for _ in range(line):
                next(stream)
            held = list(islice(stream, rows))
            while held:
                following = list(islice(stream, rows))
                block = self._fast(held, indices)
                if block is None:
                    block = self._slow(held, line, indices, blank, last=not following)
                line += len(held)
                held = following
                if len(block):
                    yield block

    def _fast(self, lines: list[str], indices: list[int]) -> Array | None:
        """The block where every line is a plain row of numbers; None where it is not."""
        delimiter, width = self.shape.delimiter, len(self.names) + self.shape.trailing
        if delimiter is None:
            even = all(len(line.split()) == width for line in lines)
        else:
            even = all(line.count(delimiter) == width - 1 for line in lines)
        if not even or any('"' in line or "#" in line for line in lines):
            return None
        if self.shape.decimal == ",":
            if any("." in line for line in lines):
                return None
            lines = [line.replace(",", ".") for line in lines]
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return np.loadtxt(lines, delimiter=delimiter, usecols=indices, ndmin=2, comments=None)
        except ValueError:
            return None

    def _slow(
        self, lines: list[str], before: int, indices: list[int], blank: frozenset[int], *, last: bool
    ) -> Array:
        """The block cell by cell. Raises InputError at the first cell that is no number."""
        width = len(self.names)
        found = []
        for k, line in enumerate(lines, before + 1):
            text = line.split("#")[0].rstrip("\r\n")
            if not text.strip():
                continue
            if any("\udc80" <= c <= "\udcff" for c in text):
                raise InputError("found bytes that are no UTF-8 text", Location(str(self.path), k, 1))
            cells = cells_of(text, self.shape.delimiter)
            if self.shape.trailing and len(cells) == width + 1 and not cells[-1]:
                cells.pop()
            if len(cells) != width:
                if last and k == before + len(lines) and not line.endswith("\n") and len(cells) < width:
                    self._found[f"line {k}, the last, is cut off and left out"] = None
                    continue
                raise InputError(
                    wrong_count(len(cells), self.names, "", self.shape.delimiter),
                    Location(str(self.path), k, 1),
                )
            found.append([self._number(cells, text, k, i, blank=i in blank) for i in indices])
        return np.array(found).reshape(len(found), len(indices))

    def _number(self, cells: Sequence[str], text: str, line: int, index: int, *, blank: bool) -> float:
        cell = cells[index]
        begin = self.shape.dates.get(index)
        if begin is not None and (date := moment(cell)) is not None:
            return (date - begin).total_seconds()
        value = number(cell, self.shape.decimal)
        if value is not None and begin is None:
            return value
        if not cell and blank:
            return np.nan
        between = self.shape.delimiter or " "
        raw = text.split(self.shape.delimiter) if '"' not in text else list(cells)
        column = len(between.join(raw[:index])) + (2 if index else 1)
        said = one_line(cell) or "nothing"
        hint = (
            f" (the decimal sign is '{self.shape.decimal}')"
            if "," in cell or self.shape.decimal == ","
            else ""
        )
        expected = f"a number{hint}" if begin is None else "a date, as in the rows before"
        if begin is None and _CLOCK.search(cell):
            expected = "a number, or a date and time such as 2026-03-01T12:00:00.000"
        raise InputError(
            f"found '{said}' in the column {self.names[index]}, expected {expected}",
            Location(str(self.path), line, column),
        )
