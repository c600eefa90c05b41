"""Effects of the catalogue on the whole arm and its surroundings, or between two joints."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from blind.family_c.arms import Coupling, World
from blind.family_c.draw import tip
from blind.family_c.hidden import Hidden, Maker, Numbers, effort, sign
from blind.family_c.measure import band
from blind.family_c.plan import Plan


def _drag(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    end = tip(world)
    far = 0.1 + sum(link.d for link in world.links) + float(np.linalg.norm(end))
    unit = effort(world, 0) / (far**4 * 0.2 * float(world.speed[0]) ** 2)
    ends = {f"tip_{x}": float(v) for x, v in zip("xyz", end, strict=True)}
    base = world.around(**ends)
    return Hidden(
        "fluid_drag", (None, *range(world.count)), None, lambda x: base.around(drag=x * unit),
        lambda x: {"coefficient": x * unit, **ends},
        "drag on all links, quadratic in the speed across them",
    )  # fmt: skip


def _coupling(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    one = max(k, 1)
    ratio = float(rng.choice([-1.0, 0.5, 1.0]))
    unit, kind = effort(world, one), str(rng.choice(["viscous", "dry", "both"]))

    def part(x: float) -> Coupling:
        viscous = 0.0 if kind == "dry" else x * unit / float(world.speed[one])
        return Coupling(one, one - 1, ratio, 0.0, viscous, 0.0 if kind == "viscous" else 0.6 * x * unit)

    def values(x: float) -> dict[str, float]:
        made = part(x)
        return {"ratio": ratio, "viscous": made.viscous, "dry": made.dry}

    return Hidden(
        "transmission_coupling", (one, one - 1), one, lambda x: replace(world, coupling=part(x)), values,
        f"friction ({kind}) of a part that turns with two joints",
    )  # fmt: skip


def _payload(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    x0, y0, z0 = tip(world) * rng.uniform(0.6, 1.2, 3)
    unit = world.links[-1].mass

    def put(x: float) -> World:
        return replace(world, payload=(x * unit, float(x0), float(y0), float(z0)))

    return Hidden(
        "payload_change", (None, world.count - 1), None, put,
        lambda x: {"mass": x * unit, "x": float(x0), "y": float(y0), "z": float(z0)},
        "a payload in the last training record alone",
    )  # fmt: skip


def _tilt(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    way, g = rng.uniform(0, 2 * math.pi), np.array(world.gravity)
    axis = np.array([math.cos(way), math.sin(way), 0.0])

    def put(x: float) -> World:
        c, s = math.cos(0.1 * x), math.sin(0.1 * x)
        seen = c * g - s * np.cross(axis, g) + (1 - c) * (axis @ g) * axis  # Rodrigues, backwards
        return replace(world, gravity=(float(seen[0]), float(seen[1]), float(seen[2])))

    return Hidden(
        "base_tilt", (None,), None, put,
        lambda x: {"x": 0.1 * x * float(axis[0]), "y": 0.1 * x * float(axis[1])},
        "the base is turned about a level axis; x and y: components of the turn", most=5.0,
    )  # fmt: skip


def _delay(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    s = sign(rng) / (2 * math.pi * band(plan))
    return Hidden(
        "time_delay", (None,), None, lambda x: replace(world, late=s * x), lambda x: {"delay": -s * x},
        "all currents are older (or younger) than the mapping says", most=0.9,
    )  # fmt: skip


ARM_LAWS: dict[str, Maker] = {
    "fluid_drag": _drag,
    "transmission_coupling": _coupling,
    "payload_change": _payload,
    "base_tilt": _tilt,
    "time_delay": _delay,
}
