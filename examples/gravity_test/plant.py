"""Simulated measurements of link 2: a pendulum with a hidden spring and stiction, integrated by itself.

python examples/gravity_test/plant.py --out DIR [--seed N]

Writes link2_<angle>_<run>.csv with the columns t [s] and q1 [rad]: ten runs from each of 20, 30 and 40
degrees, without effort. Nothing here imports modelgen.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import copysign, exp, pi, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
DURATIONS = {20: 16.315, 30: 23.045, 40: 26.995}  # s, of the published measurements
RUNS = 10
RATE = 200  # Hz
LINE = 2 * pi / 40_000  # rad, one count of the encoder
START, NOISE = radians(0.15), 1.5e-4  # rad, standard deviations: of the angle let go from, of a sample


@dataclass(frozen=True)
class Pendulum:
    """inertia ddq = -moment sin q - stiffness (q - rest) - viscous dq - f(dq) sign dq, in SI units.

    f = coulomb + excess exp(-|dq| / velocity). Standing, it holds any effort up to coulomb + excess
    (Armstrong-Helouvry, Dupont and Canudas de Wit 1994).
    """

    inertia: float
    moment: float
    viscous: float
    coulomb: float
    stiffness: float = 0.0
    rest: float = 0.0
    excess: float = 0.0
    velocity: float = 1.0

    def load(self, q: float) -> float:
        """Effort [N m] that friction has to take at rest."""
        return -self.moment * sin(q) - self.stiffness * (q - self.rest)

    def swing(self, start: float, times: Array) -> Array:
        """Angles [rad] at `times` [s] after the release from `start` [rad], exact at every stop."""
        q, t, found, filled = start, float(times[0]), np.empty(len(times)), 0
        while filled < len(times):
            load = self.load(q)
            if abs(load) <= self.coulomb + self.excess:
                found[filled:] = q
                break
            side = copysign(1.0, load)
            leg = solve_ivp(
                self._rates(side),
                (t, float(times[-1])),
                [q, 0.0],
                method="DOP853",
                rtol=1e-10,
                atol=1e-12,
                events=_stop(side, t),
                dense_output=True,
            )
            t, q = float(leg.t[-1]), float(leg.y[0, -1])
            last = int(np.searchsorted(times, t, side="right"))
            found[filled:last] = leg.sol(times[filled:last])[0]
            filled = last
        return found

    def _rates(self, side: float) -> Callable[[float, Array], list[float]]:
        def rates(_: float, y: Array) -> list[float]:
            q, v = float(y[0]), float(y[1])
            friction = self.coulomb + self.excess * exp(-abs(v) / self.velocity)
            return [v, (self.load(q) - self.viscous * v - side * friction) / self.inertia]

        return rates


def _stop(side: float, begin: float) -> Any:
    """The velocity, zero where the leg that began at `begin` ends."""

    def stop(t: float, y: Array) -> float:
        return side * float(y[1]) if t > begin else 1.0

    stop.terminal = True  # type: ignore[attr-defined]
    stop.direction = -1.0  # type: ignore[attr-defined]
    return stop


# Link 2 of the published Table 2: its inertia about the axis, weight times lever, its friction.
PUBLISHED = Pendulum(0.056052 + 6.743220 * 0.193949**2, 6.743220 * 0.193949 * 9.81, 0.235819, 0.187307)
HIDDEN = replace(PUBLISHED, stiffness=0.08 * PUBLISHED.moment, rest=radians(18), excess=0.1, velocity=0.1)


def measured(pendulum: Pendulum, degrees: int, seed: int) -> tuple[Array, Array]:
    """Times [s] and RUNS angles (RUNS, S) [rad] as an encoder on a noisy rig would give them."""
    random = np.random.default_rng([seed, degrees])
    times = np.arange(round(DURATIONS[degrees] * RATE) + 1) / RATE
    runs = [pendulum.swing(radians(degrees) + START * random.standard_normal(), times) for _ in range(RUNS)]
    noisy = np.array(runs) + NOISE * random.standard_normal((RUNS, len(times)))
    return times, LINE * np.round(noisy / LINE)


def write(folder: Path, pendulum: Pendulum = HIDDEN, seed: int = 0) -> list[Path]:
    """The thirty logs in `folder`, angle after angle."""
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for degrees in DURATIONS:
        times, runs = measured(pendulum, degrees, seed)
        for k, run in enumerate(runs):
            files.append(folder / f"link2_{degrees}_{k + 1}.csv")
            rows = [f"{t:.3f},{q:.6f}\n" for t, q in zip(times, run, strict=True)]
            files[-1].write_text("t,q1\n" + "".join(rows), encoding="utf-8", newline="\n")
    return files


def main() -> None:
    """Write the logs that the command line asks for."""
    parser = argparse.ArgumentParser(description="Simulated measurements of the gravity test, link 2.")
    parser.add_argument("--out", type=Path, required=True, help="folder to write into")
    parser.add_argument("--seed", type=int, default=0, help="of the noise")
    given = parser.parse_args()
    if given.seed < 0:
        parser.error(f"--seed {given.seed}: expected 0 or more")
    try:
        files = write(given.out, seed=given.seed)
    except OSError as error:
        parser.error(f"--out {given.out}: cannot write: {error.strerror or error}")
    print(f"{len(files)} logs in {given.out}")


if __name__ == "__main__":
    main()
