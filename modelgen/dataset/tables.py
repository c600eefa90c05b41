"""Named columns of numbers, whatever file they come from: the header, then blocks of rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from modelgen.dataset import csv_table
from modelgen.dataset.objects import Array
from modelgen.dataset.specs import Spec
from modelgen.errors import InputError


class Reader(Protocol):
    """A file with named columns."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns, in the file's order; doubled ones as often as they stand there."""

    def blocks(self, wanted: tuple[str, ...], rows: int) -> Iterator[Array]:
        """The wanted columns (rows at most, len(wanted)), block after block. Raises InputError."""


@dataclass(frozen=True)
class Table:
    """Columns of the part of a file that a Spec names."""

    spec: Spec
    reader: Reader
    time: str = "t"


def open_table(path: Path) -> Reader:
    """The reader for a file, by its suffix. Raises InputError."""
    suffix = path.suffix.lower()
    if suffix in (".csv", ".txt", ".tsv", ""):
        return csv_table.CsvReader(path)
    raise InputError(f"{path}: found a log of the kind '{suffix}', expected .csv")
