"""From an arm and its values to a machine: frames in numbers, drives, limits."""

from __future__ import annotations

import math

import numpy as np

from modelgen.dataset import drives_of
from modelgen.description.objects import Arm, Joint, Transform
from modelgen.effects import pivot_direction
from modelgen.exporting.machine import Axis, Lever, Link, Machine, Tool
from modelgen.exporting.values import Values
from modelgen.importing.frames import Parameters
from modelgen.importing.poses import pose
from modelgen.numeric import Array
from modelgen.symbolic import number
from modelgen.transmission import of_joint


def machine_of(arm: Arm, values: Values) -> Machine:
    """The machine, whose coordinates have no properties yet."""
    numbers = {i: n for n, i in enumerate(arm.coordinates)}
    base = _matrix(arm.base) if arm.base is not None else np.eye(4)
    links = tuple(_link(arm, i, joint, numbers.get(i), values) for i, joint in enumerate(arm.joints))
    return Machine(
        name=arm.name,
        source=" ".join(arm.source.split()),
        base=base,
        gravity=base[:3, :3] @ np.array(arm.gravity),
        links=links,
        order=arm.order,
        tools=tuple(Tool(tool.name, tool.link, _matrix(tool.transform)) for tool in arm.tools),
    )


def range_of(arm: Arm, i: int) -> tuple[float, float]:
    """Lowest and highest coordinate of a joint: its limits, its drive's reach, or half a turn or 1 m."""
    joint = arm.joints[i]
    reach = of_joint(arm, joint).joint_range()
    wide = 1.0 if joint.type == "prismatic" else math.pi
    low, high = joint.limits.position or reach or (-wide, wide)
    if reach is not None:
        low, high = max(low, reach[0]), min(high, reach[1])
    return low, high


def _matrix(transform: Transform) -> Array:
    return pose(np.array(transform.rotation), np.array(transform.translation))


def _link(arm: Arm, i: int, joint: Joint, n: int | None, values: Values) -> Link:
    held = joint.locked or 0.0
    slides = joint.type == "prismatic"
    figures = (joint.gamma, joint.b, joint.alpha, joint.d, joint.theta, joint.r)
    frame = Parameters(*(number(x, arm.symbols) for x in figures)).transform(
        0.0 if slides else held, held if slides else 0.0
    )
    limits = joint.limits
    return Link(
        name=joint.name,
        kind="fixed" if n is None else joint.type,
        before=joint.antecedent,
        pose=frame,
        body=values.bodies[i],
        position=limits.position or (None if n is None else of_joint(arm, joint).joint_range()),
        velocity=limits.velocity,
        effort=limits.effort,
        axis=None if n is None else _axis(arm, i, n),
    )


def _axis(arm: Arm, i: int, n: int) -> Axis:
    joint, drive = arm.joints[i], drives_of(arm)[n]
    low, high = range_of(arm, i)
    q = np.array([(low + high) / 2])
    ratio = drive.ratio if drive.ratio is not None else float(drive.k1(q)[0])
    middle = (0.0, 0.0) if drive.ratio is not None else (float(q[0]), float(drive.motor(q)[0]))
    return Axis(
        number=n,
        driven=drive.driven,
        ratio=ratio,
        middle=middle,
        gain=drive.torque_constant,
        varies=of_joint(arm, joint).varies,
        lever=_lever(arm, joint),
        current=joint.drive.limits.current,
    )


def _lever(arm: Arm, joint: Joint) -> Lever | None:
    """The points of a lever's actuator; where its base stands about the axis has no effect on the motion."""
    actuator = joint.drive.numeric(arm.symbols).actuator
    if actuator is None:
        return None
    l1, l2 = float(actuator.l1), float(actuator.l2)
    (first, last), (begin, end) = map(float, actuator.length), actuator.motor
    gamma, b, alpha, d, r = (
        number(x, arm.symbols) for x in (joint.gamma, joint.b, joint.alpha, joint.d, joint.r)
    )
    foot = Parameters(gamma, b, alpha, d, 0.0, r).transform()
    toward = pivot_direction(joint) or 0.0
    angle = toward - float(actuator.offset) - number(joint.theta, arm.symbols)
    per_length = (end - begin) / (last - first)
    return Lever(
        base=(foot @ np.array([l1 * math.cos(toward), l1 * math.sin(toward), 0.0, 1.0]))[:3],
        tip=np.array([l2 * math.cos(angle), l2 * math.sin(angle), 0.0]),
        per_length=per_length,
        zero=first - begin / per_length,
    )
