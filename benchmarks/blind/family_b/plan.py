"""How the records of a case are taken: number, rate, length, encoders, and when the current is logged."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

SETTINGS = ("four", "two", "ordinary", "lost_motion", "mixed")
RATES = (50, 100, 125, 200, 250, 500, 1000)
TIMINGS = ("instant", "previous", "following", "late", "early")
FINEST = 17  # bits of a turn, of encoders at a motor
NOISE = (0.02, 0.15)  # of a sixth of the current's limit, about the current that flows
EVERY_TWIST = 0.15  # share of the cases of "mixed" with repeated readings


@dataclass(frozen=True)
class Plan:
    """How the records are taken.

    train: training records; rate [Hz]; seconds of a record; period of the motion [s], None: ordinary work.
    sides, bits: of each axis's logged encoder, "motor" or "joint"; bits by turn.
    timing: when the current of a row flows: at the position's instant, on average over the interval before or
    after, or late or early by `lag` [s], which the mapping says.
    noise: standard deviation of the current, by a sixth of its limit; repeats: rows by reading.
    on_and_on: stamps and heat run on from record to record, else every record begins cold.
    links: whether the user knows nominal inertials, and how wrong they are at most.
    """

    train: int
    rate: int
    seconds: float
    period: float | None
    sides: tuple[str, str, str]
    bits: tuple[int, int, int]
    timing: str
    lag: float
    noise: float
    repeats: int
    on_and_on: bool
    links: float | None

    @property
    def hold(self) -> str | float:
        """What the mapping says of the current's instant."""
        if self.timing in ("late", "early"):
            return -self.lag if self.timing == "late" else self.lag
        return self.timing

    @property
    def shift(self) -> float:
        """Time from a row's position to the instant of its current [s]."""
        half = 0.5 / self.rate
        return {
            "instant": 0.0, "previous": -half, "following": half, "late": -self.lag, "early": self.lag
        }[self.timing]  # fmt: skip


def motor_grain(plan: Plan, axis: int) -> float:
    """Increment of an encoder that is logged at the motor [rad]."""
    return float(2 * math.pi / 2 ** min(plan.bits[axis], FINEST))


def draw(rng: np.random.Generator, setting: str) -> Plan:
    """Plan of a setting. Raises ValueError for settings that are not in SETTINGS."""
    timing = str(rng.choice(TIMINGS))
    side = str(rng.choice(["motor", "joint"]))
    repeats, train, rate, period, seconds = 1, 4, 500, float(rng.integers(6, 11)), 30.0
    if setting == "two":
        train, rate, period, seconds = 2, 100, 10.0, 30.0
        timing = "instant"
    elif setting == "ordinary":
        train, rate, seconds = (
            int(rng.integers(2, 5)),
            int(rng.choice([100, 125, 200, 250])),
            rng.uniform(20, 60),
        )
    elif setting == "lost_motion":
        train, rate, side = int(rng.integers(2, 5)), int(rng.choice([100, 200, 250, 500])), "motor"
    elif setting == "mixed":
        train, rate = int(rng.integers(1, 5)), int(rng.choice(RATES))
        period, seconds = float(rng.integers(4, 11)), rng.uniform(8, 60)
        repeats = int(rng.choice([2, 3])) if rng.random() < EVERY_TWIST else 1
    elif setting != "four":
        raise ValueError(f"unknown setting {setting!r}: one of {', '.join(SETTINGS)}")
    if repeats > 1:
        timing = "instant"
    repeating = setting != "ordinary" and not (setting == "mixed" and rng.random() < 0.4)
    if repeating:
        seconds = period * max(2, int(seconds / period))
    coarsest = 12 if setting == "mixed" else 16 if rate <= 100 else 15
    if side == "motor":
        bits = tuple(int(b) for b in rng.integers(12, 18, 3))
    else:
        bits = tuple(int(b) for b in rng.integers(coarsest, 21, 3))
    return Plan(
        train=train,
        rate=rate,
        seconds=float(seconds),
        period=period if repeating else None,
        sides=(side,) * 3,
        bits=(bits[0], bits[1], bits[2]),
        timing=timing,
        lag=float(np.round(rng.uniform(0.2e-3, 3e-3), 5)),
        noise=float(np.exp(rng.uniform(*np.log(NOISE)))),
        repeats=repeats,
        on_and_on=False,
        links=float(rng.choice([0.0, 0.05, 0.15])) if rng.random() < 0.7 else None,
    )
