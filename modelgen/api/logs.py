"""Logs as they are given: paths, parts of files, records, tables of columns."""

from __future__ import annotations

from typing import Any, TypeAlias

from modelgen import dataset

# A path, FILE@t0:t1, a record, or a table of columns of any library: no type holds them all.
Log: TypeAlias = Any


def listed(logs: Log, role: str) -> list[dataset.Log]:
    """Logs as a list; one may be given alone.

    role: what messages call a table, which has no name of its own; with a number where there may be several.
    Raises InputError for what is no log.
    """
    if not isinstance(logs, list | tuple):
        return [dataset.named(logs, role)]
    return [dataset.named(log, f"{role}[{k}]") for k, log in enumerate(logs)]
