"""The section on derivatives and combined functions, beside Pinocchio, and MuJoCo's dynamics alone."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from typing import Any

_HEAD = """\
## Derivatives and control ticks

Written by `python benchmarks/control.py --accept`: instructions per call, in brackets the operations; parameters folded in,
x86-64-v3, results compared to 1e-10.

Derivatives of inverse dynamics to q, dq and ddq (the mass matrix), and of forward dynamics to q, dq and the effort, each with
the values themselves.
"""
_SAME = """\
Pinocchio over modelgen without what differs in sine and cosine and in the columns: the traced functions call modelgen's sine and
cosine, inlined, and the regressor has the standard parameters, 10 n columns, on both sides; in brackets with those of the C library.
"""
_COMBINED = """\
One tick: functions of an arm's `combined` beside the same functions called one after the other (the regressor is that of the base
parameters): their instructions, and the combined function's share of them.
"""
_MUJOCO = """\
MuJoCo over modelgen: its pipelines `mj_inverse` and `mj_forward`, and the equations of motion in them alone (`mj_kinematics`,
`mj_comPos`, `mj_comVel`, `mj_rne`; forward also `mj_makeM`, `mj_factorM`, `mj_solveM`).
"""
_PINOCCHIO = ("Pinocchio, traced with CasADi", "Pinocchio, C++")
_EQUAL = "traced, with modelgen's sine and cosine"
_TITLES = {
    "tick": ("inverse dynamics, mass matrix", ("inverse_dynamics", "mass_matrix")),
    "adaptive": ("and regressor", ("inverse_dynamics", "mass_matrix", "regressor")),
}


def lines(result: dict[str, Any]) -> list[str]:
    """Lines of the section. result: what control.py writes."""
    heading = ["| | " + " | ".join(result) + " |", "|---|" + "---:|" * len(result)]
    text = [_HEAD, *heading]
    for name in ("inverse_dynamics", "forward_dynamics"):
        cells = [_own(arm, f"{name}_derivatives") for arm in result.values()]
        text.append(_row(name.replace("_", " "), cells))
        for who in _PINOCCHIO:
            if all(who in arm["instructions"] for arm in result.values()):
                cells = [_theirs(arm, who, f"{name}_derivatives") for arm in result.values()]
                text.append(_row(f"{name.replace('_', ' ')}: {who}, modelgen's share", cells))
    if all(_EQUAL in arm["instructions"] for arm in result.values()):
        text += ["", _SAME, *_equal(result)]
    text += ["", _COMBINED, *heading]
    for key, (title, parts) in _TITLES.items():
        text.append(_row(f"{title}: combined", [_own(arm, key) for arm in result.values()]))
        cells = [_sum(arm, parts, key) for arm in result.values()]
        text.append(_row(f"{title}: one after the other", cells))
    if all("MuJoCo" in arm["instructions"] for arm in result.values()):
        text += ["", _MUJOCO, *_alone(result)]
    return text


def _row(title: str, cells: list[str]) -> str:
    return f"| {title} | " + " | ".join(cells) + " |"


def _own(arm: dict[str, Any], function: str) -> str:
    count = arm["instructions"]["modelgen"][function]
    return f"{count:.0f} ({arm['operations']['modelgen'][function]:.0f})"


def _theirs(arm: dict[str, Any], who: str, function: str) -> str:
    """Another's instructions, and ours over them."""
    count = arm["instructions"][who][function]
    return f"{count:.0f}, {arm['instructions']['modelgen'][function] / count:.2f}"


def _equal(result: dict[str, Any]) -> list[str]:
    """Instructions of the traced functions over ours, under the same conditions."""
    titles = ("inverse_dynamics", "mass_matrix", "forward_dynamics", "regressor")
    text = ["| | " + " | ".join(t.replace("_", " ") for t in titles) + " |", "|---|" + "---:|" * len(titles)]
    for name, arm in result.items():
        mine = arm["instructions"]["modelgen"]
        cells = []
        for title in titles:
            own = mine["regressor_standard" if title == "regressor" else title]
            same, library = (arm["instructions"][who][title] for who in (_EQUAL, _PINOCCHIO[0]))
            cells.append(f"{same / own:.2f} ({library / own:.2f})")
        text.append(_row(name, cells))
    return text


def _sum(arm: dict[str, Any], parts: tuple[str, ...], mine: str) -> str:
    counts = arm["instructions"]["modelgen"]
    total = sum(counts[part] for part in parts)
    return f"{total:.0f}, {counts[mine] / total:.2f}"


def _alone(result: dict[str, Any]) -> list[str]:
    """MuJoCo's instructions over ours, of the pipelines and of the equations alone."""
    text = ["| | inverse dynamics | forward dynamics |", "|---|---:|---:|"]
    for name, arm in result.items():
        theirs, mine = arm["instructions"]["MuJoCo"], arm["instructions"]["modelgen"]
        cells = [
            f"{theirs[f] / mine[f]:.1f}, alone {theirs[f'{f}_alone'] / mine[f]:.1f}"
            for f in ("inverse_dynamics", "forward_dynamics")
        ]
        text.append(_row(name, cells))
    return text
