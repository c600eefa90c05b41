"""Lines of a blind run, picked and counted."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

Line = dict[str, Any]
RUNS = Path(__file__).resolve().parent / "runs"
COMPLIANT = ("backlash", "joint_flexibility")


def wilson(hits: int, total: int, z: float = 1.96) -> tuple[float, float]:
    """Interval of a proportion (Wilson 1927); (0, 1) without cases."""
    if total == 0:
        return 0.0, 1.0
    share, square = hits / total, z * z / total
    centre = (share + square / 2) / (1 + square)
    half = z * math.sqrt(share * (1 - share) / total + square / (4 * total)) / (1 + square)
    return max(0.0, centre - half), min(1.0, centre + half)


def answered(lines: list[Line]) -> list[Line]:
    """Those that were drawn and diagnosed."""
    return [line for line in lines if "result" in line]


def measured() -> list[Line]:
    """Lines of the last blind run, of what was answered."""
    (path,) = (p for p in RUNS.glob("*.jsonl") if p.stem.isdigit())
    return answered([json.loads(row) for row in path.read_text(encoding="utf-8").splitlines()])


def of(
    lines: list[Line], group: str, strength: float | None = None, compliant: bool | None = None
) -> list[Line]:
    """Those of a group, at a strength, with a compliant joint hidden or something else; None: any."""
    return [
        line
        for line in lines
        if line["group"] == group
        and (strength is None or line["strength"] == strength)
        and (compliant is None or (line["effects"] and line["effects"][0] in COMPLIANT) == compliant)
    ]
