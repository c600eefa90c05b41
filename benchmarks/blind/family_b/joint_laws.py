"""Laws of a single joint, of the catalogue: friction, ripple, spring, gain."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from blind.family_b.hidden import Hidden, Maker, Numbers, dry, fast, gear, load, sign
from blind.family_b.plan import Plan
from blind.family_b.world import World

HARMONICS = (12.0, 6.0, 4.0, 3.0, 2.0, 1.0, 0.5, 1 / 3, 0.25, 0.2, 0.125, 0.1)


def _law(
    effect: str, text: str, build: Callable[[Numbers, World, int], Callable[[float], dict[str, float]]]
) -> Maker:
    """Effect that is a few numbers of the joint in plant.c, added to those that it has."""

    def make(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
        values = build(rng, world, number)

        def put(x: float) -> World:
            has = world.of(number)
            return world.joint(number, **{k: has.get(k, 0.0) + v for k, v in values(x).items()})

        return Hidden(effect, (number,), number, put, values, text)

    return make


def _offset(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    s = sign(rng)
    return lambda x: {"shift": s * x * dry(w, n)}


def _skew(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    s = sign(rng)
    return lambda x: {"skew": s * x * dry(w, n) / fast(w, n)}


def _stribeck(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    speed, shape = fast(w, n) * rng.uniform(0.1, 0.4), float(rng.choice([1.0, 2.0]))
    return lambda x: {"excess": x * dry(w, n), "sped": speed, "shape": shape}


def _load(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    rise = 0.0 if rng.random() < 0.5 else rng.uniform(0.005, 0.03)
    return lambda x: {"load": x * dry(w, n) / load(w, n), "load_rise": rise}


def _power(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    exponent = float(rng.choice([0.5, 2.0, 3.0]))
    return lambda x: {"power": x * dry(w, n), "power_scale": fast(w, n), "exponent": exponent}


def _place(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    s, c = sign(rng), rng.uniform(-0.5, 0.5)
    return lambda x: {"slope": s * x * dry(w, n), "curve": c * x * dry(w, n)}


def _spring(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    rest = float(w.centre[w.axes[n - 1]] + rng.uniform(-0.5, 0.5))
    unit = dry(w, n) * gear(w, n)
    return lambda x: {"spring": x * unit, "preload": -x * unit * rest}


def _ripple(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    waves = next((h for h in HARMONICS if h * fast(w, n) / (2 * math.pi) < 2.5), HARMONICS[-1])
    phase = rng.uniform(0, 2 * math.pi)
    return lambda x: {
        "waves": waves,
        "ripple_s": x * dry(w, n) * math.sin(phase),
        "ripple_c": x * dry(w, n) * math.cos(phase),
    }


def _saturation(rng: Numbers, w: World, n: int) -> Callable[[float], dict[str, float]]:
    return lambda x: {"fall": 0.3 * min(x, 3.0) / w.of(n)["limit"] ** 2}


def _warm(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    tau = rng.uniform(0.25, 0.8) * plan.seconds
    speed, both = fast(world, number), rng.uniform(0.2, 1.0)

    def values(x: float) -> dict[str, float]:
        viscous = both * x * world.of(number)["viscous"]
        return {
            "cold_dry": x * dry(world, number),
            "cold_viscous": viscous,
            "warm_time": tau,
            "warm_speed": speed,
        }

    begin = "heat runs on from record to record" if plan.on_and_on else "every record begins cold"
    text = f"friction falls with the heat of the motion; {begin}"
    return Hidden(
        "friction_warm_up", (number,), number, lambda x: world.joint(number, **values(x)), values, text
    )


def _presliding(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
    form = str(rng.choice(["dahl", "lugre", "maxwell"]))
    most = 5.0 if plan.sides[0] == "motor" else 20.0
    distance = 1e-3 * math.exp(rng.uniform(math.log(0.5), math.log(most))) * gear(world, number)

    def values(x: float) -> dict[str, float]:
        return {
            "bristle": x * dry(world, number),
            "coulomb": (1 - x) * dry(world, number),
            "distance": distance,
            "micro": 0.002 if form == "lugre" else 0.0,
            "slip": float(form == "maxwell"),
        }

    return Hidden(
        "presliding", (number,), number, lambda x: world.joint(number, **values(x)), values,
        f"a part of the dry friction by bristles: {form}", high=1.0, free=(0.7, 1.0),
    )  # fmt: skip


def _without(effect: str, number_of: str) -> Maker:
    """Effect that every description has by default, and this one not."""

    def make(rng: Numbers, world: World, plan: Plan, number: int) -> Hidden:
        own = list(world.effects)
        own[number - 1] = tuple(e for e in own[number - 1] if e != effect)
        less = replace(world.joint(number, **{number_of: 0.0}), effects=tuple(own))
        whole = world.of(number)[number_of]
        return Hidden(
            effect, (number,), number, lambda x: less.joint(number, **{number_of: x * whole}),
            lambda x: {number_of: x * whole}, "the description lacks it", known=less,
        )  # fmt: skip

    return make


JOINT_LAWS: dict[str, Maker] = {
    "viscous_friction": _without("viscous_friction", "viscous"),
    "coulomb_friction": _without("coulomb_friction", "coulomb"),
    "drive_inertia": _without("drive_inertia", "inertia"),
    "friction_offset": _law("friction_offset", "constant torque", _offset),
    "asymmetric_viscous_friction": _law("asymmetric_viscous_friction", "torque by |speed|", _skew),
    "stribeck_friction": _law(
        "stribeck_friction", "excess of dry friction, exponential in the speed", _stribeck
    ),
    "load_dependent_friction": _law("load_dependent_friction", "dry friction by the load borne", _load),
    "nonlinear_viscous_friction": _law(
        "nonlinear_viscous_friction", "friction by a power of the speed", _power
    ),
    "position_dependent_friction": _law("position_dependent_friction", "dry friction by place", _place),
    "friction_warm_up": _warm,
    "presliding": _presliding,
    "torque_ripple": _law("torque_ripple", "wave of the motor's angle", _ripple),
    "spring": _law("spring", "spring at the joint", _spring),
    "torque_constant_saturation": _law("torque_constant_saturation", "kt (1 - c i^2)", _saturation),
}
