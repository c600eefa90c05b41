"""How the records of a case are taken: number, rate, length, encoders, noise, and the currents' instant."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

SETTINGS = ("four", "two", "ordinary", "lost_motion", "mixed")
RATES = (100, 125, 200, 250, 400, 500, 1000)
WHITE = (0.01, 0.08)  # standard deviation of the current's noise, by its RMS
COLOURED = (0.003, 0.02)


@dataclass(frozen=True)
class Plan:
    """How the records are taken.

    train: training records; rate [Hz]; seconds of a record; period of the motion [s], None: ordinary work;
    orders: harmonics of a periodic motion.
    motor_side: of each joint's logged encoder; bits: of it, by turn (of a sliding joint: by 0.1 m).
    hold: what the mapping says of the currents' instant: a name, or the delay after the position's [s].
    white, coloured: noise by the current's RMS; memory: time constant of the coloured part [s].
    links: whether the user knows nominal inertials, and how wrong they are at most.
    """

    train: int
    rate: int
    seconds: float
    period: float | None
    orders: int
    motor_side: tuple[bool, ...]
    bits: tuple[int, ...]
    hold: str | float
    white: float
    coloured: float
    memory: float
    links: float | None

    @property
    def shift(self) -> float:
        """Time from a row's position to the middle of what its current stands for [s]."""
        if isinstance(self.hold, float):
            return self.hold
        return {"instant": 0.0, "previous": -0.5 / self.rate, "following": 0.5 / self.rate}[self.hold]


def draw(rng: np.random.Generator, setting: str, count: int) -> Plan:
    """Plan of a setting for `count` joints. Raises ValueError for settings that are not in SETTINGS."""
    if setting not in SETTINGS:
        raise ValueError(f"unknown setting {setting!r}: one of {', '.join(SETTINGS)}")
    period: float | None = float(rng.uniform(6, 12))
    train, rate, seconds = 4, 500, 30.0
    if setting == "two":
        train, rate, period = 2, 100, 10.0
    elif setting == "ordinary":
        train, rate, seconds = int(rng.integers(2, 5)), int(rng.choice([100, 125, 250])), rng.uniform(20, 60)
        period = None
    elif setting == "lost_motion":
        train, rate = int(rng.integers(2, 5)), int(rng.choice([100, 200, 250, 500]))
    elif setting == "mixed":
        train, rate, seconds = int(rng.integers(1, 5)), int(rng.choice(RATES)), rng.uniform(10, 60)
        period = None if rng.random() < 0.4 else float(rng.uniform(4, min(10.0, seconds / 2)))
    if period is not None:
        period = round(period * rate) / rate
        seconds = period * max(2, int(seconds / period + 1e-9))
    motor_side = setting == "lost_motion" or rng.random() < 0.5
    bits = rng.integers(11, 17, count) if motor_side else rng.integers(16, 21, count)
    hold = str(rng.choice(["instant", "previous", "following", "lag"]))
    return Plan(
        train=train,
        rate=rate,
        seconds=float(seconds),
        period=period,
        orders=int(rng.integers(3, 7)),
        motor_side=(motor_side,) * count,
        bits=tuple(int(b) for b in bits),
        hold=float(np.round(rng.uniform(-2.5e-3, 1e-3), 4)) if hold == "lag" else hold,
        white=_between(rng, WHITE),
        coloured=_between(rng, COLOURED),
        memory=float(rng.uniform(0.005, 0.05)),
        links=float(rng.choice([0.0, 0.05, 0.15])) if rng.random() < 0.6 else None,
    )


def _between(rng: np.random.Generator, ends: tuple[float, float]) -> float:
    return float(math.exp(rng.uniform(math.log(ends[0]), math.log(ends[1]))))
