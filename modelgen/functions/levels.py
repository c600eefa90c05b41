"""Gains and thresholds of the functions that watch an arm, for one false alarm in a day of motion."""

from __future__ import annotations

from collections.abc import Sequence
from math import erf, exp, pi, sqrt

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from modelgen.functions.assembly import Assembly
from modelgen.functions.momentum_observer import LARGEST_GAIN
from modelgen.functions.monitor import monitored_parameters
from modelgen.functions.nominal import factor_value
from modelgen.functions.objects import Levels
from modelgen.graph import Expr
from modelgen.graph.evaluate import evaluate
from modelgen.options.noise import Noise

BETWEEN_FALSE_ALARMS = 24 * 3600.0  # s
# Bandwidth of the observer over that of the records: of what lies beyond, which is unknown, little passes.
BANDWIDTH = 1 / 3
MEMORY = 300.0  # s of motion that the monitor's estimates rest on


def levels(a: Assembly, noise: Noise, values: Sequence[float]) -> Levels:
    """Levels for the identified `values` of the base parameters and their noise.

    The observer passes the errors of the inputs through a low pass within the bandwidth of the records in
    which they were found. Errors with rare large values count as if their deviation were larger.
    """
    n = a.n
    gain = min(2 * pi * BANDWIDTH * noise.cutoff or LARGEST_GAIN, LARGEST_GAIN)
    of_record = passage_level(gain, noise.duration)
    high = passage_level(gain, BETWEEN_FALSE_ALARMS * n)
    spread = [max(s, most / of_record) for s, most in zip(noise.input, noise.largest, strict=True)]
    threshold = [high * s * k for s, k in zip(spread, _largest_gains(a), strict=True)]
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
        (gain,) * n,
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

    def beyond(z: float) -> float:
        found, _ = quad(lambda x: exp(0.5 * (x * x - z * z)) * sqrt(pi / 2) * erf(x / sqrt(2)), 0.0, z)
        return float(np.log(found) + 0.5 * z * z - np.log(bandwidth * duration))

    return float(brentq(beyond, 1e-3, 30.0))


def _largest_gains(a: Assembly) -> list[float]:
    """Largest |K| of every joint over its range [effort per input]."""
    samples = 201
    q = np.zeros((samples, a.n))
    for n, drive in enumerate(a.real.drives):
        low, high = drive.transmission.joint_range() or (-pi, pi)
        q[:, n] = np.linspace(low, high, samples)
    given = {"q": q, "sin_q": np.sin(q), "cos_q": np.cos(q)}
    if a.real.arm.symbols:
        given["geometry"] = np.tile(list(a.real.arm.symbols.values()), (samples, 1))
    gains: list[Expr] = [d.k1 * d.transmission.torque_constant for d in a.real.drives]
    return [float(x) for x in np.abs(evaluate(gains, given, samples)).max(axis=0)]
