"""A calibrated lever in the description of its arm."""

from __future__ import annotations

import io
import math
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from modelgen.calibration.lever import Lever
from modelgen.description import Arm


def calibrated_yaml(arm: Arm, joint: int, lever: Lever) -> str:
    """The arm's part of its description with the lever of coordinate `joint` (from 1) as found.

    Where the joint has limits of position they become those of the stroke, which the description demands
    to agree. Order and comments stay, but those at the end of a line whose value is another one now.
    """
    yaml = YAML()
    yaml.width = 110
    whole = yaml.load(arm.document)
    entry: CommentedMap = whole["arms"][arm.name]
    own: CommentedMap = entry["joints"][arm.coordinates[joint - 1]]
    drive: CommentedMap = own["drive"]
    l1, l2, low, high, offset = (float(f"{x:.9g}") for x in lever.values)
    found = {"l1": l1, "l2": l2, "rev": lever.rev, "length": _flow([low, high]), "offset": _degrees(offset)}
    for key, value in found.items():
        _replace(drive, key, value)
    limits = own.get("limits")
    if limits and limits.get("position") is not None:
        ends = lever.angle(np.array(lever.motor, dtype=np.float64))
        _replace(limits, "position", _flow([_degrees(float(x)) for x in sorted(ends)]))
    document = CommentedMap()
    for key in ("schema", "convention"):
        if key in whole:
            document[key] = whole[key]
    document["arms"] = CommentedMap({arm.name: entry})
    out = io.StringIO()
    yaml.dump(document, out)
    return out.getvalue()


def _replace(entry: CommentedMap, key: str, value: Any) -> None:
    """Another value, without what the comment at the end of its line said of the one before."""
    if key in entry and entry[key] == value:
        return
    entry[key] = value
    token = (entry.ca.items.get(key) or [None] * 3)[2]
    if token is not None and not token.value.startswith("\n"):
        token.value = "\n" + token.value.partition("\n")[2]  # lines of its own belong to the next key


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.7g} deg"


def _flow(items: list[float] | list[str]) -> CommentedSeq:
    made = CommentedSeq(items)
    made.fa.set_flow_style()
    return made
