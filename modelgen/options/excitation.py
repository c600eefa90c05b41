"""Options of an excitation trajectory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.errors import InputError
from modelgen.options.field import documented, option

CRITERIA = ("cond", "d_optimal")
COORDINATES = ("motor", "joint")


@dataclass(frozen=True)
class Box:
    """A box in which the origin of a link's frame must stay: low and high of x, y, z [m] in base axes."""

    link: str
    low: tuple[float, float, float]
    high: tuple[float, float, float]

    def __str__(self) -> str:
        """As `box` reads it."""
        ends = zip(self.low, self.high, strict=True)
        ranges = [":".join(f"{x:.12g}" if math.isfinite(x) else "" for x in pair) for pair in ends]
        return f"{self.link}={','.join(ranges)}"


@documented()
@dataclass(frozen=True)
class ExcitationOptions:
    """How an excitation trajectory is made; see docs/excitation.md.

    Raises InputError for a box that cannot be read; `checked` tests the rest.
    """

    period: float = option(80.0, "Period of the trajectory.", "S", unit="s")
    harmonics: int = option(5, "Harmonics of 1/period.", "N")
    rate: float = option(100.0, "Set-points per second: the controller's.", "HZ", unit="Hz")
    criterion: str = option("cond", "cond or d_optimal.", "NAME")
    coordinates: str = option("motor", "motor or joint: what the Fourier series gives.", "NAME")
    starts: int = option(8, "Random starts, in parallel.", "N")
    seed: int = option(0, "Of the random starts.", "N", least=0)
    rest: bool = option(False, "Start and end with zero speed and acceleration.")
    velocity: float | None = option(
        None, "Speed limit of joints without one, rad/s or m/s.", "V", unit="rad/s or m/s"
    )
    acceleration: float | None = option(
        None, "Likewise the acceleration, rad/s2 or m/s2.", "A", unit="rad/s2 or m/s2"
    )
    boxes: tuple[Box, ...] = option(
        (),
        "LINK=x0:x1,y0:y1,z0:z1 in m, where the origin of its frame must stay; repeatable.",
        "BOX",
        ["--box"],
        kind=list[str],
        unit="m, base axes",
    )
    iterations: int = option(150, "Most iterations of one start.", "N", least=1)
    processes: int | None = option(
        None, "Processes. Default: one per processor.", "N", ["-j", "--jobs"], least=1
    )
    dask: str | None = option(
        None, "Scheduler of a Dask cluster that has the work: tcp://host:8786.", "ADDRESS", ["--dask"]
    )

    def __post_init__(self) -> None:
        given: Sequence[Box | str] = self.boxes
        object.__setattr__(self, "boxes", tuple(box(b) if isinstance(b, str) else b for b in given))

    def checked(self) -> ExcitationOptions:
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
