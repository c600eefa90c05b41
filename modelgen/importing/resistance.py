"""What a joint resists with and stores, as effects of the catalogue, and its gear as a drive.

The effects say themselves what robot files call their parameters (`Traits.sources`).
"""

from __future__ import annotations

from collections.abc import Mapping

from modelgen.effects import CATALOGUE
from modelgen.importing.robot import SourceJoint


def effects_of(joint: SourceJoint) -> dict[str, dict[str, float]]:
    """Values of the parameters of the joint's effects, by effect, in the units of the drive's coordinate."""
    found: dict[str, dict[str, float]] = {}
    for name, effect in CATALOGUE.items():
        units = {parameter.name: parameter.unit for parameter in effect.accepted()}
        for source, parameter in effect.sources.items():
            if source in joint.properties:
                value = joint.properties[source]
                if effect.side == "motor":
                    value /= _scale(units[parameter], joint.reduction)
                found.setdefault(name, {})[parameter] = value
    return found


def _scale(unit: str, reduction: float) -> float:
    """How much greater a parameter of this unit is at the joint than at the motor."""
    return float(abs(reduction) ** (unit.count("{f}") + unit.count("{x}")))


def drive_of(joint: SourceJoint) -> Mapping[str, float]:
    """Figures of a direct drive with the joint's gear; nothing where input and effort are the same.

    The input is then the motor's own torque or force: sources know no torque constants.
    """
    if joint.reduction == 1.0:
        return {}
    return {"ratio": joint.reduction, "torque_constant": 1.0}
