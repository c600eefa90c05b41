"""Tables of operations, instructions and times."""

from __future__ import annotations

from collections.abc import Callable
from math import exp, log
from typing import Any

FUNCTIONS = ("inverse_dynamics", "mass_matrix", "forward_dynamics", "regressor")
OURS = "modelgen"
Peers = dict[str, Any]  # figures of one arm by who computes
_SMALL = 4  # joints below which an arm has no part in the overview


def table(peers: Peers, cell: Callable[[Any, Peers, str], str]) -> list[str]:
    """One line for each peer that has something to show."""
    lines = ["| | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |", "|---|" + "---:|" * 4]
    for name, figures in peers.items():
        cells = [cell(figures, peers, f) for f in FUNCTIONS]
        if any(cells):
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def operations(figures: Any, _: Peers, function: str) -> str:
    """Multiplications, additions and negations; divisions."""
    if function not in figures["operations"]:
        return ""
    count = figures["operations"][function]
    divisions = f", {count['div']}" if count["div"] else ""
    return f"{count['mul'] + count['add'] + count['neg']}{divisions}"


def counts(figures: Any, peers: Peers, function: str) -> str:
    """Instructions, and their ratio to ours."""
    if function not in figures["instructions"]:
        return ""
    count = figures["instructions"][function]
    return f"{count:.0f} ({count / peers[OURS]['instructions'][function]:.2f})"


def times(figures: Any, _: Peers, function: str) -> str:
    """Median, quantiles of the blocks, range of the rounds."""
    if function not in figures["time"]:
        return ""
    median, low, high, first, last = figures["time"][function]
    return f"{median:.2f} ({low:.2f}-{high:.2f}; {first:.2f}-{last:.2f})"


def overview(arms: dict[str, Peers]) -> list[str]:
    """Geometric means over the arms of four joints and more."""
    big = {
        name: peers
        for name, peers in arms.items()
        if peers[OURS]["operations"]["inverse_dynamics"]["trig"] >= 2 * (_SMALL - 1)
    }
    lines = [
        f"Instructions relative to modelgen: geometric mean, lowest and highest over {len(big)} arms "
        f"({', '.join(big)}).",
        "",
        "| | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |",
        "|---|" + "---:|" * 4,
    ]
    for name in dict.fromkeys(name for peers in big.values() for name in peers if name != OURS):
        cells = []
        for f in FUNCTIONS:
            ratios = [
                peers[name]["instructions"][f] / peers[OURS]["instructions"][f]
                for peers in big.values()
                if f in peers.get(name, {}).get("instructions", {})
            ]
            if ratios:
                mean = exp(sum(map(log, ratios)) / len(ratios))
                cells.append(f"{mean:.2f} ({min(ratios):.2f}-{max(ratios):.2f})")
            else:
                cells.append("")
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines
