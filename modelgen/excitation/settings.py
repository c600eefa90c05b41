"""What an excitation is asked for, and what comes back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from modelgen.errors import InputError

CRITERIA = ("cond", "d_optimal")
COORDINATES = ("motor", "joint")


@dataclass(frozen=True)
class Box:
    """Where the origin of a link's frame must stay: low and high of x, y, z [m] in base axes."""

    link: str
    low: tuple[float, float, float]
    high: tuple[float, float, float]


@dataclass(frozen=True)
class Settings:
    """How the trajectory is to be made.

    period [s]; harmonics: of 1/period; rate [Hz] of the samples. criterion: one of CRITERIA.
    coordinates: in which of COORDINATES the Fourier series is written. starts: random starts of the
    optimisation; seed: of their draws. rest: start and end with zero speed and acceleration.
    iterations: most of one start. processes: None for one per processor; dask: address of a scheduler
    that has the starts instead. velocity, acceleration: limits [rad/s, m/s and per s^2] for joints that
    have none. boxes: for frame origins.
    """

    period: float = 80.0
    harmonics: int = 5
    rate: float = 10.0
    criterion: str = "cond"
    coordinates: str = "motor"
    starts: int = 8
    seed: int = 0
    rest: bool = False
    iterations: int = 150
    processes: int | None = None
    dask: str | None = None
    velocity: float | None = None
    acceleration: float | None = None
    boxes: tuple[Box, ...] = ()

    def checked(self) -> Settings:
        """Self. Raises InputError for values that make no trajectory."""
        for name, value in (("period", self.period), ("rate", self.rate)):
            if not (math.isfinite(value) and value > 0):
                raise InputError(f"--{name}: found {value:g}, expected a positive number")
        for name in ("velocity", "acceleration"):
            given = getattr(self, name)
            if given is not None and not (math.isfinite(given) and given > 0):
                raise InputError(f"--{name}: found {given:g}, expected a positive number")
        if self.harmonics < (2 if self.rest else 1):
            least = "2 with --rest" if self.rest else "1"
            raise InputError(f"--harmonics: found {self.harmonics}, expected at least {least}")
        if self.starts < 1:
            raise InputError(f"--starts: found {self.starts}, expected at least 1")
        for name, word, known in (
            ("criterion", self.criterion, CRITERIA),
            ("coordinates", self.coordinates, COORDINATES),
        ):
            if word not in known:
                raise InputError(f"--{name}: found '{word}', expected {' or '.join(known)}")
        if self.rate * self.period < 4 * self.harmonics:
            raise InputError(
                f"--rate: found {self.rate:g} Hz, expected at least {4 * self.harmonics / self.period:g} Hz: "
                f"four samples in a period of the highest harmonic"
            )
        if abs(self.rate * self.period - round(self.rate * self.period)) > 1e-6 * self.rate * self.period:
            raise InputError(
                f"--period: found {self.period:g} s, {self.rate * self.period:g} samples at "
                f"{self.rate:g} Hz; expected a whole number of samples"
            )
        return self


def box(text: str) -> Box:
    """A box from `LINK=x0:x1,y0:y1,z0:z1` [m], an empty end being open. Raises InputError."""
    link, _, ranges = text.partition("=")
    parts = [part.split(":") for part in ranges.split(",")]
    if not link or len(parts) != 3 or any(len(part) != 2 for part in parts):
        raise InputError(
            f"--box: found '{text}', expected LINK=x0:x1,y0:y1,z0:z1 in m, as in j4=:,:,0.1: for a floor"
        )
    low: list[float] = []
    high: list[float] = []
    for part in parts:
        for ends, end, default in ((low, part[0], -math.inf), (high, part[1], math.inf)):
            try:
                ends.append(float(end) if end.strip() else default)
            except ValueError:
                raise InputError(f"--box {text}: found '{end}', expected a number of metres") from None
    if any(not a < b for a, b in zip(low, high, strict=True)):
        raise InputError(f"--box {text}: found an empty range, expected low:high with low below high")
    return Box(link, (low[0], low[1], low[2]), (high[0], high[1], high[2]))
