"""Laws that no catalogue has: products, hysteresis of other forms, disturbances in time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from blind.case import Array
from blind.family_b.hidden import Hidden, Maker, Numbers, dry, gear
from blind.family_b.logger import APART
from blind.family_b.plan import Plan
from blind.family_b.world import Push, World

Shape = Callable[[Numbers, World, int], tuple[float, float, float]]


def _law(code: int, text: str, shape: Shape) -> Maker:
    """Law of plant.c, by its number there; shape: its three constants."""

    def make(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
        a, b, c = shape(rng, world, number)
        unit = dry(world, number) * gear(world, number)
        if code == 3:
            unit /= float(world.speed[world.axes[number - 1]])
        if code == 9:
            unit /= 0.5 * float(world.speed[world.axes[number - 1]])

        def values(x: float) -> dict[str, float]:
            return {"strange": float(code), "strange_size": x * unit, "a": a, "b": b, "c": c}

        return Hidden("outside", (), number, lambda x: world.joint(number, **values(x)), values, text)

    return make


def _pushed(text: str, wave: Callable[[Numbers, Plan], Callable[[Array], Array]]) -> Maker:
    """Effort from outside, over time alone."""

    def make(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
        law, axis, unit = wave(rng, plan), world.axes[number - 1], dry(world, number) * gear(world, number)

        def push(x: float) -> Push:
            def at(times: Array) -> Array:
                out = np.zeros((len(times), 3))
                out[:, axis] = x * unit * law(times)
                return out

            return at

        return Hidden(
            "outside",
            (),
            number,
            lambda x: replace(world, push=push(x)),
            lambda x: {"amplitude": x * unit},
            text,
        )

    return make


def _slow(rng: Numbers, plan: Plan) -> Callable[[Array], Array]:
    period, phase = rng.uniform(3, 12), rng.uniform(0, 6)
    return lambda t: np.sin(2 * math.pi * t / period + phase)


def _chirp(rng: Numbers, plan: Plan) -> Callable[[Array], Array]:
    low, rise, phase = rng.uniform(0.1, 0.3), rng.uniform(0.5, 2.0) / plan.seconds, rng.uniform(0, 6)

    def wave(times: Array) -> Array:
        t = times % APART
        y: Array = np.sin(2 * math.pi * (low * t + rise * t * t / 2) + phase)
        return y

    return wave


def _gust(rng: Numbers, plan: Plan) -> Callable[[Array], Array]:
    f, phase = rng.uniform(0.05, 1.0, 16), rng.uniform(0, 2 * math.pi, 16)
    return lambda t: np.sin(2 * math.pi * f * t[:, None] + phase).sum(axis=1) / 3


def _drift(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    tau = rng.uniform(0.3, 1.0) * plan.seconds

    def gain(x: float) -> Push:
        return lambda t: 1 - 0.3 * min(x, 2.0) * (1 - np.exp(-np.maximum(t, 0.0) / tau))

    text = "all torque constants fall as the magnets warm up"
    return Hidden(
        "outside", (), None, lambda x: replace(world, gain=gain(x)), lambda x: {"fall": 0.3 * x}, text
    )


def _middle(rng: Numbers, w: World, n: int) -> float:
    axis = w.axes[n - 1]
    return float(w.centre[axis] + w.reach[axis] * rng.uniform(-0.4, 0.4))


def _quick(w: World, n: int) -> float:
    return 0.4 * float(w.speed[w.axes[n - 1]])


def _any(rng: Numbers) -> float:
    return float(rng.uniform(0, 2 * math.pi))


OUTSIDE: dict[str, Maker] = {
    "speed_by_place": _law(
        1,
        "sin(a v) cos(b q + c)",
        lambda r, w, n: (r.uniform(1.0, 2.0) / _quick(w, n), r.uniform(1, 3), _any(r)),
    ),
    "other_speed": _law(
        2,
        "sin(a q + c) tanh(b v of another joint)",
        lambda r, w, n: (r.uniform(1, 3), r.uniform(1, 4), _any(r)),
    ),
    "two_speeds": _law(
        3, "product of two joints' speeds, by place", lambda r, w, n: (r.uniform(1, 3), 0.5, _any(r))
    ),
    "hose": _law(
        4, "cable that drags: long hysteresis, by place", lambda r, w, n: (r.uniform(0.2, 0.5), 2.0, _any(r))
    ),
    "bouc_wen": _law(
        5,
        "Bouc-Wen with a sharp knee, not even",
        lambda r, w, n: (r.uniform(0.05, 0.2), r.uniform(0.3, 0.7), 0.0),
    ),
    "hard_spot": _law(6, "hard spot", lambda r, w, n: (_middle(r, w, n), r.uniform(0.05, 0.15), 0.0)),
    "cushion": _law(7, "one-sided cushion", lambda r, w, n: (_middle(r, w, n), 0.3, 0.0)),
    "viscoelastic": _law(8, "spring and dashpot in line", lambda r, w, n: (r.uniform(0.1, 0.5), 0.0, 0.0)),
    "oil_film": _law(
        9, "viscous friction that waves with the place", lambda r, w, n: (r.uniform(2, 4), 0.0, _any(r))
    ),
    "squeezed": _law(
        10, "friction by the sum of two joints' angles", lambda r, w, n: (r.uniform(2, 4), 0.05, _any(r))
    ),
    "mean_speed": _law(
        11, "dry friction by the mean speed of late", lambda r, w, n: (r.uniform(0.3, 1.5), _quick(w, n), 0.0)
    ),
    "slow_wave": _pushed("slow wave in time", _slow),
    "chirp": _pushed("wave of rising frequency", _chirp),
    "gust": _pushed("irregular push", _gust),
    "gain_drift": _drift,
}
