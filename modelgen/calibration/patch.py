"""A calibrated lever in the description of its arm."""

from __future__ import annotations

import io
import math

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from modelgen.calibration.lever import Lever
from modelgen.description import Arm


def calibrated_yaml(arm: Arm, joint: int, lever: Lever) -> str:
    """The arm's part of its description with the lever of coordinate `joint` (from 1) as found.

    Where the joint has limits of position they become those of the stroke, which the description demands
    to agree. Comments and order stay.
    """
    yaml = YAML()
    yaml.width = 110
    whole = yaml.load(arm.document)
    entry: CommentedMap = whole["arms"][arm.name]
    own: CommentedMap = entry["joints"][arm.coordinates[joint - 1]]
    drive: CommentedMap = own["drive"]
    l1, l2, low, high, offset = (float(f"{x:.9g}") for x in lever.values)
    drive["l1"], drive["l2"], drive["rev"] = l1, l2, lever.rev
    drive["length"] = _flow([low, high])
    drive["offset"] = _degrees(offset)
    limits = own.get("limits")
    if limits and limits.get("position") is not None:
        ends = lever.angle(np.array(lever.motor, dtype=np.float64))
        limits["position"] = _flow([_degrees(float(x)) for x in sorted(ends)])
    document = CommentedMap()
    for key in ("schema", "convention"):
        if key in whole:
            document[key] = whole[key]
    document["arms"] = CommentedMap({arm.name: entry})
    out = io.StringIO()
    yaml.dump(document, out)
    return out.getvalue()


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.7g} deg"


def _flow(items: list[float] | list[str]) -> CommentedSeq:
    made = CommentedSeq(items)
    made.fa.set_flow_style()
    return made
