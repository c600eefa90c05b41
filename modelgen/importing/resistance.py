"""What a joint resists with and stores, as effects of the catalogue, and its gear as a drive.

The effects say themselves what robot files call their parameters (`Traits.sources`), and which laws are
theirs (`Definition.recognised`).
"""

from __future__ import annotations

from collections.abc import Mapping

from modelgen.effects import CATALOGUE
from modelgen.importing.robot import SourceJoint, SourcePair
from modelgen.transmission import DirectDrive, LeveredDrive

# Power of the gear by which a coefficient of damping is greater at the joint than at the motor.
POWERS: Mapping[str, int] = {"quadratic": 3, "cubic": 4}

Entry = str | float | tuple[float, float]


def effects_of(joint: SourceJoint) -> dict[str, dict[str, float]]:
    """Values of the parameters of the joint's effects, by effect, in the units of the drive's coordinate."""
    found: dict[str, dict[str, float]] = {}
    terms = {law: joint.properties[law] for law in POWERS if law in joint.properties}
    for own in [*({law: v / abs(joint.reduction) ** POWERS[law]} for law, v in terms.items()), *joint.alone]:
        for name, effect in CATALOGUE.items():
            values = effect.recognised(own)
            if values:
                found.setdefault(name, dict(values))
    for name, effect in CATALOGUE.items():
        units = {parameter.name: parameter.unit for parameter in effect.accepted()}
        for source, parameter in effect.sources.items():
            if source in joint.properties:
                value = joint.properties[source]
                if effect.side == "motor":
                    value /= _scale(units[parameter], joint.reduction)
                found.setdefault(name, {})[parameter] = value
    return found


def shared_by(pair: SourcePair, other: int) -> dict[str, dict[str, float]]:
    """The same of what turns with two joints. other: the second one's number from 1."""
    terms = {law: pair.properties.get(law, 0.0) for law in ("armature", "damping", "friction")}
    own = {**terms, "other": float(other), "ratio": pair.ratio}
    return {name: dict(values) for name, e in CATALOGUE.items() if (values := e.recognised(own))}


def _scale(unit: str, reduction: float) -> float:
    """How much greater a parameter of this unit is at the joint than at the motor."""
    return float(abs(reduction) ** (unit.count("{f}") + unit.count("{x}")))


def drive_of(joint: SourceJoint) -> Mapping[str, Entry]:
    """Entries of the joint's drive: a gear or a lever; none where input and effort are the same.

    Where the source knows no torque constants the input is the motor's own torque or force. The motor
    coordinate of a lever is counted from the length zero.
    """
    lever = joint.lever
    limits = {} if joint.most is None else {"current": joint.most}
    if lever is not None:
        return {
            "type": LeveredDrive.name,
            "l1": lever.l1,
            "l2": lever.l2,
            "length": lever.length,
            "motor": (joint.reduction * lever.length[0], joint.reduction * lever.length[1]),
            "rev": float(lever.rev),
            "offset": lever.offset,
            "torque_constant": joint.gain,
            **limits,
        }
    if joint.reduction == 1.0 and joint.gain == 1.0:
        return {}
    return {"type": DirectDrive.name, "ratio": joint.reduction, "torque_constant": joint.gain, **limits}
