"""Logs as they are given: paths, parts of files, records."""

from __future__ import annotations

from os import PathLike, fspath
from typing import Any, TypeAlias

Log: TypeAlias = Any


def listed(logs: Any, role: str) -> list[Any]:
    """Logs as a list; one may be given alone. role: how messages name those without a name."""
    every = logs if isinstance(logs, list | tuple) else [logs]
    return [fspath(log) if isinstance(log, PathLike) else log for log in every]
