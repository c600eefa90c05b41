"""Effects of the catalogue at one joint, by other forms than the catalogue's where physics has several."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from blind.family_c.arms import World
from blind.family_c.draw import inertias
from blind.family_c.hidden import Hidden, Maker, Numbers, dry, effort, fast, sign
from blind.family_c.plan import Plan
from blind.family_c.weights import heaviest

Law = Callable[[float], dict[str, float]]
ORDERS = (12.0, 6.0, 4.0, 2.0, 1.0, 0.5, 1 / 3, 0.25, 0.2, 0.125, 0.1)  # waves in a turn of the motor
AUDIBLE = (0.5, 2.5)  # Hz, of a ripple at a typical speed


def _law(effect: str, text: str, shape: Callable[[Numbers, World, int], Law]) -> Maker:
    """Effect that is a few numbers of steps.c, besides those that the joint has."""

    def make(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
        values = shape(rng, world, k)
        return Hidden(effect, (k,), k, lambda x: world.joint(k, **values(x)), values, text)

    return make


def _offset(rng: Numbers, w: World, k: int) -> Law:
    s = sign(rng) * dry(w, k)
    return lambda x: {"bias": s * x}


def _skew(rng: Numbers, w: World, k: int) -> Law:
    s = sign(rng) * dry(w, k) / fast(w, k)
    return lambda x: {"skew": s * x, "skew_floor": 0.03 * fast(w, k)}


def _stribeck(rng: Numbers, w: World, k: int) -> Law:
    speed = fast(w, k) * rng.uniform(0.1, 0.35)
    return lambda x: {"excess": x * dry(w, k), "sped": speed}


def _load(rng: Numbers, w: World, k: int) -> Law:
    most = heaviest(w)[k] / w.middle_gear(k)
    return lambda x: {"by_load": x * dry(w, k) / most, "load_floor": 0.02 * most}


def _power(rng: Numbers, w: World, k: int) -> Law:
    form = float(rng.integers(0, 3))
    return lambda x: {"bent": x * dry(w, k), "bent_speed": fast(w, k), "bent_form": form}


def _worn(rng: Numbers, w: World, k: int) -> Law:
    s, middle = sign(rng) * dry(w, k), float(w.centre[k] + w.reach[k] * rng.uniform(-0.5, 0.5))
    return lambda x: {"worn": s * x, "middle": middle, "wide": float(w.reach[k])}


def _spring(rng: Numbers, w: World, k: int) -> Law:
    rest = float(w.centre[k] + w.reach[k] * rng.uniform(-0.6, 0.6))
    return lambda x: {"spring": x * effort(w, k) / float(w.reach[k]), "rest": rest}


def _ripple(rng: Numbers, w: World, k: int) -> Law:
    pace = fast(w, k) / (2 * math.pi)
    heard = [o for o in ORDERS if AUDIBLE[0] < o * pace < AUDIBLE[1]] or [ORDERS[-1]]
    order, phase = float(rng.choice(heard)), rng.uniform(0, 2 * math.pi)
    return lambda x: {"wave": x * dry(w, k), "order": order, "phase": phase}


def _saturation(rng: Numbers, w: World, k: int) -> Law:
    return lambda x: {"knee": w.numbers[k]["limit"] / math.sqrt(min(x, 20.0))}


def _gain(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    s, kt = sign(rng), world.numbers[k]["kt"]
    other = (k, 1 - k) if world.count == 2 else (k,)  # of two, either may be the one that is right
    return Hidden(
        "drive_gain_error", other, None, lambda x: world.joint(k, kt=kt * (1 + s * x)),
        lambda x: {"error": s * x}, "the torque constant is another than described", most=0.6,
    )  # fmt: skip


def _warm(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    tau, both, speed = rng.uniform(0.25, 0.8) * plan.seconds, rng.uniform(0.2, 1.0), fast(world, k)

    def values(x: float) -> dict[str, float]:
        viscous = both * x * dry(world, k) / (2.5 * speed)
        return {
            "cold_dry": x * dry(world, k), "cold_viscous": viscous, "warm_time": tau, "warm_speed": speed
        }  # fmt: skip

    text = "friction falls exponentially with the heat of the motion; every record begins cold"
    return Hidden("friction_warm_up", (k,), k, lambda x: world.joint(k, **values(x)), values, text)


def _presliding(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    spread = float(rng.integers(0, 2))
    widest = 5.0 if plan.motor_side[k] else 20.0
    lost = 1e-3 * math.exp(rng.uniform(math.log(0.5), math.log(widest)))
    distance = lost * world.middle_gear(k) * (0.1 if world.links[k].slides else 1.0)

    def put(x: float) -> World:
        rigid = world.numbers[k]["coulomb"] - x * dry(world, k)
        return world.joint(k, coulomb=rigid, **values(x))

    def values(x: float) -> dict[str, float]:
        return {"bristle": x * dry(world, k), "distance": distance, "elements": spread}

    text = f"a part of the dry friction builds up over a distance: {'Iwan' if spread else 'Dahl'}"
    return Hidden("presliding", (k,), k, put, values, text, start=0.4, most=1.0, free=(0.7, 1.0))


def _elastic(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    inertia, damped = float(inertias(world)[k]), rng.uniform(0.02, 0.1)
    light = 0.1 if rng.random() < 0.4 else 1.0
    rotors = [r * light if j == k else r for j, r in enumerate(world.rotors)]
    base = replace(world, rotors=tuple(rotors))

    def values(x: float) -> dict[str, float]:
        stiffness = inertia * (2 * math.pi * 40) ** 2 / x
        return {"stiffness": stiffness, "damping": 2 * damped * math.sqrt(stiffness * inertia)}

    text = "elastic transmission, 40 Hz over the root of the strength with the motor held"
    return Hidden(
        "joint_flexibility", (k,), k, lambda x: replace(base.joint(k, **values(x)), elastic=k), values,
        text, believed=base, start=4.0, least=0.5, most=64.0, free=(1.0, 64.0),
    )  # fmt: skip


def _backlash(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    inertia = float(inertias(world)[k])
    stiffness = inertia * (2 * math.pi * rng.uniform(25, 45)) ** 2
    damping = 2 * rng.uniform(0.05, 0.2) * math.sqrt(stiffness * inertia)
    unit = 1e-3 * (0.1 if world.links[k].slides else 1.0)

    def values(x: float) -> dict[str, float]:
        return {"gap": unit * x, "stiffness": stiffness, "damping": damping}

    return Hidden(
        "backlash", (k,), k, lambda x: replace(world.joint(k, **values(x)), elastic=k), values,
        "a gap between motor and link, with elastic contacts",
        start=2.0, least=0.5, most=5.0, free=(0.5, 5.0),
    )  # fmt: skip


def _lever(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    s, which = 0.05 * sign(rng), str(rng.choice(["l1", "l2"]))
    lever = world.levers[k]
    assert lever is not None
    size = lever.l1 if which == "l1" else lever.l2

    def put(x: float) -> World:
        own = list(world.levers)
        wrong = (1 + s * x) * size
        own[k] = replace(lever, l1=wrong) if which == "l1" else replace(lever, l2=wrong)
        return replace(world, levers=tuple(own))

    return Hidden(
        "lever_geometry", (k,), None, put, lambda x: {which: s * x * size},
        f"{which} of the lever is another than described", most=3.0,
    )  # fmt: skip


def _encoder(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
    s = 0.2 * sign(rng)

    def put(x: float) -> World:
        return replace(world, offset=tuple(s * x if j == k else 0.0 for j in range(world.count)))

    return Hidden(
        "encoder_offset", (k,), None, put, lambda x: {"offset": s * x}, "true less read coordinate", most=2.0
    )


def _without(effect: str, number: str) -> Maker:
    """Effect that every description has, and this one lacks."""

    def make(rng: Numbers, world: World, plan: Plan, k: int) -> Hidden:
        own = list(world.effects)
        own[k] = tuple(e for e in own[k] if e != effect)
        lacks = replace(_set(world, number, k, 0.0), effects=tuple(own))
        whole = world.rotors[k] if number == "rotor" else world.numbers[k][number]
        return Hidden(
            effect, (k,), k, lambda x: _set(lacks, number, k, x * whole), lambda x: {number: x * whole},
            "the description lacks it", believed=lacks,
        )  # fmt: skip

    return make


def _set(world: World, number: str, k: int, value: float) -> World:
    if number != "rotor":
        return world.joint(k, **{number: value})
    return replace(world, rotors=tuple(value if j == k else r for j, r in enumerate(world.rotors)))


JOINT_LAWS: dict[str, Maker] = {
    "viscous_friction": _without("viscous_friction", "viscous"),
    "coulomb_friction": _without("coulomb_friction", "coulomb"),
    "drive_inertia": _without("drive_inertia", "rotor"),
    "friction_offset": _law("friction_offset", "constant torque", _offset),
    "asymmetric_viscous_friction": _law("asymmetric_viscous_friction", "torque by |speed|", _skew),
    "stribeck_friction": _law("stribeck_friction", "excess of dry friction, 1 / (1 + (v / vs)^2)", _stribeck),
    "load_dependent_friction": _law("load_dependent_friction", "dry friction by the weight borne", _load),
    "nonlinear_viscous_friction": _law(
        "nonlinear_viscous_friction", "friction by asinh, square or cube of the speed", _power
    ),
    "position_dependent_friction": _law("position_dependent_friction", "dry friction by tanh(place)", _worn),
    "friction_warm_up": _warm,
    "presliding": _presliding,
    "torque_ripple": _law("torque_ripple", "wave of the motor's angle, with a weak overtone", _ripple),
    "spring": _law("spring", "spring that stiffens a little", _spring),
    "torque_constant_saturation": _law(
        "torque_constant_saturation", "knee tanh(current / knee)", _saturation
    ),
    "drive_gain_error": _gain,
    "encoder_offset": _encoder,
    "lever_geometry": _lever,
    "backlash": _backlash,
    "joint_flexibility": _elastic,
}
