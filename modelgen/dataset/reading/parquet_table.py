"""Parquet logs, read row group by row group (extra `logs`: pyarrow)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from modelgen.dataset.reading.specs import unreadable
from modelgen.errors import InputError
from modelgen.numeric import Array


class ParquetReader:
    """A Parquet file of numeric columns. Raises InputError where it is not, or pyarrow is missing."""

    by_column = True

    def __init__(self, path: Path) -> None:
        try:
            import pyarrow.parquet  # noqa: PLC0415 - an extra
        except ImportError:
            raise InputError(f"{path}: Parquet needs pyarrow: pip install 'modelgen[logs]'") from None
        self.path = path
        try:
            with path.open("rb"):
                pass
            self._file = pyarrow.parquet.ParquetFile(path, pre_buffer=False)
        except OSError as error:
            raise unreadable(path, error) from None
        except pyarrow.ArrowException as error:
            raise InputError(f"{path}: this is no Parquet file: {str(error).splitlines()[0]}") from None
        self.names = tuple(self._file.schema_arrow.names)

    def blocks(self, wanted: tuple[str, ...], rows: int) -> Iterator[Array]:
        """The wanted columns, `rows` at a time; a missing value is NaN. Raises InputError."""
        import pyarrow  # noqa: PLC0415 - an extra

        for name in wanted:
            kind = self._file.schema_arrow.field(name).type
            if not (pyarrow.types.is_integer(kind) or pyarrow.types.is_floating(kind)):
                raise InputError(f"{self.path}: found {kind} in the column {name}, expected numbers")
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
                        if column.type != pyarrow.float64():
                            column = column.cast(pyarrow.float64())
                        held[filled : filled + count, k] = column.to_numpy(zero_copy_only=False)
                    taken, filled = taken + count, filled + count
                    if filled == rows:
                        yield held
                        held, filled = _empty(rows, len(wanted)), 0
            if filled:
                yield held[:filled]
        except (OSError, pyarrow.ArrowException) as error:
            raise InputError(f"{self.path}: cannot be read on: {str(error).splitlines()[0]}") from None


def _empty(rows: int, columns: int) -> Array:
    """(rows, columns), each column in order in memory."""
    return np.empty((columns, rows)).T
