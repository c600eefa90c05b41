"""Logs in files of arrays: MATLAB's (.mat) and NumPy's (.npz, .npy); a matrix is a column for each joint."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.dataset.reading.column_table import ColumnTable
from modelgen.dataset.reading.matlab_file import matlab_arrays
from modelgen.dataset.reading.specs import unreadable
from modelgen.errors import DamagedFileError, InputError

ARRAYS = (".mat", ".npz", ".npy")
_NUMBERS = "iufmM"  # kinds of numbers, dates and times


class ArrayTable(ColumnTable):
    """Columns of a file of arrays, which may hold several records: some columns may be longer than others."""

    def __init__(self, columns: Mapping[str, np.ndarray], name: str) -> None:
        super().__init__(columns, name)
        lengths = Counter(map(len, columns.values()))
        ((usual, _),) = lengths.most_common(1)
        # Names of the columns of the record that has most of them, the first such one.
        self.together = tuple(x for x in self.names if len(columns[x]) == usual)
        others = [x for x in self.names if len(columns[x]) != usual]
        if others:
            self._found[f"the file holds more than one record: {', '.join(others)} have other lengths"] = None


def array_table(path: Path, names: tuple[str, ...] = ()) -> ArrayTable:
    """The columns of a file of arrays, in memory. names: of the columns of an array that has none.

    A vector of N numbers is a column by its own name, a matrix (N, k) or (k, N) k columns: q is q1, q2 and
    so on; the longer side is time. Fields of a struct are columns by their names, where two structs have no
    field of the same name, else by struct.field. Single numbers are no columns. Raises InputError where it
    is no such file, or holds no array.
    """
    arrays = dict(_leaves("", _matlab(path) if path.suffix.lower() == ".mat" else _numpy(path, names)))
    short = [name.rpartition(".")[2] for name in arrays]
    if len(set(short)) == len(short):
        arrays = dict(zip(short, arrays.values(), strict=True))
    columns: dict[str, np.ndarray] = {}
    for name, values in arrays.items():
        columns |= _columns(path, name, values)
    if not columns:
        raise InputError(
            f"{path}: found no array of numbers, expected t, q, i and so on; MATLAB's tables, timetables and "
            "timeseries are objects that only MATLAB reads: writetimetable(x, 'log.csv') writes one as CSV"
        )
    return ArrayTable(columns, str(path))


def _matlab(path: Path) -> Mapping[str, Any]:
    """Variables of a MATLAB file by name, structs as mappings."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise unreadable(path, error) from None
    return matlab_arrays(path, data)


def _numpy(path: Path, names: tuple[str, ...]) -> Mapping[str, Any]:
    """Arrays of a NumPy file by name; the fields of a single one, or its columns by `names`."""
    try:
        with path.open("rb") as stream:
            found = np.load(stream, allow_pickle=False)
            if not isinstance(found, np.ndarray):
                return {name: found[name] for name in found.files}
    except OSError as error:
        raise unreadable(path, error) from None
    except Exception as error:  # a damaged file fails anywhere in its reader
        said = (str(error).splitlines() or [type(error).__name__])[0]
        raise DamagedFileError(
            f"{path}: this is no file of NumPy's arrays, or a damaged one: {said}"
        ) from None
    if found.dtype.names is not None:
        return {name: found[name] for name in found.dtype.names}
    table = found if found.ndim == 2 else found.reshape(-1, 1)
    if len(names) != table.shape[1]:
        raise InputError(
            f"{path}: found an array of {table.shape[1]} columns without names; `columns: [t, q1, i1]` in a "
            "mapping file (--mapping) names them, one each"
        )
    return dict(zip(names, table.T, strict=True))


def _leaves(name: str, value: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Arrays of more than one number in a tree of mappings, by the way to them."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _leaves(f"{name}.{key}" if name else str(key), inner)
    elif isinstance(value, np.ndarray) and value.dtype.kind in _NUMBERS and value.size > 1:
        yield name, value


def _columns(path: Path, name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """The columns of one array by name."""
    values = np.squeeze(values)
    if values.ndim == 1:
        return {name: values}
    if values.ndim > 2:
        raise InputError(
            f"{path}: found an array of {values.ndim} dimensions, {name}, expected samples and joints alone"
        )
    rows = values if values.shape[0] >= values.shape[1] else values.T
    return {f"{name}{k}": column for k, column in enumerate(rows.T, 1)}
