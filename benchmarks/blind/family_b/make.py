"""A case by seed: an arm, its records, and something hidden of the size that is asked for."""

from __future__ import annotations

import math
import zlib
from dataclasses import asdict, replace

import numpy as np

from blind.case import Array, Case, Table, Truth
from blind.family_b import plan as plans
from blind.family_b import world as worlds
from blind.family_b.build_laws import BUILD_LAWS
from blind.family_b.description import NAME, arms_text, mapping_text
from blind.family_b.fit import errors
from blind.family_b.hidden import Hidden
from blind.family_b.joint_laws import JOINT_LAWS
from blind.family_b.kernel import Unstable
from blind.family_b.logger import Record, command, record
from blind.family_b.outside import OUTSIDE
from blind.family_b.plan import SETTINGS, Plan
from blind.family_b.world import World
from blind.sized import check_asked, first_met

__all__ = ["KINDS", "SETTINGS", "make"]

CATALOGUE = {**JOINT_LAWS, **BUILD_LAWS}
KINDS = ("nothing", *CATALOGUE, *(f"outside:{name}" for name in OUTSIDE))
DIRECT = ("backlash", "joint_flexibility")  # the plant's levers are stiff
LAST = ("drive_inertia",)  # at the first joint it is one with the link's inertia
NOT_FIRST = ("drive_gain_error",)
LOST = ("joint_flexibility", "backlash", "presliding")
FALLING = ("stribeck_friction", "presliding")  # not where another law of this kind is known
KNOWN = 0.25  # share of the arms with a known Stribeck friction
RUN_ON = 0.3  # share of the cases of warm-up whose records follow each other without a pause
TRIES = 8  # runs of the plant in search of a strength
CLOSE = 0.03  # share of s - 1 to which a size is met
ATTEMPTS = 4  # arms drawn, where one runs away or cannot show the effect in the size asked for


def make(seed: int, kind: str, *, size: float | None = None, setting: str = "four") -> Case:
    """Case of this seed and kind; the same arguments give the same bytes.

    kind: one of KINDS. size: RMSE without over RMSE with the effect; None: a strength drawn from its range.
    setting: one of SETTINGS. Raises ValueError for another kind or setting, or a size of at most 1.
    """
    check_asked(kind, KINDS, size)
    best = first_met((_attempted(seed, k, kind, size, setting) for k in range(ATTEMPTS)), size)
    if best is None:
        raise ValueError(f"no arm of seed {seed} stands {kind} in setting {setting}")
    return best


def _attempted(seed: int, attempt: int, kind: str, size: float | None, setting: str) -> Case | None:
    """The case of an attempt, None where its arm runs away."""
    try:
        return _make(seed, attempt, kind, size, setting)
    except Unstable:
        return None


def _make(seed: int, attempt: int, kind: str, size: float | None, setting: str) -> Case:
    rng = np.random.default_rng([seed, attempt, zlib.crc32(f"{kind}/{setting}".encode())])
    plan = plans.draw(rng, setting)
    if kind in LOST and setting == "lost_motion":
        plan = replace(plan, sides=("motor", "motor", "motor"))
    if kind == "friction_warm_up":
        plan = replace(plan, on_and_on=bool(rng.random() < RUN_ON))
    if kind == "payload_change":
        plan = replace(plan, train=max(plan.train, 2))
    world = worlds.draw(rng, _shape(rng, kind))
    if kind not in FALLING and rng.random() < KNOWN:
        world = worlds.striking(rng, world)
    hidden = _hide(rng, world, plan, kind)
    noise_seed = int(rng.integers(2**31))
    angles = [command(world, plan, noise_seed, k) for k in range(plan.train + 1)]
    strength, got = 0.0, None
    believed = world
    if hidden is not None:
        believed = hidden.known or world
        strength, got = _strength(rng, hidden, world, plan, noise_seed, angles, size)
    tables = {}
    actual = world if hidden is None else hidden.put(strength)
    for k, taken in enumerate(_records(actual, plan, noise_seed, angles)):
        tables["test" if k == plan.train else f"train_{k + 1}"] = taken.table
    truth = Truth(None)
    if hidden is not None:
        truth = Truth(hidden.effect, hidden.joints, hidden.values(strength), hidden.text, got)
    facts: dict[str, object] = {
        "plan": asdict(plan),
        "axes": list(world.axes),
        "levered": [bool(world.joints[a].get("levered")) for a in world.axes],
        "strength": strength,
        "attempt": attempt,
    }
    text = arms_text(believed, plan, np.random.default_rng([noise_seed, 3]))
    return _case(seed, kind, size, setting, text, mapping_text(believed, plan), tables, truth, facts)


def _case(
    seed: int, kind: str, size: float | None, setting: str, arms: str, mapping: str | None,
    tables: dict[str, Table], truth: Truth, facts: dict[str, object],
) -> Case:  # fmt: skip
    train = tuple(name for name in tables if name != "test")
    return Case("b", seed, kind, size, setting, NAME, arms, mapping, tables, train, "test", truth, facts)


def _shape(rng: np.random.Generator, kind: str) -> str:
    shapes = [
        s for s in worlds.SHAPES
        if not (kind in DIRECT and s.endswith("levered"))
        and not (kind == "lever_geometry" and not s.endswith("levered"))
        and not (kind == "base_tilt" and s.startswith("planar"))
    ]  # fmt: skip
    return str(rng.choice(shapes))


def _hide(rng: np.random.Generator, world: World, plan: Plan, kind: str) -> Hidden | None:
    if kind == "nothing":
        return None
    last = len(world.axes)
    numbers = list(range(1, last + 1))
    if kind in LAST or kind == "lever_geometry":
        numbers = [last]
    elif kind in NOT_FIRST:
        numbers = numbers[1:]
    elif kind == "encoder_offset":  # a last link turned by its encoder's offset is a link of other moments
        numbers = [last] if world.of(last).get("levered") else [last - 1]
    elif kind == "load_dependent_friction":  # the column bears no weight
        numbers = [last - 1, last]
    number = int(rng.choice(numbers))
    if kind.startswith("outside:"):
        return OUTSIDE[kind.removeprefix("outside:")](rng, world, plan, number)
    return CATALOGUE[kind](rng, world, plan, number)


def _records(world: World, plan: Plan, seed: int, angles: list[Array]) -> list[Record]:
    heat = np.zeros(3)
    out = []
    for k, commanded in enumerate(angles):
        taken, warm = record(world, plan, seed, k, commanded, heat)
        heat = warm if plan.on_and_on else np.zeros(3)
        out.append(taken)
    return out


def _strength(
    rng: np.random.Generator,
    hidden: Hidden,
    world: World,
    plan: Plan,
    seed: int,
    angles: list[Array],
    size: float | None,
) -> tuple[float, float]:
    """Strength of the hidden effect for a size, and the size that it has.

    The growth s^2 - 1 is nearly a power of the strength: a secant over both logarithms.
    """
    base = hidden.known or world
    clean = errors(base, plan, _records(base, plan, seed, angles[:-1]))

    def measured(x: float) -> float:
        left = errors(base, plan, _records(hidden.put(x), plan, seed, angles[:-1]))
        if hidden.at is not None:
            axis = world.axes[hidden.at - 1]
            return float(left[axis] / clean[axis])
        own = list(world.axes)
        return float(np.sqrt(np.mean((left[own] / clean[own]) ** 2)))

    if size is None:
        x = math.exp(rng.uniform(*np.log(hidden.free)))
        return x, measured(x)
    wanted = math.log(size**2 - 1)
    x, slope = hidden.start, 2.0
    tried: list[tuple[float, float, float]] = []
    for _ in range(TRIES):
        got = measured(x)
        grown = math.log(max(got**2 - 1, 1e-4))
        tried.append((x, got, grown))
        if abs(got - size) < CLOSE * (size - 1):
            break
        if len(tried) > 1:
            (x0, _, g0), (x1, _, g1) = tried[-2:]
            if abs(math.log(x1 / x0)) > 1e-6 and (g1 - g0) / math.log(x1 / x0) > 0.3:
                slope = min((g1 - g0) / math.log(x1 / x0), 6.0)
        new = min(max(x * math.exp((wanted - grown) / slope), hidden.low), hidden.high)
        if new == x:
            break
        x = new
    x, got, _ = min(tried, key=lambda row: abs(row[1] - size))
    return x, got
