"""Logs in memory: tables of columns by name, of whatever library."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from datetime import UTC, date, timedelta
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from modelgen.dataset.objects import Record, Wanted
from modelgen.dataset.reading.turns import blank_in_many, in_turn
from modelgen.errors import InputError
from modelgen.numeric import Array


class ColumnTable:
    """Columns of N numbers, dates or times by name; a missing value is NaN.

    A date or time becomes seconds since the first one.
    columns: a mapping, a data frame of pandas or polars, a table of pyarrow, or an array with fields. name:
    what messages call it. Raises InputError where it is no such table.
    """

    def __init__(self, columns: Any, name: str) -> None:
        self.name, self._columns = name, columns
        # Duck typing: no library is imported for what is not one of its tables.
        names = getattr(columns, "column_names", None)  # pyarrow
        if names is None:
            names = columns.keys() if isinstance(columns, Mapping) else getattr(columns, "columns", None)
        if names is None:
            names = getattr(getattr(columns, "dtype", None), "names", None)
        if names is None or callable(names):
            kind = type(columns).__name__
            raise InputError(
                f"{name}: found {kind}, expected a path, FILE@t0:t1, a record or a table of columns"
            )
        self.names: tuple[str, ...] = tuple(str(x) for x in names)
        self._index = None if "t" in self.names else _times_of(columns)
        if self._index is not None:
            self.names = ("t", *self.names)
        if not self.names:
            raise InputError(f"{name}: the table has no columns, expected t, q1, i1 and so on")
        self._found: dict[str, None] = {}

    @property
    def instants(self) -> frozenset[str]:
        """Names of the columns that are dates or times."""
        return frozenset(name for name in self.names if self._values(name).dtype.kind in "mM")

    @cached_property
    def sparse(self) -> frozenset[str]:
        """Names of the columns of numbers that are blank in many rows, which are rows of several in turn."""
        blank = {name: np.isnan(x) for name in self.names if (x := self._values(name)).dtype.kind == "f"}
        return frozenset(name for name, x in blank.items() if blank_in_many(int(x.sum()), x.size))

    @property
    def by_column(self) -> bool:
        """Whether a column is read without the others."""
        return not self.sparse

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was found out about the columns that were read."""
        return tuple(self._found)

    def __str__(self) -> str:
        return self.name

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns, `rows` at a time. Raises InputError for columns that are no numbers."""
        columns = [self._column(name) for name in wanted.names]
        lengths = {name: len(column) for name, column in zip(wanted.names, columns, strict=True)}
        if len(set(lengths.values())) > 1:
            found = ", ".join(f"{name} has {count}" for name, count in lengths.items())
            raise InputError(f"{self.name}: the columns differ in length: {found} samples")
        if self.sparse.intersection(wanted.names[1:]):
            table, remark = in_turn(self.name, wanted, np.stack(columns).T)
            self._found[remark] = None
            columns = list(table.T)
        for begin in range(0, len(columns[0]), rows):
            # Columns in order in memory, as the readers of files give them.
            yield np.stack([column[begin : begin + rows] for column in columns]).T

    def content(self) -> str:
        """Hash of the names and numbers; a column of something else counts by its text."""
        digest = hashlib.sha256()
        for name in sorted(self.names):
            digest.update(name.encode())
            try:
                digest.update(self._column(name).tobytes())
            except InputError:
                digest.update(repr(self._values(name)).encode())
        return digest.hexdigest()

    def _values(self, name: str) -> np.ndarray:
        """A column as an array; objects as numbers or dates where they are."""
        if name == "t" and self._index is not None:
            self._found["t is the table's index"] = None
            column = self._index
        else:
            column = self._columns[name]
        if isinstance(column, np.ma.MaskedArray) and column.dtype.kind in "iuf":
            column = np.ma.filled(column.astype(float), np.nan)
        values = np.asarray(column)
        return _numbers(column, values) if values.dtype.kind == "O" else values

    def _column(self, name: str) -> Array:
        """A column as numbers (N,). Raises InputError."""
        values = self._values(name)
        if values.ndim != 1:
            raise InputError(
                f"{self.name}: found {values.ndim} dimensions in the column {name}, "
                "expected one number per sample"
            )
        if values.dtype.kind in "mM":
            self._found[f"{name} is a date or time: seconds are counted from the first one"] = None
            return _seconds(values)
        if values.dtype.kind not in "iuf":
            raise InputError(f"{self.name}: found {values.dtype} in the column {name}, expected numbers")
        return np.ascontiguousarray(values, dtype=np.float64)


def _times_of(columns: Any) -> Any:
    """The index of a pandas frame where that is called t or holds dates or times; else None."""
    index = getattr(columns, "index", None)
    if not hasattr(columns, "reset_index") or index is None:
        return None
    kind = getattr(getattr(index, "dtype", None), "kind", "")
    return index if getattr(index, "name", None) == "t" or kind in ("m", "M") else None


def _seconds(values: np.ndarray) -> Array:
    """Dates or times (N,) as seconds since the first of them; blank ones are NaN."""
    there = ~np.isnat(values)
    if not there.any():
        return np.full(len(values), np.nan)
    # The difference of integers is exact; nanoseconds since 1970 have more digits than a float.
    apart = (values - values[there][0]).astype("timedelta64[ns]").astype(np.int64)
    return np.where(there, 1e-9 * apart, np.nan)


def _numbers(column: Any, values: np.ndarray) -> np.ndarray:
    """Objects as numbers or dates, missing values as NaN or NaT; as they are where they are neither."""
    first = next((x for x in values.flat if x is not None), None)
    if isinstance(first, date | timedelta):
        return _dates(column, values)
    try:
        if hasattr(column, "isna"):  # pandas' missing value is no float
            return np.asarray(column.to_numpy(dtype=float, na_value=np.nan))
        return values.astype(float)
    except (TypeError, ValueError):
        return values


def _dates(column: Any, values: np.ndarray) -> np.ndarray:
    """Python's dates and times, those of a zone by UTC, as NumPy's; as they are where they differ in kind."""
    try:
        if hasattr(column, "tz") or hasattr(getattr(column, "dt", None), "tz"):  # pandas, of a zone
            return np.asarray(column, dtype="datetime64[ns]")
        zoned = [x.astimezone(UTC).replace(tzinfo=None) if getattr(x, "tzinfo", None) else x for x in values]
        kind = "timedelta64[us]" if isinstance(zoned[0], timedelta) else "datetime64[us]"
        return np.array(zoned, dtype=kind)
    except (TypeError, ValueError):
        return values


Log: TypeAlias = str | os.PathLike[str] | Record | ColumnTable


def named(log: Any, name: str) -> Log:
    """A log as it is given; a table of columns gets the name that messages use. Raises InputError."""
    if isinstance(log, str | Record | ColumnTable):
        return log
    return os.fspath(log) if isinstance(log, os.PathLike) else ColumnTable(log, name)
