"""Effects of the catalogue on the arm's build and its measurement: elasticity, play, payload, tilt, delay."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from blind.family_b.equations import still
from blind.family_b.fit import cutoff
from blind.family_b.hidden import Hidden, Maker, Numbers, dry, gear, sign
from blind.family_b.plan import Plan
from blind.family_b.world import World


def _elastic(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    inertia = float(still(world.arm, world.centre, world.reach)[0][world.axes[number - 1]])
    damped, light = rng.uniform(0.02, 0.1), rng.random() < 0.4

    def values(x: float) -> dict[str, float]:
        stiffness = inertia * (2 * math.pi * 40) ** 2 / x
        return {"stiffness": stiffness, "damping": 2 * damped * math.sqrt(stiffness * inertia)}

    base = world.joint(number, inertia=0.1 * world.of(number)["inertia"]) if light else world
    masses = "light rotor" if light else "two masses"
    text = f"elastic transmission, {masses}, 40 Hz over the root of the strength"
    return Hidden(
        "joint_flexibility", (number,), number,
        lambda x: base.joint(number, elastic=1.0, **values(x)), values,
        text, known=base, start=4.0, low=1.0, high=64.0, free=(1.0, 64.0),
    )  # fmt: skip


def _backlash(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    inertia = float(still(world.arm, world.centre, world.reach)[0][world.axes[number - 1]])
    stiffness = inertia * (2 * math.pi * rng.uniform(20, 40)) ** 2
    damping = 2 * rng.uniform(0.05, 0.2) * math.sqrt(stiffness * inertia)

    def values(x: float) -> dict[str, float]:
        return {"gap": 1e-3 * x, "stiffness": stiffness, "damping": damping}

    return Hidden(
        "backlash", (number,), number, lambda x: world.joint(number, elastic=1.0, **values(x)), values,
        "play with an elastic contact", start=2.0, low=0.5, high=5.0, free=(0.5, 5.0),
    )  # fmt: skip


def _drag(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    length, last = world.arm["length"], len(world.axes)
    effort = dry(world, last) * gear(world, last)
    unit = effort / (world.arm["reach3"] * (length + world.arm["reach3"]) ** 3 * 0.3)
    return Hidden(
        "fluid_drag", (None, last), last, lambda x: world.whole(drag2=x * unit, drag3=x * unit),
        lambda x: {"coefficient": x * unit}, "drag on both links, quadratic in the speed across them",
    )  # fmt: skip


def _coupling(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    ratio, last = float(rng.choice([-1.0, 0.5, 1.0])), len(world.axes)
    effort = dry(world, last) * gear(world, last)

    def values(x: float) -> dict[str, float]:
        viscous = x * effort / float(world.speed[2])
        return {
            "pair_ratio": ratio,
            "pair_viscous": viscous,
            "pair_dry": 0.5 * x * effort,
            "pair_inertia": 0.0,
        }

    pair = {"pair_a": 2.0, "pair_b": 1.0}
    return Hidden(
        "transmission_coupling", (last, last - 1), last, lambda x: world.whole(**pair, **values(x)), values,
        "friction of a part that turns with the last two joints",
    )  # fmt: skip


def _payload(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    x3, y3, last = world.arm["reach3"] * rng.uniform(0.7, 1.1), rng.uniform(-0.03, 0.03), len(world.axes)
    return Hidden(
        "payload_change", (None, last), None, lambda x: replace(world, payload=(x, x3, y3)),
        lambda x: {"mass": x, "x": x3, "y": y3}, "a payload in the last training record alone",
    )  # fmt: skip


def _tilt(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    way = rng.uniform(0, 2 * math.pi)
    g = np.array([world.arm.get(k, 0.0) for k in ("gx", "gy", "gz")])

    def put(x: float) -> World:
        a, b = 0.1 * x * math.cos(way), 0.1 * x * math.sin(way)
        about_x = np.array([[1, 0, 0], [0, math.cos(a), math.sin(a)], [0, -math.sin(a), math.cos(a)]])
        about_y = np.array([[math.cos(b), 0, -math.sin(b)], [0, 1, 0], [math.sin(b), 0, math.cos(b)]])
        gx, gy, gz = about_y @ about_x @ g
        return world.whole(gx=float(gx), gy=float(gy), gz=float(gz))

    return Hidden(
        "base_tilt", (None,), None, put,
        lambda x: {"x": 0.1 * x * math.cos(way), "y": 0.1 * x * math.sin(way)},
        "the base is turned about its x, then its y axis", high=4.0,
    )  # fmt: skip


def _gain(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    s = sign(rng)
    kt = world.of(number)["kt"]
    return Hidden(
        "drive_gain_error", (number,), None, lambda x: world.joint(number, kt=kt * (1 + s * x)),
        lambda x: {"error": s * x}, "the torque constant is another than described", high=0.6,
    )  # fmt: skip


def _encoder(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    s, axis = 0.2 * sign(rng), world.axes[number - 1]

    def put(x: float) -> World:
        offset = [0.0, 0.0, 0.0]
        offset[axis] = s * x
        return replace(world, offset=(offset[0], offset[1], offset[2]))

    return Hidden(
        "encoder_offset", (number,), None, put, lambda x: {"offset": s * x}, "true less read angle", high=2.0
    )


def _delay(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    s = sign(rng) / (2 * math.pi * cutoff(plan))
    return Hidden(
        "time_delay", (None,), None, lambda x: replace(world, late=s * x), lambda x: {"delay": -s * x},
        "all currents are older (or younger) than the mapping says", high=1.0,
    )  # fmt: skip


def _lever(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    s, l2 = 0.1 * sign(rng), world.of(number)["l2"]
    return Hidden(
        "lever_geometry", (number,), None, lambda x: world.joint(number, l2=l2 * (1 + s * x)),
        lambda x: {"l2": s * x * l2}, "the crank is longer or shorter than described", high=1.0,
    )  # fmt: skip


BUILD_LAWS: dict[str, Maker] = {
    "backlash": _backlash,
    "joint_flexibility": _elastic,
    "transmission_coupling": _coupling,
    "payload_change": _payload,
    "fluid_drag": _drag,
    "base_tilt": _tilt,
    "drive_gain_error": _gain,
    "encoder_offset": _encoder,
    "time_delay": _delay,
    "lever_geometry": _lever,
}
