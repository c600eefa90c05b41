"""docs/benchmarks.md, from the figures of compare.py, control.py, variants.py and scale.py."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from peers import pages_control, pages_costs, pages_scale, pages_variants, pictures, quoted
from peers.tables import FUNCTIONS, counts, operations, overview, table, times

_HEAD = """\
# Beside other tools

*How fast is the generated code beside that of other tools?* The table below has the answer for eleven arms together; further down is every
arm by itself, then generation, memory, regressors over many states, control, variants, and growth with the joints.
"""
_HOW = """## How it is measured

`make bench` measures and writes this page. The links are rigid, without drives and effects. Everyone gets the same 200 random states, and results
are compared to 1e-9 before anything is measured (regressors by the efforts that they give). The code is compiled for x86-64-v3 with `-O3`, in double
precision, with parameters folded in where the tool can do that. modelgen's figures contain its checks of the inputs.

- **operations**: multiplications + additions + negations as written, before the compiler; divisions after the
  comma; trigonometry apart.
- **instructions** per call, counted by callgrind, sine and cosine included; mean over the states. They do not
  depend on the load of the machine.
- **time**: blocks of calls, CPU time as a ratio to modelgen's median in the same round; median, in brackets
  10 to 90 % of the blocks, then the lowest and highest median of five rounds. Times are those of the last whole run;
  `compare.py --own` counts modelgen's instructions and operations anew without one.
- Pinocchio, C++: `rnea`, `crba`, `aba` (the convention with fewer instructions), `computeJointTorqueRegressor`,
  built from its headers. Its regressor has 10 n columns, modelgen's those of the base parameters.
- Pinocchio, traced with CasADi: the same algorithms on symbols, with CasADi's elimination of common
  subexpressions, as C; `crba` and `aba` in the local convention, which takes fewer operations on symbols, and in
  Pinocchio's default one (world). Sines and cosines of quarter turns in the arm's geometry are given as exact 0
  and 1 to everyone.
- SymForce: Newton-Euler, composite bodies and an unrolled LDL' written with its matrices, its elimination of
  common subexpressions, its C++ (it has no dynamics of its own).
- SymPy: `KanesMethod`, `cse`, C; two arms only, for its time.
- MuJoCo: `mj_inverse`, `mj_forward`, with all that these pipelines do besides.
- A tree: `two_fingers`. A locked joint: `ariane4`. Prismatic joints: `scara`, `screw_axis`.

modelgen and the figures of the [table of sizes](sizes.md) (Cortex-M4F) share the same C.
"""


def document(result: dict[str, Any], folder: Path) -> str:
    """docs/benchmarks.md. `folder` holds the results of control.py, variants.py and scale.py, where they have been written."""
    versions = ", ".join(f"{name} {version}" for name, version in result["versions"].items())
    arms = result["arms"]
    lines = [_HEAD, "![instructions relative to modelgen](benchmarks.svg)", "", "## Overview", ""]
    lines += [*overview(arms), "", _HOW, f"Measured with {versions}."]
    for arm, peers in arms.items():
        lines += ["", f"## {arm}", "", "Operations.", "", *table(peers, operations)]
        lines += ["", "Instructions (ratio to modelgen).", "", *table(peers, counts)]
        lines += ["", "Time, ratio to modelgen.", "", *table(peers, times)]
    lines += ["", "## Generation", "", *pages_costs.generation(arms)]
    lines += ["", "## Code and memory", "", *pages_costs.memory(arms)]
    lines += ["", "![generation and memory](benchmarks-costs.svg)"]
    lines += ["", "## Generators that are not on PyPI", "", quoted.TEXT, *quoted.table(result["quoted"])]
    lines += ["", "## Regressor in many states", "", "Rows per second on one core, thousands.", ""]
    lines += _rates(result["rows_per_second"])
    sections = {"control": pages_control.lines, "variants": pages_variants.lines, "scale": pages_scale.lines}
    for name, write in sections.items():
        if (folder / f"{name}.json").exists():
            lines += ["", *write(json.loads((folder / f"{name}.json").read_text(encoding="utf-8")))]
    return "\n".join(lines) + "\n"


def _rates(batches: dict[str, dict[str, float]]) -> list[str]:
    names = list(next(iter(batches.values()), {}))
    lines = ["| | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]
    for arm, found in batches.items():
        lines.append(f"| {arm} | " + " | ".join(f"{found[name] / 1e3:.0f}" for name in names) + " |")
    return lines


def write(result: dict[str, Any], results: Path, folder: Path) -> None:
    """Write the page and its pictures. `results`: the folder of the files of figures."""
    for name, text in pictures.pictures(result["arms"], FUNCTIONS).items():
        (folder / name).write_text(text, encoding="utf-8")
    if (results / "scale.json").exists():
        scale = json.loads((results / "scale.json").read_text(encoding="utf-8"))
        (folder / "benchmarks-scale.svg").write_text(pages_scale.picture(scale), encoding="utf-8")
    (folder / "benchmarks.md").write_text(document(result, results), encoding="utf-8")
