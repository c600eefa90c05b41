"""Columns whose names are those of docs/logs.md in capitals: T, Q1, TAU1."""

from __future__ import annotations

from collections.abc import Iterator

from modelgen.dataset.objects import Reader
from modelgen.dataset.reading.signals import is_signal
from modelgen.numeric import Array


class Lowered:
    """A reader under names in small letters."""

    def __init__(self, reader: Reader) -> None:
        self.reader, self.by_column = reader, reader.by_column
        self._original = {name.lower(): name for name in reader.names}
        self.names = tuple(name.lower() for name in reader.names)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Of the reader, and that names were changed."""
        return ("names of columns are read in small letters", *self.reader.remarks)

    def blocks(self, wanted: tuple[str, ...], rows: int) -> Iterator[Array]:
        """The wanted columns, block after block."""
        return self.reader.blocks(tuple(self._original[name] for name in wanted), rows)


def in_small_letters(reader: Reader) -> Reader:
    """The reader, under names in small letters where its own are those of the contract in capitals.

    Certain only where all of them are, the time included, and none comes twice.
    """
    names = reader.names
    lower = [name.lower() for name in names]
    capital = [name for name in names if not is_signal(name) and is_signal(name.lower())]
    if "t" in names or "T" not in names or len(capital) < 2 or any(map(is_signal, names)):
        return reader
    return Lowered(reader) if len(set(lower)) == len(lower) else reader
