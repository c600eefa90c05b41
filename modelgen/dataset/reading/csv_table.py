"""CSV logs: one header line of names, then lines of numbers, read block by block."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from modelgen.dataset.reading.specs import unreadable
from modelgen.description.document import one_line
from modelgen.errors import InputError, Location
from modelgen.numeric import Array


class CsvReader:
    """A CSV file. The separator is a comma, semicolon, tab or blanks, whichever the header holds.

    Lines that begin with # and empty lines are skipped. Raises InputError where there is no header.
    """

    by_column = False

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open(encoding="utf-8-sig", newline=None) as stream:
                self.header_line, header = next(
                    (
                        (n, line)
                        for n, line in enumerate(islice(stream, 1000), 1)
                        if line.strip() and not line.startswith("#")
                    ),
                    (0, ""),
                )
        except OSError as error:
            raise unreadable(path, error) from None
        except UnicodeDecodeError:
            raise InputError(f"{path}: found bytes that are no UTF-8 text, expected a CSV log") from None
        if not header.strip():
            raise InputError(
                f"{path}: the log is empty, expected a header such as t,q1,i1 and one line per sample"
            )
        self.separator = next((s for s in (",", ";", "\t") if s in header), None)
        words = header.split(self.separator)
        self.names = tuple(word.strip().strip('"').strip() for word in words)
        if all(_number(name) is not None for name in self.names):
            where = Location(str(path), self.header_line, 1)
            raise InputError(
                "found numbers in the first line, expected the names of the columns: t,q1,i1", where
            )

    def blocks(self, wanted: tuple[str, ...], rows: int) -> Iterator[Array]:
        """The wanted columns, block after block. Raises InputError with the place of a bad cell."""
        indices = [self.names.index(name) for name in wanted]
        line = self.header_line
        # What is no UTF-8 becomes a lone surrogate, which no number holds: the cell is then found.
        with self.path.open(encoding="utf-8-sig", errors="surrogateescape", newline=None) as stream:
            for _ in range(self.header_line):
                next(stream)
            while lines := list(islice(stream, rows)):
                try:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")  # an empty block at the end
                        block = np.loadtxt(
                            lines, delimiter=self.separator, usecols=indices, ndmin=2, comments="#"
                        )
                except ValueError:
                    raise self._bad_cell(lines, line, indices) from None
                line += len(lines)
                if block.size:
                    yield block

    def _bad_cell(self, lines: list[str], before: int, indices: list[int]) -> InputError:
        """The first cell that is no number."""
        for number, line in enumerate(lines, before + 1):
            text = line.split("#")[0]
            if any("\udc80" <= c <= "\udcff" for c in text):
                return InputError("found bytes that are no UTF-8 text", Location(str(self.path), number, 1))
            if not text.strip():
                continue
            cells = text.rstrip("\r\n").split(self.separator)
            if len(cells) <= max(indices):
                where = Location(str(self.path), number, 1)
                return InputError(
                    f"found {len(cells)} cells, expected {len(self.names)}: {', '.join(self.names)}", where
                )
            for index in indices:
                if _number(cells[index]) is None:
                    column = len((self.separator or " ").join(cells[:index])) + (2 if index else 1)
                    where = Location(str(self.path), number, column)
                    cell = one_line(cells[index]) or "nothing"
                    return InputError(
                        f"found '{cell}' in the column {self.names[index]}, expected a number", where
                    )
        return InputError(f"{self.path}: cannot be read as numbers")


def _number(text: str) -> float | None:
    try:
        return float(text.strip().strip('"'))
    except ValueError:
        return None
