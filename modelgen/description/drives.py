"""Drives of the description: their figures, and the joint range that they allow."""

from __future__ import annotations

import math
from typing import Any

from modelgen.description.context import Context, show
from modelgen.description.document import Steps
from modelgen.description.schema import DriveModel, MotorModel
from modelgen.symbolic import Range
from modelgen.transmission import KINDS, Drive, Figure, FigureError, MotorLimits

# Joint range and stroke come from different measurements: below `ROUNDING` the cut is not worth a remark,
# beyond `DISAGREEMENT` one of the two must be wrong.
ROUNDING = math.radians(0.01)
DISAGREEMENT = math.radians(0.5)


def read_drive(context: Context, model: DriveModel, joint_type: str, steps: Steps) -> Drive:
    """The drive of a joint of the given type. Raises InputError."""
    kind: Any = KINDS[model.type]
    if not kind.driven:
        undriven: Drive = kind()
        return undriven
    if joint_type == "fixed":
        raise context.error("found a drive on a fixed joint, expected none", steps, key=True)
    refusal = kind.refusal(joint_type)
    if refusal:
        raise context.error(refusal, [*steps, "type"])
    given = {
        name: _read(context, getattr(model, name), figure, [*steps, name])
        for name, figure in kind.figures().items()
    }
    drive: Drive = kind(**given, **_motor(context, model, steps))
    try:
        drive.numeric(context.symbols).reach()
    except FigureError as error:
        raise context.error(str(error), [*steps, *error.at]) from None
    except ValueError as error:
        raise context.error(str(error), steps) from None
    return drive


def _read(context: Context, raw: Any, figure: Figure, steps: Steps) -> Any:
    """The value of a figure."""
    if figure.pair:
        return tuple(_one(context, x, figure, [*steps, i]) for i, x in enumerate(raw))
    return _one(context, raw, figure, steps)


def _one(context: Context, raw: float | str, figure: Figure, steps: Steps) -> Any:
    if figure.kind == "sign":
        return raw
    read = context.nonzero if figure.must == "nonzero" else context.quantity
    quantity = read(raw, figure.kind, steps)
    if figure.must == "positive" and quantity.value <= 0.0:
        unit, what = (" m", "length") if figure.kind == "length" else ("", "value")
        raise context.error(f"found {quantity.value:g}{unit}, expected a {what} above 0", steps)
    return quantity.scalar if figure.symbolic else quantity.value


def _motor(context: Context, model: DriveModel, steps: Steps) -> dict[str, Any]:
    assert isinstance(model, MotorModel)
    return {
        "torque_constant": context.nonzero(model.torque_constant, "plain", [*steps, "torque_constant"]).value,
        "limits": MotorLimits(
            velocity=context.positive(model.motor_velocity, "plain", [*steps, "motor_velocity"]),
            acceleration=context.positive(model.motor_acceleration, "plain", [*steps, "motor_acceleration"]),
            current=context.positive(model.current, "plain", [*steps, "current"]),
        ),
    }


def within_reach(
    context: Context, joint: str, position: Range | None, drive: Drive, kind: str, steps: Steps
) -> Range | None:
    """The joint range, cut to the drive's reach where they disagree a little.

    Raises InputError where by more. Without a joint range, the drive's counts. kind: of the joint's
    coordinate, "angle" or "length".
    """
    reach = drive.numeric(context.symbols).reach()
    if reach is None or position is None:
        return position if reach is None else reach
    excess = max(reach[0] - position[0], position[1] - reach[1])
    shown = f"{show(position[0], kind)} to {show(position[1], kind)}"
    allowed = f"{show(reach[0], kind)} to {show(reach[1], kind)}"
    if excess >= DISAGREEMENT:
        calibrated = " until modelgen calibrate has found them" if drive.actuator else ""
        raise context.error(
            f"found the joint range {shown}, but the actuator's stroke allows {allowed}; "
            f"correct the range, or the drive's {drive.decides_reach}; where these are not known well, leave "
            f"the range out{calibrated}",
            steps,
        )
    cut = max(position[0], reach[0]), min(position[1], reach[1])
    if excess > ROUNDING:
        context.notes.append(
            f"{joint}: the joint range {shown} is cut to {show(cut[0], kind)} to {show(cut[1], kind)}, "
            f"which the actuator's stroke allows"
        )
    return cut
