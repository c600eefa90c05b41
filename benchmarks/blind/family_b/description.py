"""What the user writes: arms.yaml by modified Denavit-Hartenberg parameters, and the mapping of the logs."""

from __future__ import annotations

import math

import numpy as np

from blind.case import Array
from blind.family_b.equations import joint_angle
from blind.family_b.plan import Plan, motor_grain
from blind.family_b.world import World

NAME = "stranger"
LONGEST = 2.8  # rad, lever angle at the long end of the stroke


def unit(world: World, plan: Plan, axis: int) -> float:
    """Motor coordinate of the description by radian of the motor: increments where it moves a lever."""
    return 1 / motor_grain(plan, axis) if world.joints[axis].get("levered") else 1.0


def arms_text(world: World, plan: Plan, rng: np.random.Generator) -> str:
    """arms.yaml of the world as its user believes it to be."""
    g = [world.arm.get(k, 0.0) for k in ("gx", "gy", "gz")]
    lines = ["schema: 1", "convention: khalil_kleinfinger", "arms:", f"  {NAME}:"]
    lines += [
        "    source: benchmarks/blind/family_b",
        f"    gravity: [{', '.join(map(repr, g))}]",
        "    joints:",
    ]
    planar = len(world.axes) == 2
    for number, axis in enumerate(world.axes, start=1):
        alpha = "pi/2" if axis == 1 else "0"
        d = 0.0 if axis == 0 else world.arm["offset"] if axis == 1 else world.arm["length"]
        lines.append(f"      - name: j{number}")
        lines.append(f"        alpha: {alpha}")
        lines += [
            f"        d: {d!r}",
            f"        limits: {{{_limits(world, axis)}}}",
            f"        drive: {_drive(world, plan, axis)}",
        ]
        lines.append(
            f"        effects: [{', '.join(_law(world, plan, axis, e) for e in world.effects[number - 1])}]"
        )
    if plan.links is not None:
        lines.append("    links:")
        for number, axis in enumerate(world.axes, start=1):
            body = world.bodies[axis]
            wrong = 1 + plan.links * rng.uniform(-1, 1, 4)
            m, x, y = wrong[:3] * [body.mass, body.x, body.y]
            moments = ", ".join(
                f"{wrong[3] * v:.5g}" for v in (body.along, 0.0, 0.0, body.across, 0.0, body.turn)
            )
            lines.append(
                f"      j{number}: {{mass: {m:.5g}, com: [{x:.5g}, {y:.5g}, 0.0], inertia: [{moments}]}}"
            )
    assert planar == bool(world.arm["locked"])
    return "\n".join(lines) + "\n"


def _ends(joint: dict[str, float]) -> tuple[float, float]:
    """Shortest and longest length of a lever's actuator."""
    far = math.sqrt(joint["l1"] ** 2 + joint["l2"] ** 2 - 2 * joint["l1"] * joint["l2"] * math.cos(LONGEST))
    return joint["length0"], round(far, 5)


def _limits(world: World, axis: int) -> str:
    joint = world.joints[axis]
    low, high = world.centre[axis] - 1.6 * world.reach[axis], world.centre[axis] + 1.6 * world.reach[axis]
    if joint.get("levered"):
        short, long = _ends(joint)
        ends: Array = joint_angle(joint, np.array([0.0, (long - short) / joint["per_rad"]]))
        low, high = sorted(ends.tolist())
    effort = joint["limit"] * joint["kt"] * (joint["ratio"] if not joint.get("levered") else 100.0)
    speed = 2 * world.speed[axis]
    rates = f"velocity: {speed:.3f}, acceleration: {8 * speed:.3f}"
    return f"position: [{low:.6f}, {high:.6f}], {rates}, effort: {effort:.2f}"


def _law(world: World, plan: Plan, axis: int, effect: str) -> str:
    if effect != "stribeck_friction":
        return effect
    joint = world.joints[axis]
    speed = joint["sped"] * unit(world, plan, axis)
    return f"{{stribeck_friction: {{velocity: {speed!r}, exponent: {joint['shape']!r}}}}}"


def _drive(world: World, plan: Plan, axis: int) -> str:
    joint = world.joints[axis]
    kt = joint["kt"] / unit(world, plan, axis)
    if not joint.get("levered"):
        return f"{{type: direct, ratio: {joint['ratio']!r}, torque_constant: {kt!r}}}"
    short, long = _ends(joint)
    stroke = (long - short) / joint["per_rad"] * unit(world, plan, axis)
    return (
        f"{{type: levered, l1: {joint['l1']!r}, l2: {joint['l2']!r}, length: [{short!r}, {long!r}], "
        f"motor: [0, {stroke!r}], rev: {int(joint['rev'])}, offset: {joint['angle']!r}, "
        f"torque_constant: {kt!r}}}"
    )


def mapping_text(world: World, plan: Plan) -> str | None:
    """Mapping of the logs; None where none is needed."""
    if plan.timing == "following":
        return None
    lines = ["schema: 1", f"hold: {plan.hold}", "time: {column: t, unit: s}", "joints:"]
    for number, axis in enumerate(world.axes, start=1):
        levered = bool(world.joints[axis].get("levered"))
        if plan.sides[axis] == "motor":
            place = f"{{column: qm{number}, unit: {'counts' if levered else 'rad'}, side: motor}}"
        else:
            place = f"{{column: q{number}, unit: rad}}"
        lines.append(f"  - {{position: {place}, effort: {{column: i{number}, unit: A}}}}")
    return "\n".join(lines) + "\n"
