"""Columns whose names are those of docs/logs.md in capitals, or with their unit: T, Q1; t [s], q1 (rad)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from modelgen.dataset.objects import Reader, Wanted
from modelgen.dataset.reading.signals import is_signal
from modelgen.numeric import Array

_WITH_UNIT = re.compile(r"\s*(\w+)\s*[\[(<]\s*([^\[\]()<>]+?)\s*[\])>]\s*")


class Renamed:
    """A reader under other names. names: the original one by the new one, in the file's order. units: what
    the original names say, by new name.
    """

    def __init__(
        self, reader: Reader, names: Mapping[str, str], remark: str, units: Mapping[str, str]
    ) -> None:
        self.reader, self.by_column = reader, reader.by_column
        self._original, self._remark = dict(names), remark
        self.names = tuple(names)
        said: Mapping[str, str] = getattr(reader, "units", {})
        self.units = {new: said[old] for new, old in names.items() if old in said} | dict(units)

    @property
    def instants(self) -> frozenset[str]:
        """Names of the columns that are dates or times."""
        there = getattr(self.reader, "instants", ())
        return frozenset(new for new, old in self._original.items() if old in there)

    @property
    def origins(self) -> dict[str, float]:
        """What columns of dates count from [s since 1970, UTC], by name."""
        origins: Mapping[str, float] = getattr(self.reader, "origins", {})
        return {new: origins[old] for new, old in self._original.items() if old in origins}

    @property
    def origin(self) -> float:
        """What the column t counts from [s since 1970, UTC]."""
        return self.origins.get("t", 0.0)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Of the reader, and that names were changed."""
        return (self._remark, *self.reader.remarks)

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns, block after block."""
        own = self._original
        parts = (wanted.positions, wanted.efforts, wanted.turning)
        positions, efforts, turning = (frozenset(own[name] for name in part) for part in parts)
        names = tuple(own[name] for name in wanted.names)
        return self.reader.blocks(Wanted(names, positions, efforts, turning), rows)


def by_contract(reader: Reader) -> Reader:
    """The reader, under the names of the contract where its own are these in capitals or with their unit.

    Certain only where all of them are, the time included, and none comes twice.
    """
    names = reader.names
    if any(map(is_signal, names)):
        return reader
    lower = [name.lower() for name in names]
    capital = [name for name in lower if is_signal(name)]
    if "T" in names and len(capital) > 1 and len(set(lower)) == len(lower):
        said = "names of columns are read in small letters"
        return Renamed(reader, dict(zip(lower, names, strict=True)), said, {})
    parts = [_WITH_UNIT.fullmatch(name) for name in names]
    short = [
        part[1].lower() if part and is_signal(part[1].lower()) else name
        for part, name in zip(parts, names, strict=True)
    ]
    units = {new: part[2] for new, part in zip(short, parts, strict=True) if part and is_signal(new)}
    if "t" not in units or len(units) < 2 or len(set(short)) < len(short):
        return reader
    said = "names of columns are read without the units in them"
    return Renamed(reader, dict(zip(short, names, strict=True)), said, units)
