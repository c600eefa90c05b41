"""A case by seed: an arm, its records, and something hidden of the size that is asked for."""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable
from dataclasses import asdict, replace

import numpy as np

from blind.case import Case, Truth
from blind.family_c import draw
from blind.family_c import plan as plans
from blind.family_c.arm_laws import ARM_LAWS
from blind.family_c.arms import World
from blind.family_c.description import NAME, arms_text, mapping_text
from blind.family_c.hidden import Hidden, Maker, Numbers
from blind.family_c.joint_laws import JOINT_LAWS
from blind.family_c.measure import errors
from blind.family_c.outside import OUTSIDE
from blind.family_c.plan import SETTINGS, Plan
from blind.family_c.plant import Unstable
from blind.family_c.records import Record, command, levels, record, table
from blind.family_c.weights import heaviest
from blind.sized import check_asked, first_met

__all__ = ["KINDS", "SETTINGS", "make"]

CATALOGUE = {**JOINT_LAWS, **ARM_LAWS}
KINDS = ("nothing", *CATALOGUE, *(f"outside:{name}" for name in OUTSIDE))
LOST = ("joint_flexibility", "backlash", "presliding")
STIFF_LEVERS = ("joint_flexibility", "backlash")  # the plant bends direct drives alone
THREE = ("base_tilt", "encoder_offset")
RUNS = 6  # of the plant in search of a strength
CLOSE = 0.04  # share of s - 1 to which a size is met
ATTEMPTS = 6  # arms drawn, where one runs away or cannot show the effect in the size asked for
BEARS = 0.3  # least weight that a joint bears, by its largest effort, for friction by the load


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


def _make(seed: int, attempt: int, kind: str, size: float | None, setting: str) -> Case | None:
    """The case, or None where the arm has no joint for the effect."""
    rng = np.random.default_rng([seed, attempt, zlib.crc32(f"c/{kind}/{setting}".encode())])
    joints = draw.count(rng, 3 if kind in THREE else 2)
    plan = plans.draw(rng, setting, joints)
    if kind == "payload_change":
        plan = replace(plan, train=max(plan.train, 2))
    world = draw.draw(rng, joints, True if kind == "lever_geometry" else None)
    k = _place(rng, world, kind)
    if k is None:
        return None
    hidden = None if kind == "nothing" else _maker(kind)(rng, world, plan, k)
    noise_seed = int(rng.integers(2**31))
    motions = [command(world, plan, noise_seed, n) for n in range(plan.train + 1)]
    base = world if hidden is None or hidden.believed is None else hidden.believed
    noise = levels(world, plan, noise_seed)

    def taken(actual: World, count: int) -> list[Record]:
        return [record(actual, base, plan, noise_seed, n, motions[n], noise) for n in range(count)]

    strength, truth, actual = 0.0, Truth(None), world
    if hidden is not None:
        strength, got = _strength(rng, hidden, base, plan, taken, size)
        actual = hidden.put(strength)
        numbers = tuple(None if j is None else j + 1 for j in hidden.joints)
        truth = Truth(hidden.effect, numbers, hidden.values(strength), hidden.text, got)
    records = taken(actual, plan.train + 1)
    names = [*(f"train_{n + 1}" for n in range(plan.train)), "test"]
    tables = {name: table(base, plan, one) for name, one in zip(names, records, strict=True)}
    facts: dict[str, object] = {
        "plan": asdict(plan), "joints": joints, "strength": strength, "attempt": attempt,
        "levered": [lever is not None for lever in world.levers],
        "slides": [link.slides for link in world.links],
        "gravity": list(world.gravity),
    }  # fmt: skip
    text = arms_text(base, plan, np.random.default_rng([noise_seed, 3]))
    return Case(
        "c", seed, kind, size, setting, NAME, text, mapping_text(base, plan), tables, tuple(names[:-1]),
        "test", truth, facts,
    )  # fmt: skip


def _maker(kind: str) -> Maker:
    return OUTSIDE[kind.removeprefix("outside:")] if kind.startswith("outside:") else CATALOGUE[kind]


def _place(rng: Numbers, world: World, kind: str) -> int | None:
    """Joint at which a kind is put (from 0), or None where there is none for it."""
    last = world.count - 1
    numbers = list(range(world.count))
    if kind == "lever_geometry":
        numbers = [k for k in numbers if world.levers[k] is not None]
    elif kind in STIFF_LEVERS:
        numbers = [k for k in numbers if world.levers[k] is None]
    elif kind == "drive_inertia":  # at the first joint it is one with the link's inertia
        numbers = numbers[1:]
    elif kind == "encoder_offset":  # of a first joint it is a tilt, of a last one another link
        numbers = numbers[1:last]
    elif kind in ("load_dependent_friction", "outside:loaded_oil"):
        borne = heaviest(world) / np.array([world.scale[k] * world.middle_gear(k) for k in numbers])
        numbers = [k for k in numbers if borne[k] > BEARS / 0.18]
    return int(rng.choice(numbers)) if numbers else None


def _strength(
    rng: Numbers,
    hidden: Hidden,
    base: World,
    plan: Plan,
    taken: Callable[[World, int], list[Record]],
    size: float | None,
) -> tuple[float, float]:
    """Strength of the hidden effect for a size, and the size that it has.

    The growth s^2 - 1 is nearly the square of the strength: a secant over both logarithms.
    """
    clean = errors(base, plan, taken(base, plan.train))

    def measured(x: float) -> float:
        left = errors(base, plan, taken(hidden.put(x), plan.train)) / clean
        return float(left[hidden.at]) if hidden.at is not None else float(np.sqrt(np.mean(left**2)))

    if size is None:
        x = math.exp(rng.uniform(*np.log(hidden.free)))
        return x, measured(x)
    wanted = math.log(size**2 - 1)
    x, slope = hidden.start, 2.0
    tried: list[tuple[float, float, float]] = []
    for _ in range(RUNS):
        got = measured(x)
        grown = math.log(max(got**2 - 1, 1e-3))
        tried.append((x, got, grown))
        if abs(got - size) < CLOSE * (size - 1):
            break
        if len(tried) > 1:
            (x0, _, g0), (x1, _, g1) = tried[-2:]
            if abs(math.log(x1 / x0)) > 1e-6 and (g1 - g0) / math.log(x1 / x0) > 0.3:
                slope = min((g1 - g0) / math.log(x1 / x0), 6.0)
        new = min(max(x * math.exp(max(-3.0, min(3.0, (wanted - grown) / slope))), hidden.least), hidden.most)
        if new == x:
            break
        x = new
    x, got, _ = min(tried, key=lambda row: abs(row[1] - size))
    return x, got
