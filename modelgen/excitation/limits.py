"""Limits of an arm's coordinates, on both sides of the drives, and what is missing among them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from modelgen.dataset import drives_of
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.options import ExcitationOptions
from modelgen.transmission import of_joint


@dataclass(frozen=True)
class Bound:
    """low <= signal of a coordinate <= high; signal: q, dq, ddq, qm, dqm, ddqm, input or effort."""

    signal: str
    coordinate: int
    low: float
    high: float


def bounds(arm: Arm, settings: ExcitationOptions) -> tuple[list[Bound], list[str]]:
    """All limits of the arm, and remarks on those that were assumed.

    Raises InputError for a joint without a speed limit, and for a prismatic one without a range.
    """
    found: list[Bound] = []
    remarks: list[str] = []
    for n, i in enumerate(arm.coordinates):
        joint, own = arm.joints[i], arm.joints[i].limits
        transmission = of_joint(arm, joint)
        position = own.position
        stroke = transmission.motor_range()
        if stroke:
            found.append(Bound("qm", n, *stroke))
        elif position is None:
            if joint.type == "prismatic":
                raise InputError(
                    f"{arm.name}: joint {joint.name} has no range, expected "
                    "limits: {position: [low, high]}",
                    joint.where,
                )
            position = (-math.pi, math.pi)
            remarks.append(f"{joint.name} has no limits: {{position: ...}}; -180 to 180 deg are used")
        if position is not None:
            found.append(Bound("q", n, *position))
        motor = joint.drive.limits
        speed, acceleration = own.velocity, own.acceleration
        if speed is None and motor.velocity is None:
            speed = settings.velocity
            if speed is None:
                raise InputError(
                    f"{arm.name}: joint {joint.name} has no speed limit, expected limits: {{velocity: ...}} "
                    "in the description (or drive: {motor_velocity: ...}), or --velocity",
                    joint.where,
                )
        if acceleration is None and motor.acceleration is None:
            acceleration = settings.acceleration
        for signal, most in (
            ("dq", speed),
            ("ddq", acceleration),
            ("effort", own.effort),
            ("dqm", motor.velocity),
            ("ddqm", motor.acceleration),
            ("input", motor.current),
        ):
            if most is not None:
                found.append(Bound(signal, n, -most, most))
    return found, remarks


def ranges(arm: Arm, limits: list[Bound], coordinates: str) -> tuple[Array, Array]:
    """Middle and half width (n,) of each coordinate's range, in motor or in joint coordinates."""
    ends = []
    for n, drive in enumerate(drives_of(arm)):
        own = {b.signal: np.array([b.low, b.high]) for b in limits if b.coordinate == n}
        both = [own["q"]] if "q" in own else []
        if "qm" in own:
            both.append(np.sort(drive.joint(own["qm"])))
        joint = np.array([max(x[0] for x in both), min(x[1] for x in both)])
        ends.append(np.sort(drive.motor(joint)) if coordinates == "motor" else joint)
    table = np.array(ends)
    return table.mean(axis=1), np.diff(table, axis=1)[:, 0] / 2


def speeds(arm: Arm, limits: list[Bound], coordinates: str) -> Array:
    """Largest speeds (n,) of the coordinates, in motor or in joint coordinates."""
    middle, half = ranges(arm, limits, "joint")
    found = []
    for n, drive in enumerate(drives_of(arm)):
        ratio = np.abs(drive.k1(np.linspace(middle[n] - half[n], middle[n] + half[n], 101)))
        own = {b.signal: b.high for b in limits if b.coordinate == n}
        motor = [own["dqm"]] if "dqm" in own else []
        joint = [own["dq"]] if "dq" in own else []
        if coordinates == "motor":
            found.append(min([*motor, *(x * ratio.max() for x in joint)]))
        else:
            found.append(min([*joint, *(x / ratio.min() for x in motor)]))
    return np.array(found)
