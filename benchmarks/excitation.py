"""Optimised trajectory of ariane4 against random ones: python benchmarks/excitation.py [random] [starts].

Three joints, five harmonics, a period of 80 s at 10 Hz, limits in the motor coordinates: the set-up of
Leborne, Creuze, Chemori and Brignone (2018).
"""

from __future__ import annotations

import sys
import time

import numpy as np

from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.excitation import excite, random_conditions
from modelgen.options import ExcitationOptions
from modelgen.resources import shipped_arms


def main(count: int, starts: int) -> None:
    """Print both."""
    arm = load(shipped_arms(), known_effects())["ariane4"]
    begin = time.perf_counter()
    found = excite(arm, ExcitationOptions(starts=starts, rate=10.0))
    middle = time.perf_counter()
    conditions = random_conditions(found.problem, count, seed=1)
    end = time.perf_counter()
    values = sorted(found.values)
    print(f"optimised, {starts} starts: best {values[0]:.2f}, median {np.median(values):.2f}, ", end="")
    print(f"worst {values[-1]:.2f}; unscaled {found.raw:.3g}")
    quantiles = np.quantile(conditions, [0, 0.01, 0.5, 0.99])
    names = ("best", "1 %", "median", "99 %")
    said = ", ".join(f"{name} {value:.1f}" for name, value in zip(names, quantiles, strict=True))
    print(f"random within the limits, {count}: {said}")
    print(f"random trajectories better than the best start: {(conditions < values[0]).sum()}")
    print(f"time of the starts over that of the random ones: {(middle - begin) / (end - middle):.2f}")


if __name__ == "__main__":
    given = [int(x) for x in sys.argv[1:3]]
    main(*(given + [1000, 16][len(given) :]))
