"""Drives of the description: their figures, a lever's triangle, the joint range that its stroke allows."""

from __future__ import annotations

import math

from modelgen.description.context import Context, show
from modelgen.description.document import Steps
from modelgen.description.expressions import Quantity
from modelgen.description.objects import (
    DirectDrive,
    Drive,
    LeveredDrive,
    LinkageDrive,
    MotorLimits,
    NoDrive,
    Range,
)
from modelgen.description.schema import (
    AnyDriveModel,
    DirectDriveModel,
    LeveredDriveModel,
    LinkageModel,
    MotorModel,
    NoDriveModel,
)
from modelgen.linkages import LINKAGES

# Nearer than this to a dead centre the lever passes on next to no effort, and rounding decides its branch.
DEAD_CENTRE_MARGIN = math.radians(0.5)
# Joint range and stroke come from different measurements: below `ROUNDING` the cut is not worth a remark,
# beyond `DISAGREEMENT` one of the two must be wrong.
ROUNDING = math.radians(0.01)
LEVER = "length, rev or offset"  # what of a lever its range depends on
DISAGREEMENT = math.radians(0.5)


def read_drive(context: Context, model: AnyDriveModel, joint_type: str, steps: Steps) -> Drive:
    """The drive of a joint of the given type. Raises InputError."""
    match model:
        case NoDriveModel():
            return NoDrive()
        case _ if joint_type == "fixed":
            raise context.error("found a drive on a fixed joint, expected none", steps, key=True)
        case DirectDriveModel():
            return DirectDrive(
                ratio=context.nonzero(model.ratio, "plain", [*steps, "ratio"]).scalar,
                torque_constant=_torque_constant(context, model, steps),
                limits=_motor_limits(context, model, steps),
            )
        case LeveredDriveModel() if joint_type != "revolute":
            raise context.error(
                "found a levered drive on a prismatic joint; a lever turns a revolute joint, "
                "a ball-screw axis is direct with ratio 2*pi/lead",
                [*steps, "type"],
            )
        case LeveredDriveModel():
            return _levered(context, model, steps)
        case LinkageModel():
            return _linkage(context, model, joint_type, steps)


def _levered(context: Context, model: LeveredDriveModel, steps: Steps) -> LeveredDrive:
    l1, l2 = (_length(context, raw, [*steps, name]) for name, raw in (("l1", model.l1), ("l2", model.l2)))
    ends = [_length(context, raw, [*steps, "length", i]) for i, raw in enumerate(model.length)]
    if ends[0].value == ends[1].value:
        raise context.error(f"both lengths are {ends[0].value:g} m, expected a stroke", [*steps, "length"])
    motor = context.numbers(model.motor, "plain", [*steps, "motor"])
    if motor[0] == motor[1]:
        raise context.error(f"both motor values are {motor[0]:g}, expected a range", [*steps, "motor"])
    _check_triangle(context, l1.value, l2.value, [end.value for end in ends], [*steps, "length"])
    return LeveredDrive(
        l1=l1.scalar,
        l2=l2.scalar,
        length=(ends[0].scalar, ends[1].scalar),
        motor=(motor[0], motor[1]),
        rev=model.rev,
        offset=context.quantity(model.offset, "angle", [*steps, "offset"]).scalar,
        torque_constant=_torque_constant(context, model, steps),
        limits=_motor_limits(context, model, steps),
    )


def _linkage(context: Context, model: LinkageModel, joint_type: str, steps: Steps) -> LinkageDrive:
    linkage = LINKAGES[model.type]
    if joint_type != linkage.joint:
        raise context.error(
            f"found a drive {model.type} on a {joint_type} joint, expected a {linkage.joint} one",
            [*steps, "type"],
        )
    found = {
        f.name: context.quantity(getattr(model, f.name), f.kind, [*steps, f.name]) for f in linkage.figures
    }
    try:
        linkage.reach({name: quantity.value for name, quantity in found.items()})
    except ValueError as error:
        raise context.error(str(error), steps) from None
    return LinkageDrive(
        linkage=model.type,
        figures={name: quantity.scalar for name, quantity in found.items()},
        torque_constant=_torque_constant(context, model, steps),
        limits=_motor_limits(context, model, steps),
    )


def _length(context: Context, raw: float | str, steps: Steps) -> Quantity:
    quantity = context.quantity(raw, "length", steps)
    if quantity.value <= 0.0:
        raise context.error(f"found {quantity.value:g} m, expected a length above 0", steps)
    return quantity


def _torque_constant(context: Context, model: MotorModel, steps: Steps) -> float:
    return context.nonzero(model.torque_constant, "plain", [*steps, "torque_constant"]).value


def _motor_limits(context: Context, model: MotorModel, steps: Steps) -> MotorLimits:
    return MotorLimits(
        velocity=context.positive(model.motor_velocity, "plain", [*steps, "motor_velocity"]),
        acceleration=context.positive(model.motor_acceleration, "plain", [*steps, "motor_acceleration"]),
        current=context.positive(model.current, "plain", [*steps, "current"]),
    )


def inner_angle(l1: float, l2: float, length: float) -> float:
    """Angle [rad] at the joint axis of the triangle l1, l2, length [m] (law of cosines), within [0, pi]."""
    # The squares are taken of ratios, so that no length is too large or too small for them.
    cosine = (l1 / l2 + l2 / l1 - (length / l1) * (length / l2)) / 2
    return math.acos(min(1.0, max(-1.0, cosine)))


def _check_triangle(context: Context, l1: float, l2: float, ends: list[float], steps: Steps) -> None:
    low, high = abs(l1 - l2), l1 + l2
    for i, length in enumerate(ends):
        if not low <= length <= high:
            raise context.error(
                f"found the actuator length {length:g} m, an impossible triangle: with l1 = {l1:g} m and "
                f"l2 = {l2:g} m it must lie between |l1 - l2| = {low:g} m and l1 + l2 = {high:g} m",
                [*steps, i],
            )
        angle = inner_angle(l1, l2, length)
        if not DEAD_CENTRE_MARGIN <= angle <= math.pi - DEAD_CENTRE_MARGIN:
            centre = "0" if angle < 1.0 else "180"
            raise context.error(
                f"at the length {length:g} m the stroke reaches the lever's dead centre: inner angle "
                f"{math.degrees(angle):.3g} deg, expected at least {math.degrees(DEAD_CENTRE_MARGIN):g} deg "
                f"from {centre} deg",
                [*steps, i],
            )


def stroke_range(context: Context, model: LeveredDriveModel | LinkageModel, steps: Steps) -> Range:
    """Joint range [rad, m] that the actuator's stroke, or the linkage's reach, allows."""
    if isinstance(model, LinkageModel):
        linkage = LINKAGES[model.type]
        return linkage.reach(
            {f.name: context.number(getattr(model, f.name), f.kind, steps) for f in linkage.figures}
        )
    l1, l2 = context.number(model.l1, "length", steps), context.number(model.l2, "length", steps)
    offset = context.number(model.offset, "angle", steps)
    lengths = context.numbers(model.length, "length", steps)
    ends = sorted(model.rev * inner_angle(l1, l2, length) + offset for length in lengths)
    return ends[0], ends[1]


def within_stroke(
    context: Context,
    joint: str,
    position: Range | None,
    stroke: Range,
    steps: Steps,
    figures: str = LEVER,
) -> Range:
    """The joint range, cut to the stroke where they disagree a little. Raises InputError where by more.

    Without a joint range, the stroke's is taken.
    """
    if position is None:
        return stroke
    excess = max(stroke[0] - position[0], position[1] - stroke[1])
    shown = f"{show(position[0], 'angle')} to {show(position[1], 'angle')}"
    allowed = f"{show(stroke[0], 'angle')} to {show(stroke[1], 'angle')}"
    if excess >= DISAGREEMENT:
        raise context.error(
            f"found the joint range {shown}, but the actuator's stroke allows {allowed}; "
            f"correct the range, or the drive's {figures}; where these are not known well, leave the range "
            f"out{' until modelgen calibrate has found them' if figures == LEVER else ''}",
            steps,
        )
    cut = max(position[0], stroke[0]), min(position[1], stroke[1])
    if excess > ROUNDING:
        context.notes.append(
            f"{joint}: the joint range {shown} is cut to {show(cut[0], 'angle')} to {show(cut[1], 'angle')}, "
            f"which the actuator's stroke allows"
        )
    return cut
