"""The candidates of every turn, with why each is no cause."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.selection import COARSE, EXCHANGED, SUPERFLUOUS, SUSPECT, History, Ranked
from modelgen.report.words import place_of

# Why a candidate is no cause, by the condition that it missed, or why it did not stay one.
_REFUSED = {
    "evidence": "too little evidence",
    "values": "values that the effect cannot have",
    "gain": "gains too little on records that its fit has not seen",
    "positions": "gains no more than errors of the positions could feign",
    "other joints": "makes other joints worse",
    "one joint": "does more at one joint alone",
    "near rest": "its exponent is the least that is searched: friction near rest, for which there is a law",
    EXCHANGED: "chosen, then exchanged: another one explains more with all values found anew",
    SUPERFLUOUS: "chosen, then superfluous beside the others",
    SUSPECT: "chosen, then dropped: it failed a check, see the suspects",
    COARSE: "chosen, then dropped: the positions are too coarse to separate it from others",
}
_SHOWN = 12  # candidates of a turn


def rankings(arm: Arm, turns: History) -> list[tuple[str, list[Sequence[str]]]]:
    """Heading and rows of every turn that had candidates, of the best of them."""
    headings = ["Candidates", *[f"Candidates beside what turn {k} chose" for k in range(1, len(turns) + 1)]]
    return [
        (heading + (f": {_SHOWN} of {len(turn)}" if len(turn) > _SHOWN else ""), _rows(arm, turn))
        for heading, turn in zip(headings, turns, strict=False)
        if turn
    ]


def strongest(arm: Arm, turns: History) -> str:
    """The first turn's candidate with most evidence, and why it is no cause; empty where none was tried."""
    if not turns or not turns[0]:
        return ""
    best = max(turns[0], key=lambda r: r.delta_bic)
    why = _REFUSED.get(best.refused, "")
    said = f"of {len(turns[0])} the most evidence has {best.effect} at {place_of(arm, best.joint)}"
    return f"{said}, delta BIC {best.delta_bic:z.1f}{f': {why}' if why else ''}"


def _rows(arm: Arm, turn: Sequence[Ranked]) -> list[Sequence[str]]:
    """The candidates of one turn with their evidence, the losing ones too."""
    rows: list[Sequence[str]] = []
    chosen = next((r for r in turn if r.chosen), None)
    for r in turn[:_SHOWN]:
        word = _REFUSED.get(r.refused) or _passed(r, chosen)
        gains = ["" if g is None or np.isnan(g) else f"{g:z.1f}" for g in (r.cross_gain, r.expected_gain)]
        rows.append((r.effect, place_of(arm, r.joint), f"{r.delta_bic:z.1f}", *gains, word))
    return rows


def _passed(r: Ranked, chosen: Ranked | None) -> str:
    """Why a candidate that meets every condition was not chosen in its turn, if it was not."""
    if r.chosen:
        return "chosen"
    if chosen is not None and r.delta_bic < chosen.delta_bic:
        return f"explains less than {chosen.effect}, by {chosen.delta_bic - r.delta_bic:z.0f}"
    return "meets every condition too"
