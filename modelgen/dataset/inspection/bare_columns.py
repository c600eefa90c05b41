"""Columns of numbers of a log that no arm and no mapping explains."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress

import numpy as np

from modelgen.dataset.objects import Reader
from modelgen.dataset.reading.array_table import ArrayTable
from modelgen.dataset.reading.signals import by_names
from modelgen.dataset.reading.sources import BLOCK
from modelgen.dataset.reading.specs import Spec
from modelgen.errors import DamagedFileError, InputError
from modelgen.numeric import Array


def numbers_in(spec: Spec, reader: Reader) -> tuple[dict[str, Array], dict[str, str]]:
    """Columns of numbers of the part of a log, and the others by `_one_by_one`. Raises InputError."""
    names = tuple(dict.fromkeys(reader.names))
    if "t" not in names and (spec.begin, spec.end) != (-math.inf, math.inf):
        raise InputError(f"{spec.text}: the column t [s] is missing, expected one to cut a part by")
    rest: dict[str, str] = {}
    if isinstance(reader, ArrayTable):
        names = reader.together
    try:
        table = _table(reader, names)
    except InputError:
        table, names, rest = _one_by_one(spec.text, reader, names)
    columns = dict(zip(names, table.T, strict=True))
    if "t" in columns:
        inside = (columns["t"] >= spec.begin) & (columns["t"] < spec.end)
        columns = {name: values[inside] for name, values in columns.items()}
    if not columns or not len(next(iter(columns.values()))):
        raise InputError(f"{spec.text}: found no numbers")
    return columns, rest


def _one_by_one(
    file: str, reader: Reader, names: Sequence[str]
) -> tuple[Array, tuple[str, ...], dict[str, str]]:
    """Columns that are numbers (N, k), their names, and those of the others with a remark on each that begins
    with a number. Raises DamagedFileError.
    """
    found: dict[str, Array] = {}
    rest: dict[str, str] = {}
    for name in names:
        try:
            found[name] = _table(reader, (name,))[:, 0]
        except DamagedFileError:  # which has not said what it holds
            raise
        except InputError as error:
            rest[name] = ""
            with suppress(InputError):
                if next(iter(reader.blocks(by_names((name,)), 1)), None) is not None:
                    rest[name] = f"the column {name} is left out: {error.message}"
    lengths = {name: len(x) for name, x in found.items()}
    if len(set(lengths.values())) > 1:
        few = min(lengths, key=lambda name: lengths[name])
        raise DamagedFileError(
            f"{file}: the column {few} has {lengths[few]} readings, others {max(lengths.values())}"
        )
    table = np.stack(list(found.values()), axis=1) if found else np.empty((0, 0))
    return table, tuple(found), rest


def _table(reader: Reader, names: tuple[str, ...]) -> Array:
    blocks = [block.copy() for block in reader.blocks(by_names(names), BLOCK)]
    return np.concatenate(blocks) if blocks else np.empty((0, len(names)))
