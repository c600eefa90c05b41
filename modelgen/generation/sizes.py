"""Measured sizes of the functions of shipped arms, for their READMEs."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from typing import Any

from modelgen.functions.objects import Model
from modelgen.resources import shipped_sizes


def code_digest(model: Model) -> str:
    """SHA-256 of the functions' operations in their order; folded-in parameters are no part of it."""
    digest = hashlib.sha256()
    for function in model.functions:
        if not function.name.endswith(("_identified", "_nominal")):
            digest.update(repr((function.name, function.program.statements)).encode())
    return digest.hexdigest()


def size_rows(model: Model) -> list[tuple[str, ...]]:
    """Table of the sizes measured for exactly this code, its heading first; empty where there are none."""
    known = _known()
    digest = known.get("code", {}).get(model.arm.name)
    if digest is None or digest != code_digest(model):
        return []
    _, tool = list(known)[:2]
    sizes = known[tool][model.arm.name]
    rows = [
        (f"`{f.name}`", *(_cell(sizes[f.name][key]) for key in ("flash", "stack", "instructions")))
        for f in model.functions
        if f.name in sizes
    ]
    return [(f"function ({tool})", "flash [B]", "stack [B]", "instructions a call"), *rows]


def _cell(value: int | None) -> str:
    return "" if value is None else str(value)


@cache
def _known() -> dict[str, Any]:
    path = shipped_sizes()
    return {} if path is None else json.loads(path.read_text(encoding="utf-8"))
