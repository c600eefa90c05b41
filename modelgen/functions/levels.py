"""Gains and thresholds of the functions that watch an arm, for one false alarm in a day of motion."""

from __future__ import annotations

from collections.abc import Sequence
from math import erf, exp, pi, sqrt

import numpy as np

from modelgen.functions.assembly import Assembly
from modelgen.functions.monitor import monitored_parameters
from modelgen.functions.nominal import factor_value
from modelgen.functions.objects import Levels
from modelgen.options.noise import Noise

BETWEEN_FALSE_ALARMS = 24 * 3600.0  # s
# Threshold of the observer over the level of its process: errors of a model depend on the motion. On logs of
# a real double pendulum (Wiebe et al. 2023) other motions gave up to 1.4 times that of the record.
MARGIN = 1.5
MEMORY = 300.0  # s of motion that the monitor's estimates rest on


def levels(a: Assembly, noise: Noise, values: Sequence[float]) -> Levels:
    """Levels for the identified `values` of the base parameters and their noise.

    The observer's threshold is that of a process with the deviation of what it gave along the records; rare
    large values there count as if the deviation were larger.
    """
    n = a.n
    of_record = passage_level(noise.gain, noise.duration)
    high = passage_level(noise.gain, BETWEEN_FALSE_ALARMS * n)
    threshold = [
        MARGIN * high * max(s, most / of_record) for s, most in zip(noise.rms, noise.largest, strict=True)
    ]
    names = monitored_parameters(a)
    start, std = [], []
    for one in names:
        start.append(values[one.base[0][0]] if one.own else 0.0)
        terms = {k: factor_value_of(a, one.standard, k) for k, _ in one.base} if not one.own else {}
        shares = terms or {one.base[0][0]: 1.0}
        known = [(f, noise.parameters.get(a.grouping.base[k].name, 0.0)) for k, f in shares.items()]
        weight = sum((f / s) ** 2 for f, s in known if s > 0)
        std.append(weight**-0.5 if weight else 0.0)
    return Levels(
        (noise.gain,) * n,
        tuple(threshold),
        tuple(one.name for one in names),
        tuple(start),
        tuple(std),
        max(noise.correlation),
        MEMORY,
        passage_level(1 / MEMORY, BETWEEN_FALSE_ALARMS * max(1, len(names))),
    )


def factor_value_of(a: Assembly, standard: int, base: int) -> float:
    """How much of a base parameter a unit of a standard one changes."""
    (factor,) = [f for i, f in a.grouping.base[base].terms if i == standard]
    return factor_value(factor, a.real.arm.symbols)


def passage_level(bandwidth: float, duration: float) -> float:
    """z such that noise of unit variance, low-passed with `bandwidth` [1/s], first leaves [-z, z] after
    `duration` [s] on average.

    Of the process of Ornstein and Uhlenbeck, from 0 (Darling and Siegert 1953):
    bandwidth duration = int_0^z exp(x^2/2) int_0^x exp(-y^2/2) dy dx.
    """
    # A third of what importing the functions takes, for arms with an identification alone.
    from scipy.integrate import quad  # noqa: PLC0415
    from scipy.optimize import brentq  # noqa: PLC0415

    def beyond(z: float) -> float:
        found, _ = quad(lambda x: exp(0.5 * (x * x - z * z)) * sqrt(pi / 2) * erf(x / sqrt(2)), 0.0, z)
        return float(np.log(found) + 0.5 * z * z - np.log(bandwidth * duration))

    return float(brentq(beyond, 1e-3, 30.0))
