"""What the user writes: arms.yaml, and the mapping of the logs."""

from __future__ import annotations

import math

import numpy as np

from blind.case import Array
from blind.family_c.arms import World
from blind.family_c.plan import Plan
from blind.family_c.records import unit

NAME = "arm"


def arms_text(world: World, plan: Plan, rng: np.random.Generator) -> str:
    """arms.yaml of the world as its user believes it to be."""
    gravity = ", ".join(map(repr, world.gravity))
    lines = [
        "schema: 1",
        "convention: khalil_kleinfinger",
        "arms:",
        f"  {NAME}:",
        f"    gravity: [{gravity}]",
    ]
    lines.append("    joints:")
    for k, link in enumerate(world.links):
        kind = "prismatic" if link.slides else "revolute"
        lines += [
            f"      - name: j{k + 1}",
            f"        type: {kind}",
            f"        alpha: {_angle(link.alpha)}",
            f"        d: {link.d!r}",
            f"        theta: {link.theta!r}",
            f"        r: {link.r!r}",
            f"        limits: {{{_limits(world, k)}}}",
            f"        drive: {_drive(world, k)}",
            f"        effects: [{', '.join(world.effects[k])}]",
        ]
    if plan.links is not None:
        lines.append("    links:")
        for k, link in enumerate(world.links):
            wrong = 1 + plan.links * rng.uniform(-1, 1, 5)
            com = ", ".join(f"{x * w:.4g}" for x, w in zip(link.com, wrong[1:4], strict=True))
            i = np.array(link.inertia) * wrong[4]
            moments = ", ".join(f"{x:.5g}" for x in (i[0, 0], i[0, 1], i[0, 2], i[1, 1], i[1, 2], i[2, 2]))
            lines.append(
                f"      j{k + 1}: {{mass: {link.mass * wrong[0]:.4g}, com: [{com}], inertia: [{moments}]}}"
            )
    return "\n".join(lines) + "\n"


def _angle(alpha: float) -> str:
    quarters = round(alpha / (math.pi / 2))
    if alpha != quarters * (math.pi / 2):
        return repr(alpha)
    return {0: "0", 1: "pi/2", -1: "-pi/2"}[quarters]


def _limits(world: World, k: int) -> str:
    """Limits of a joint: half as much again as it moves; a lever's by its stroke."""
    lever = world.levers[k]
    low, high = world.centre[k] - 1.5 * world.reach[k], world.centre[k] + 1.5 * world.reach[k]
    if lever is not None:
        ends: Array = lever.joint(np.array([lever.shortest, lever.longest]))
        low, high = sorted(ends.tolist())
    speed = 2 * world.speed[k]
    return f"position: [{low:.6f}, {high:.6f}], velocity: {speed:.3f}, acceleration: {8 * speed:.3f}"


def _drive(world: World, k: int) -> str:
    own, lever = world.numbers[k], world.levers[k]
    if lever is None:
        return f"{{type: direct, ratio: {own['scale']!r}, torque_constant: {own['kt']!r}}}"
    turns = own["scale"] * (lever.longest - lever.shortest)
    return (
        f"{{type: levered, l1: {lever.l1!r}, l2: {lever.l2!r}, rev: {lever.rev}, offset: {lever.angle!r}, "
        f"length: [{lever.shortest!r}, {lever.longest!r}], motor: [0, {turns!r}], "
        f"torque_constant: {own['kt']!r}}}"
    )


def mapping_text(world: World, plan: Plan) -> str:
    """Mapping of the logs."""
    lines = ["schema: 1", f"hold: {plan.hold}", "time: {column: time, unit: s}", "joints:"]
    for k in range(world.count):
        side = ", side: motor" if plan.motor_side[k] else ""
        place = f"{{column: pos_{k + 1}, unit: {unit(world, plan, k)[0]}{side}}}"
        lines.append(f"  - {{position: {place}, effort: {{column: cur_{k + 1}, unit: mA}}}}")
    return "\n".join(lines) + "\n"
