"""Tables of generation and memory."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from typing import Any

TRACED, SYMFORCE, KANE = "Pinocchio, traced with CasADi", "SymForce", "SymPy, Kane"
_GENERATORS = {"modelgen": "modelgen", TRACED: "traced Pinocchio", SYMFORCE: "SymForce", KANE: "SymPy, Kane"}
_GENERATION = """\
Description to C in a process of its own: CPU seconds after the imports; most memory [MB], in brackets what of it
the imports took. modelgen writes all of its functions ({functions} here), with parameters at run time and folded in,
choosing among variants; the others write four, SymPy two. The tracer is a compiled program.
"""
_MEMORY = """\
Of the four functions with parameters folded in: bytes of code + constants, and the largest stack frame (gcc's
`-fstack-usage`). modelgen's include its sine and cosine; the others call the C library's. Heap: what Pinocchio
and MuJoCo allocate for model and data; the others allocate nothing.
"""


def generation(arms: dict[str, Any]) -> list[str]:
    """CPU time and memory of writing the C."""
    head = [f"{title}{unit}" for title in _GENERATORS.values() for unit in (", s", ", MB")]
    lines = [_GENERATION.format(functions="23 to 25"), "| arm | " + " | ".join(head) + " |"]
    lines.append("|---|" + "---:|" * len(head))
    for arm, peers in arms.items():
        cells = [arm]
        for name in _GENERATORS:
            cost = peers.get(name, {}).get("costs", {})
            imports = f" ({cost['imports']:.0f})" if "imports" in cost else ""
            made = [f"{cost['seconds']:.2f}", f"{cost['memory']:.0f}{imports}"] if cost else ["", ""]
            cells += made
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def memory(arms: dict[str, Any]) -> list[str]:
    """Bytes at run time."""
    columns = [f"{title}, {what}" for title in list(_GENERATORS.values())[:3] for what in ("code", "stack")]
    columns += ["Pinocchio C++, heap", "MuJoCo, heap"]
    lines = [_MEMORY, "| arm | " + " | ".join(columns) + " |", "|---|" + "---:|" * len(columns)]
    for arm, peers in arms.items():
        cells = [arm]
        for name in list(_GENERATORS)[:3]:
            cost = peers.get(name, {}).get("costs", {})
            code = f"{cost['code']:.0f} + {cost['tables']:.0f}" if cost else ""
            cells += [code, f"{cost['stack']:.0f}" if cost else ""]
        for name in ("Pinocchio, C++", "MuJoCo"):
            heap = peers.get(name, {}).get("costs", {}).get("heap")
            cells.append(f"{heap:.0f}" if heap else "")
        lines.append("| " + " | ".join(cells) + " |")
    return lines
