"""Rests of parts that turn with two joints: their dry friction is undetermined there, as a joint's is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.dataset.rest import moving_samples
from modelgen.description import Arm

if TYPE_CHECKING:
    from modelgen.diagnosis.candidates import Candidate
    from modelgen.diagnosis.rows import Rows

COUPLING = "transmission_coupling"


def turning(prepared: Prepared, joint: int, values: Mapping[str, float]) -> NDArray[np.bool_]:
    """(M, n), rows at which a coupling moves, as far as the equations of its two joints are concerned.

    joint: number of the coordinate it belongs to, from 1. values: of its `other` and `ratio`.
    """
    one, other, ratio = joint - 1, round(values["other"]) - 1, values["ratio"]
    gates = prepared.settings.gates
    own = replace(prepared.settings, gates=(gates[one] + abs(ratio) * gates[other],))
    speed = prepared.dq[:, [one]] + ratio * prepared.dq[:, [other]]
    found = np.ones((len(prepared.rows), prepared.n), dtype=bool)
    found[:, [one, other]] = moving_samples(speed, prepared.rows, own, 1.0 / prepared.record.step)
    return found


def of_arm(arm: Arm, prepared: Prepared) -> NDArray[np.bool_]:
    """(M, n), rows at which all couplings of the arm's description move; all of a free motion."""
    found = np.ones((len(prepared.rows), prepared.n), dtype=bool)
    if prepared.input is None:
        return found
    for number, i in enumerate(arm.coordinates, start=1):
        for used in arm.joints[i].effects:
            if used.name == COUPLING:
                found &= turning(prepared, number, {"ratio": 1.0, **used.values})
    return found


def without_rests(rows: Sequence[Rows], candidate: Candidate) -> Sequence[Rows]:
    """The rows at which a cause that was taken moves; all where it has no rest of its own."""
    if candidate.effect != COUPLING or candidate.joint is None:
        return rows
    where = [turning(r.prepared, candidate.joint, candidate.fixed) for r in rows]
    return [replace(r, moving=r.moving & flags) for r, flags in zip(rows, where, strict=True)]
