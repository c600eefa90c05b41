"""Laws that no catalogue has: other joints' speeds, forces in space, hysteresis of other form, time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from blind.case import Array
from blind.family_c.arms import World
from blind.family_c.draw import origin, tip
from blind.family_c.hidden import Hidden, Maker, Numbers, effort, sign
from blind.family_c.plan import Plan
from blind.family_c.plant import TICK
from blind.family_c.weights import heaviest

Shape = Callable[[Numbers, World, int], tuple[float, float, float]]


def _strange(code: int, text: str, shape: Shape) -> Maker:
    """Law of steps.c by its number there; shape: its three constants."""

    def make(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
        a, b, c = shape(rng, world, k)

        def values(x: float) -> dict[str, float]:
            return {"strange": float(code), "strange_size": x * effort(world, k), "a": a, "b": b, "c": c}

        return Hidden("outside", (), k, lambda x: world.joint(k, **values(x)), values, text)

    return make


def _other(world: World, k: int) -> float:
    """Typical speed of the joint that some laws look at."""
    return 0.4 * float(world.speed[k - 1 if k else 1])


def _own(world: World, k: int) -> float:
    return 0.4 * float(world.speed[k])


def _in_space(text: str, number: str, unit: Callable[[World, float], float], put_near: bool) -> Maker:
    """Force or moment on the last link, from a fixed point where it is near its path."""

    def make(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
        end, middle = tip(world), origin(world)
        far = float(np.linalg.norm(middle)) + 0.1
        way = rng.normal(size=3)
        near = middle + way / np.linalg.norm(way) * (0.5 if put_near else 0.8) * far
        named = {f"tip_{x}": float(v) for x, v in zip("xyz", end, strict=True)}
        named |= {f"anchor_{x}": float(v) for x, v in zip("xyz", near, strict=True)}
        base = world.around(**named, span=0.3 * far)

        def values(x: float) -> dict[str, float]:
            return {number: x * unit(world, far)}

        return Hidden("outside", (), None, lambda x: base.around(**values(x)), values, text)

    return make


def _pushed(
    text: str, law: Callable[[Numbers, Plan], Callable[[Array], Array]], *, gain: bool = False
) -> Maker:
    """Disturbance over time alone: an effort, or a factor of the torque constant."""

    def make(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
        wave, unit = law(rng, plan), effort(world, k)

        def put(x: float) -> World:
            if gain:
                return replace(world, gains={k: lambda t: 1 + 0.3 * min(x, 3.0) * wave(t)})
            return replace(world, pushes={k: lambda t: x * unit * wave(t)})

        return Hidden("outside", (), k, put, lambda x: {"strength": x}, text)

    return make


def _beats(rng: Numbers, plan: Plan) -> Callable[[Array], Array]:
    one, two = rng.uniform(0.11, 0.19), rng.uniform(0.2, 0.31)
    phase = rng.uniform(0, 2 * math.pi, 2)
    return lambda t: np.sin(2 * math.pi * one * t + phase[0]) + np.sin(2 * math.pi * two * t + phase[1])


def _mains(rng: Numbers, plan: Plan) -> Callable[[Array], Array]:
    pace, phase = rng.uniform(0.05, 0.4), rng.uniform(0, 2 * math.pi)
    return lambda t: np.sin(2 * math.pi * pace * t + phase)


def _wander(rng: Numbers, plan: Plan) -> Callable[[Array], Array]:
    seed, tau = int(rng.integers(2**31)), rng.uniform(3, 10)

    def at(t: Array) -> Array:
        fade = math.exp(-TICK / tau)
        driven = np.random.default_rng([seed, abs(round(float(t[0])))]).normal(size=len(t))
        drift: Array = lfilter([math.sqrt(1 - fade**2)], [1, -fade], driven)
        return drift

    return at


def _waves_of_gain(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    order, phase = rng.uniform(3, 6) / float(world.reach[k]), rng.uniform(0, 2 * math.pi)

    def values(x: float) -> dict[str, float]:
        return {"gain_wave": 0.3 * min(x, 3.0), "gain_order": order, "phase": phase}

    text = "the torque constant waves with the joint's place"
    return Hidden("outside", (), k, lambda x: world.joint(k, **values(x)), values, text)


def _eccentric(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    unit, phase = 0.05 * sign(rng), rng.uniform(0, 2 * math.pi)
    return Hidden(
        "outside", (), None, lambda x: replace(world, eccentric=(k, unit * x, phase)),
        lambda x: {"size": unit * x, "phase": phase}, "the encoder's scale is off its axis", most=4.0,
    )  # fmt: skip


OUTSIDE: dict[str, Maker] = {
    "run_in": _strange(
        1, "dry friction that wears off after a reversal, by the distance",
        lambda r, w, k: (float(w.reach[k]) * r.uniform(0.2, 0.6), 0.01 * float(w.speed[k]), 0.0),
    ),
    "dragged_along": _strange(
        2, "drag by another joint's speed, at one joint alone", lambda r, w, k: (_other(w, k), 0.0, 0.0)
    ),
    "duhem": _strange(
        3, "wave of the place that trails it by a distance, either way",
        lambda r, w, k: (
            r.uniform(3, 8) / float(w.reach[k]), r.uniform(0, 6.28), r.uniform(2, 4) / float(w.reach[k])
        ),
    ),
    "clutch": _strange(
        4, "dry friction by the square of another joint's speed",
        lambda r, w, k: (_other(w, k), 0.02 * float(w.speed[k]), 0.0),
    ),
    "loaded_oil": _strange(
        5, "viscous friction by the square of the weight borne",
        lambda r, w, k: (_own(w, k), float(heaviest(w)[k]), 0.0),
    ),
    "fan": _strange(
        6, "square of the speed, by the sine of the place",
        lambda r, w, k: (r.uniform(2, 4) / float(w.reach[k]), _own(w, k), r.uniform(0, 6.28)),
    ),
    "gyroscope": _in_space(
        "moment of a wheel on the last link that keeps its momentum", "spin",
        lambda w, far: effort(w, w.count - 1) / float(w.speed[0]), False,
    ),
    "magnet": _in_space(
        "pull of the tip towards a point, strongest at a distance", "magnet",
        lambda w, far: 4 * effort(w, 0) / far, True,
    ),
    "tether": _in_space(
        "line from the tip to a point, slack when near", "tether",
        lambda w, far: effort(w, 0) / far / (0.4 * far) ** 2, False,
    ),
    "beats": _pushed("two slow waves in time that beat", _beats),
    "supply_wave": _pushed("torque constant that waves slowly in time", _mains, gain=True),
    "wander": _pushed("offset that wanders", _wander),
    "waves_of_gain": _waves_of_gain,
    "eccentric_scale": _eccentric,
}  # fmt: skip
