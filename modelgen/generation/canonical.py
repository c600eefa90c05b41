"""The canonical description of an arm: the same text for the same arm, however its YAML is written."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import Field, fields, is_dataclass
from typing import Any

import sympy as sp

from modelgen.description.objects import Arm


def canonical(arm: Arm) -> str:
    """Write the whole arm as JSON; places in the file are no part of it."""
    return json.dumps(_plain(arm), sort_keys=True, ensure_ascii=True, separators=(",", ":"))


def description_hash(arm: Arm) -> str:
    """SHA-256 of the canonical description, in hexadecimal digits."""
    return hashlib.sha256(canonical(arm).encode()).hexdigest()


def _plain(value: Any) -> Any:
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, int | float):
        # 2 and 2.0 describe the same arm, and so do 0 and -0.
        return float(value) + 0.0
    if isinstance(value, sp.Basic):
        return {"expression": sp.srepr(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    if is_dataclass(value):
        # The class tells a direct drive from a levered one.
        content = {
            f.name: _plain(getattr(value, f.name))
            for f in fields(value)
            if f.compare and not f.metadata.get("derived") and not _unsaid(value, f)
        }
        return {"is": type(value).__name__, **content}
    raise TypeError(f"{type(value).__name__} has no canonical form")


def _unsaid(value: Any, of: Field[Any]) -> bool:
    """Whether nothing is said of what the arm does not have: hashes of before it existed stay."""
    return bool(of.metadata.get("optional")) and getattr(value, of.name) == of.default
