"""Joints as a mapping file has them, without the arm: no limits, no gears, an ampere is a newton metre."""

from __future__ import annotations

import json
from pathlib import Path

from modelgen.dataset.mapping.files import Foreign, load_mapping
from modelgen.dataset.mapping.schema import JointModel
from modelgen.dataset.mapping.units import EFFORTS, LENGTHS, POSITIONS
from modelgen.description import Arm, loads

DRIVE = {"type": "direct", "ratio": 1, "torque_constant": 1}


def arm_of(mapping: Path | str) -> Arm:
    """An arm of as many joints as the mapping file has, by whose units it can be read.

    Raises InputError for a mapping file with a mistake, and for units that a drive alone gives a meaning.
    """
    foreign = load_mapping(mapping)
    if foreign.joints is None:
        raise foreign.error("found no joints, expected them, or an arm too: modelgen inspect LOG ARMS", [])
    joints = [_joint(foreign, k, model) for k, model in enumerate(foreign.joints)]
    text = {"schema": 1, "convention": "khalil_kleinfinger", "arms": {"log": {"joints": joints}}}
    return loads(json.dumps(text), str(mapping))["log"]


def _joint(foreign: Foreign, k: int, model: JointModel) -> dict[str, object]:
    """The description of a joint: it slides where its position is a length."""
    position, effort = model.position, model.effort
    slides, at_motor = position.unit in LENGTHS, position.side == "motor"
    if position.unit not in {**POSITIONS["rad"], **LENGTHS} or (slides and at_motor):
        raise foreign.error(
            f"found the unit '{position.unit}' at the motor, which its drive makes a joint's position of, "
            "expected an arm too: modelgen inspect LOG ARMS --mapping FILE",
            ["joints", k, "position"],
        )
    kind = None if effort is None else EFFORTS[effort.unit][0]
    driven = kind in ("current", "duty", "voltage") or (effort is not None and effort.side == "motor")
    joint: dict[str, object] = {"name": f"j{k + 1}", "type": "prismatic" if slides else "revolute"}
    return joint | ({"drive": DRIVE} if driven else {})
