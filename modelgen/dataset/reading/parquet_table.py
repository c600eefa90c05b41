"""Parquet logs, read row group by row group (extra `logs`: pyarrow)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.dataset.objects import Wanted
from modelgen.dataset.reading.specs import unreadable
from modelgen.dataset.reading.turns import blank_in_many, in_turn
from modelgen.errors import DamagedFileError, InputError
from modelgen.extras import missing
from modelgen.numeric import Array

HEAD = 4096  # rows that blank columns are told by


class ParquetReader:
    """A Parquet file of numbers, dates and times.

    A date or time becomes seconds since the file's first row. Raises InputError where it is no such file, or
    pyarrow is missing.
    """

    def __init__(self, path: Path) -> None:
        try:
            import pyarrow.parquet  # noqa: PLC0415 - an extra
        except ImportError:
            raise missing(f"{path}: Parquet needs", "pyarrow") from None
        self.path = path
        try:
            with path.open("rb"):
                pass
            self._file = pyarrow.parquet.ParquetFile(path, pre_buffer=False, page_checksum_verification=True)
        except OSError as error:
            raise unreadable(path, error) from None
        except pyarrow.ArrowException as error:
            raise InputError(f"{path}: this is no Parquet file: {str(error).splitlines()[0]}") from None
        schema = self._file.schema_arrow
        self.names = tuple(schema.names)
        kinds = pyarrow.types
        times = (kinds.is_timestamp, kinds.is_time, kinds.is_duration)
        self.instants = frozenset(f.name for f in schema if any(fits(f.type) for fits in times))
        said = {f.name: dict(f.metadata or {}) for f in schema}
        words = {name: about.get(b"unit", about.get(b"units")) for name, about in said.items()}
        self.units = {name: word.decode(errors="replace") for name, word in words.items() if word}
        self._found: dict[str, None] = {}
        self.sparse = self._sparse()
        self.by_column = not self.sparse

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was found out about the file, and assumed."""
        return tuple(self._found)

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns, `rows` at a time; a missing value is NaN. Raises InputError."""
        for name in self.instants.intersection(wanted.names):
            self._found[f"{name} is a date or time: seconds are counted from the file's first row"] = None
        if not self.sparse.intersection(wanted.names):
            yield from self._rows(wanted.names, rows)
            return
        table, remark = in_turn(str(self.path), wanted, np.concatenate(list(self._rows(wanted.names, rows))))
        self._found[remark] = None
        yield from (table[k : k + rows] for k in range(0, len(table), rows))

    def _rows(self, wanted: tuple[str, ...], rows: int) -> Iterator[Array]:
        import pyarrow  # noqa: PLC0415 - an extra

        types = pyarrow.types
        for name in wanted:
            kind = self._file.schema_arrow.field(name).type
            numbers = types.is_integer(kind) or types.is_floating(kind) or types.is_decimal(kind)
            if not numbers and name not in self.instants:
                raise InputError(f"{self.path}: found {kind} in the column {name}, expected numbers")
        first: dict[str, int] = {}
        try:
            # pyarrow would otherwise keep what it has read of the file.
            batches = self._file.iter_batches(batch_size=rows, columns=list(wanted), use_threads=False)
            held, filled = _empty(rows, len(wanted)), 0
            for batch in batches:
                taken = 0
                while taken < batch.num_rows:
                    count = min(batch.num_rows - taken, rows - filled)
                    for k, name in enumerate(wanted):
                        column = batch.column(name).slice(taken, count)
                        if name in self.instants:
                            held[filled : filled + count, k] = _seconds(column, name, first)
                            continue
                        if column.type != pyarrow.float64():
                            # Integers beyond 2^53 (nanoseconds since 1970) lose their last digits alone.
                            column = column.cast(pyarrow.float64(), safe=False)
                        held[filled : filled + count, k] = column.to_numpy(zero_copy_only=False)
                    taken, filled = taken + count, filled + count
                    if filled == rows:
                        yield held
                        held, filled = _empty(rows, len(wanted)), 0
            if filled:
                yield held[:filled]
        except (OSError, ValueError, pyarrow.ArrowException) as error:
            raise DamagedFileError(f"{self.path}: cannot be read on: {str(error).splitlines()[0]}") from None

    def _sparse(self) -> frozenset[str]:
        """Columns that are blank in many of the first rows, perhaps in all of them."""
        import pyarrow  # noqa: PLC0415 - an extra

        types = pyarrow.types
        schema = self._file.schema_arrow
        names = [f.name for f in schema if types.is_integer(f.type) or types.is_floating(f.type)]
        try:
            # Counts in the file's metadata would do, but a damaged one ends the process.
            batch = next(self._file.iter_batches(batch_size=HEAD, columns=names, use_threads=False))
            blank = {name: batch.column(name).null_count for name in names}
        except (OSError, KeyError, ValueError, StopIteration, pyarrow.ArrowException):
            return frozenset()  # what is damaged is found when it is read
        rows = batch.num_rows
        return frozenset(name for name, count in blank.items() if blank_in_many(count, rows))


def _seconds(column: Any, name: str, first: dict[str, int]) -> Array:
    """Dates or times as seconds since the first of them; blank ones are NaN."""
    import pyarrow  # noqa: PLC0415 - an extra

    per = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[column.type.unit]
    wide = pyarrow.int32() if pyarrow.types.is_time32(column.type) else pyarrow.int64()
    numbers = column.cast(wide).cast(pyarrow.int64())
    there = np.asarray(numbers.is_valid().to_numpy(zero_copy_only=False), dtype=bool)
    values = np.asarray(numbers.fill_null(0).to_numpy(zero_copy_only=False))
    if there.any():
        first.setdefault(name, int(values[there][0]))
    # The difference of integers is exact; they themselves have more digits than a float.
    return np.where(there, per * (values - first.get(name, 0)).astype(np.float64), np.nan)


def _empty(rows: int, columns: int) -> Array:
    """(rows, columns), each column in order in memory."""
    return np.empty((columns, rows)).T
