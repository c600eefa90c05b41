"""The section on variants."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from typing import Any

from peers.tables import FUNCTIONS

_CHOICES = ("forms", "solution", "order")
_HEAD = """\
## Variants

Written by `python benchmarks/variants.py --accept`. What another way to generate or to compile the same functions
changes, in per cent of the instructions per call (in brackets: of the operations, where they change); positive is
worse. Three bench arms ({arms}), parameters folded in, x86-64-v3.
"""
_KEPT = """\
Kept, and so in every figure above: own sine and cosine behind one shared function; common factors factored out or not,
whichever takes fewer operations for a function (the sine and cosine of a sum of parallel axes' angles come from it);
the search over the regressor's plans, where one sweep found as much as all of them; its columns one after the other,
each stored as soon as it is known; pivots computed and tested first; one straight line for forward dynamics instead of
calls.

Not kept: a division for every entry saves up to 3 % of the instructions, but has n (n - 1) / 2 divisions more, 14
cycles each on a Cortex-M4F. Sine and cosine inlined save up to 11 %, but occur in every function once for each joint
(266 bytes on x86); a header of one's own can have it so (`-D<ARM>_SINCOS`). Other orders of operands change the figures
by what the compiler's allocation of registers makes of them, up or down by 4 %, and differently for every arm: to
choose the best one by counting would tie the code to one compiler. Articulated bodies in place of
mass matrix and solution take more operations in arms of up to eight joints.
"""
_TARGET = """\
On a Cortex-M4F (arm-none-eabi-gcc, `-O2`, single precision), the same changes in per cent of the instructions.
"""
_FOOT = """\
Many states in one call, `--batch`, in vectors of four doubles: instructions per state one by one and in a call of 60, with all
that a call does, and the ratio; then the ratio of times. A regressor's many outputs are more than the first cache holds; one
by one they are written to one place again and again.
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
    text.append(
        f"| **the cheapest of forms, solutions and orders for every function** | {_best(result, arms, 'instructions')} | |"
    )
    text += ["", _KEPT, *_m4f(result, arms), "", _FOOT]
    text += [
        "| | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |",
        "|---|" + "---:|" * len(FUNCTIONS),
    ]
    for arm, found in result["vectors"].items():
        cells = [_gained(found, f) for f in FUNCTIONS]
        text.append(f"| {arm} | " + " | ".join(cells) + " |")
    return text


def _gained(found: dict[str, Any], function: str) -> str:
    """A function's instructions per state one by one and in many, their ratio, and that of the times."""
    one, many = (found["instructions"][key][function] for key in ("one", "many"))
    time = found["time"]["one"][function] / found["time"]["many"][function]
    return f"{one:.0f} -> {many:.0f} ({one / many:.2f}; {time:.2f})"


def _best(result: dict[str, Any], arms: list[str], key: str) -> str:
    """Change by the best variant of each function, as cells."""
    shipped, *variants = result["variants"]
    chosen = [v for v in variants if v["group"] in _CHOICES]
    cells = []
    for function in FUNCTIONS:
        changes = []
        for arm in arms:
            before = shipped["arms"][arm][key][function]
            changes.append(_percent(min([before, *(v["arms"][arm][key][function] for v in chosen)]), before))
        cells.append(" / ".join(changes))
    return " | ".join(cells)


def _m4f(result: dict[str, Any], arms: list[str]) -> list[str]:
    """The table of the microcontroller, where it was measured."""
    shipped, *variants = result["variants"]
    if any("m4f" not in shipped["arms"][arm] for arm in arms):
        return []
    text = [_TARGET, "| variant | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |"]
    text += ["|---|" + "---:|" * len(FUNCTIONS)]
    for variant in variants:
        found = variant["arms"]
        if all("m4f" in found[arm] for arm in arms):
            cells = [
                " / ".join(_percent(found[a]["m4f"][f], shipped["arms"][a]["m4f"][f]) for a in arms)
                for f in FUNCTIONS
            ]
            text.append(f"| {variant['text']} | " + " | ".join(cells) + " |")
    text.append(f"| **the cheapest of them for every function** | {_best(result, arms, 'm4f')} |")
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
