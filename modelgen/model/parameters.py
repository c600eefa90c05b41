"""The standard parameters of an arm: ten a link, then those of the effects."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.description.objects import Arm
from modelgen.effects import CATALOGUE, AppliedEffect
from modelgen.transmission import of_joint

LINK_PARAMETERS = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
FLUID_PARAMETERS = ("VX", "VY", "VZ", "V")
_UNITS = {"M": "kg", "V": "m^3"}


@dataclass(frozen=True)
class StandardParameter:
    """One standard parameter.

    `joint` is the index of its link or joint in `arm.joints`, None for the whole arm; `name` carries that
    number from 1.
    """

    name: str
    unit: str
    joint: int | None
    text: str


def link_parameters(index: int, joint_name: str, fluid: bool) -> list[StandardParameter]:
    """The parameters of one link: inertia tensor and first moments about the origin of its frame."""
    result = []
    for symbol in LINK_PARAMETERS + (FLUID_PARAMETERS if fluid else ()):
        if symbol in _UNITS:
            unit = _UNITS[symbol]
        elif len(symbol) == 2 and symbol[0] == "M":
            unit = "kg m"
        elif symbol[0] == "V":
            unit = "m^4"
        else:
            unit = "kg m^2"
        text = f"{_TEXT[symbol]} of link {joint_name}"
        result.append(StandardParameter(f"{symbol}{index + 1}", unit, index, text))
    return result


_TEXT = {
    **{s: f"inertia tensor element {s.lower()} about the frame origin" for s in LINK_PARAMETERS[:6]},
    **{f"M{a}": f"first moment of mass along {a.lower()}" for a in "XYZ"},
    "M": "mass",
    **{f"V{a}": f"first moment of the displaced volume along {a.lower()}" for a in "XYZ"},
    "V": "displaced volume",
}


def effect_parameters(arm: Arm, effect: AppliedEffect) -> list[StandardParameter]:
    """The linear parameters of one effect, named by the number of its joint if it stands at one."""
    whose = "the arm" if effect.joint is None else f"joint {arm.joints[effect.joint].name}"
    return [
        StandardParameter(
            symbol.name,
            unit_of(
                parameter.unit,
                coordinate_unit(arm, effect),
                "m" if effect.joint is None else arm.joints[effect.joint].unit,
            ),
            effect.joint,
            f"{parameter.text} ({effect.effect.name}) of {whose}",
        )
        for parameter, symbol in effect.parameters
    ]


def units_at(arm: Arm, effect: str, joint: int | None) -> dict[str, str]:
    """Units of an effect's parameters by name, at a coordinate (from 1) or for the whole arm."""
    coordinate = own = "m"
    if joint is not None:
        described = arm.joints[arm.coordinates[joint - 1]]
        drive = of_joint(arm, described)
        coordinate = own = described.unit
        if CATALOGUE[effect].side == "motor" and drive.driven:
            coordinate = drive.unit
    return {p.name: unit_of(p.unit, coordinate, own) for p in CATALOGUE[effect].accepted()}


def coordinate_unit(arm: Arm, effect: AppliedEffect) -> str:
    """Unit of the coordinate that the effect belongs to: rad, m, or the motor's unit."""
    if effect.joint is None:
        return "m"
    joint = arm.joints[effect.joint]
    transmission = of_joint(arm, joint)
    if effect.side == "motor" and transmission.driven:
        return transmission.unit
    return joint.unit


def unit_of(pattern: str, coordinate: str, joint: str = "rad") -> str:
    """A parameter's unit from its pattern over {f}, the force, {x}, the coordinate, and {q}, the joint's.

    joint: unit of the joint's coordinate.
    """
    force = {"rad": "N m", "m": "N"}.get(coordinate)
    if force:
        return pattern.format(f=force, x=coordinate, q=joint)
    if "{f}" not in pattern:
        return pattern.format(x=coordinate, q=joint)
    over, _, under = pattern.replace("{f}", "J").partition("/")
    own = f"{over}/{coordinate}" + ("^2" if "{x}" in under else "")
    return f"{over}/({coordinate} {under.format(q=joint)})" if "{q}" in under else own
