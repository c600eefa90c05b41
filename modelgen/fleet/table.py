"""The fleet as one Parquet table (extra `logs`: pyarrow)."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modelgen.errors import InputError
from modelgen.extras import missing
from modelgen.fleet.store import Row

NAME = "fleet.parquet"


def library() -> Any:
    """Pyarrow with its Parquet. Raises InputError where it is missing."""
    try:
        importlib.import_module("pyarrow.parquet")
        return importlib.import_module("pyarrow")
    except ImportError:
        raise missing("a fleet needs", "pyarrow") from None


def write_table(rows: Sequence[Row], path: Path) -> None:
    """One row per unit, in their order; the file appears whole. Raises InputError."""
    pa = library()
    table = pa.Table.from_pylist(list(rows), schema=schema())
    new = path.with_name(f".{path.name}.new")
    try:
        pa.parquet.write_table(table, new)
        new.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error


def schema() -> Any:
    """Columns and types. Lists by cause, by joint (error_*, gain_percent), by parameter."""
    pa = library()
    text, number, whole = pa.string(), pa.float64(), pa.int32()
    texts, numbers = pa.list_(text), pa.list_(number)
    value = [("name", text), ("value", number), ("std", number), ("unit", text)]
    return pa.schema(
        [
            ("unit", text),
            ("arm", text),
            ("begins", numbers),
            ("verdict", text),
            ("reason", text),
            ("causes", texts),
            ("joints", pa.list_(whole)),
            ("joint_names", texts),
            ("titles", texts),
            ("suspects", texts),
            ("failed_checks", pa.list_(texts)),
            ("worth", text),
            ("doubts", texts),
            ("harms", pa.list_(pa.bool_())),
            ("delta_bic", numbers),
            ("cross_gain_percent", numbers),
            ("ambiguous_with", pa.list_(texts)),
            ("aliases", pa.list_(texts)),
            ("cause_parameters", pa.list_(pa.struct([("cause", text), ("joint", whole), *value]))),
            ("lack_of_fit", number),
            ("lack_of_fit_threshold", number),
            ("error_unit", text),
            ("error_before", numbers),
            ("error_after", numbers),
            ("gain_percent", numbers),
            ("best_gain_percent", number),
            ("overall_gain_percent", number),
            ("overall_gain_interval_percent", numbers),
            ("parameters", pa.list_(pa.struct(value))),
            ("not_identifiable", texts),
            ("train", texts),
            ("test", texts),
            ("report", text),
            ("seconds", number),
            ("cpu_seconds", number),
            ("error", text),
        ]
    )
