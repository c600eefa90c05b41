"""The section on variants."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from typing import Any

from peers.tables import FUNCTIONS

_HEAD = """\
## Variants

Written by `python benchmarks/variants.py --accept`. What another way to generate or to compile the same functions
changes, in per cent of the instructions per call (in brackets: of the operations, where they change); positive is
worse. Three bench arms ({arms}), parameters folded in, x86-64-v3.
"""
_FOOT = """\
Four states at once, in vectors of four doubles: instructions per state of the straight line alone (sine and cosine
given, inputs and pivots not tested), one state after the other and four at once.
"""


def lines(result: dict[str, Any]) -> list[str]:
    """Lines of the section."""
    shipped, *variants = result["variants"]
    arms = list(shipped["arms"])
    text = [_HEAD.format(arms=", ".join(arms))]
    text += ["| variant | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " | code |"]
    text += ["|---|" + "---:|" * (len(FUNCTIONS) + 1)]
    group = ""
    for variant in variants:
        if variant["group"] != group:
            group = variant["group"]
            text.append(f"| **{group}** |" + " |" * (len(FUNCTIONS) + 1))
        cells = [_cell(shipped, variant, arms, function) for function in FUNCTIONS]
        bytes_of = [(variant["arms"][a]["code"], shipped["arms"][a]["code"]) for a in arms]
        code = " / ".join(_percent(now, before) for now, before in bytes_of if now)
        text.append(f"| {variant['text']} | " + " | ".join(cells) + f" | {code} |")
    text += ["", _FOOT]
    text += [
        "| | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |",
        "|---|" + "---:|" * len(FUNCTIONS),
    ]
    for arm, found in result["vectors"].items():
        cells = [
            f"{found['one'][f]:.0f} -> {found['four'][f]:.0f} ({found['one'][f] / found['four'][f]:.2f})"
            for f in FUNCTIONS
        ]
        text.append(f"| {arm} | " + " | ".join(cells) + " |")
    return text


def _percent(now: float, before: float) -> str:
    change = 100 * (now / before - 1)
    return "0" if abs(change) < 0.05 else f"{change:+.1f}"


def _cell(shipped: dict[str, Any], variant: dict[str, Any], arms: list[str], function: str) -> str:
    parts = {}
    for what in ("instructions", "operations"):
        changes = [
            _percent(variant["arms"][a][what][function], shipped["arms"][a][what][function]) for a in arms
        ]
        parts[what] = " / ".join(changes) if any(change != "0" for change in changes) else ""
    operations = f" ({parts['operations']})" if parts["operations"] else ""
    return f"{parts['instructions']}{operations}" or "0"
