"""A trajectory that separates causes: T-optimal over the coefficients of a Fourier series.

Atkinson and Fedorov (1975): the smallest discrepancy over all pairs of members is made as large as limits on
both sides of the drives allow, from random feasible starts, large and small, by an evolution strategy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.motions import Stage
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.separation import Hypothesis, Judge
from modelgen.errors import InputError
from modelgen.excitation.problem import SIGNALS, Problem, problem
from modelgen.excitation.random_motion import feasible, shrunk
from modelgen.excitation.run import Excitation, described

SCALES = (1.0, 0.3, 0.1)  # of the random starts: some causes show in small motions
DRAWS = 8  # of each scale
STEPS = 60  # of the evolution strategy
PERIODS = 3  # to be run
FIRST_STEP = 0.3  # of the coefficients' size
GROWTH, DECAY = 1.5, 0.84  # of a step that succeeded, or not: a fifth should (Rechenberg 1973)
MARGIN = 0.01  # of every limit

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Proposal:
    """A trajectory of one period. q (N, n), rows, evidence (k, k; see Judge): of PERIODS."""

    excitation: Excitation
    q: Array
    rows: Rows
    evidence: Array


def propose(
    stage: Stage,
    judge: Judge,
    members: Sequence[Hypothesis],
    period: int | None,
    progress: Progress | None = None,
) -> Proposal | None:
    """The best of all starts, refined; None where no motion is within the limits or separates anything."""
    settings = stage.settings(period)
    try:
        p = problem(stage.arm, settings)
        first = np.random.default_rng(settings.seed)
        drawn = [feasible(p, first, MARGIN) for _ in range(DRAWS)]
    except InputError:
        return None
    rng = np.random.default_rng([settings.seed, 1])
    total, done = len(stage.prepared) + len(SCALES) * DRAWS + STEPS, 0

    def value(z: Array) -> float:
        nonlocal done
        if progress is not None:
            progress("next experiment", done, total)
        done += 1
        return worth(stage, judge, members, p, z)

    best, most = drawn[0], -np.inf
    starts = [z for z in (as_run(stage, p, k) for k in range(len(stage.prepared))) if z is not None]
    for z in [*starts, *(scaled(z, factor) for z in drawn for factor in SCALES)]:
        found = value(z)
        if found > most:
            best, most = z, found
    step = FIRST_STEP
    for _ in range(STEPS):
        size = np.abs(best[:, 1:]).max(axis=1, keepdims=True)
        z = best.copy()
        z[:, 1:] += step * size * rng.normal(size=z[:, 1:].shape)
        z[:, :1] += step * np.minimum(1.0, size) * rng.normal(size=(len(z), 1))
        trial = shrunk(p, z, p.grid(), 1 - MARGIN)
        found = -np.inf if trial is None else value(trial)
        step *= GROWTH if found > most else DECAY
        if trial is not None and found > most:
            best, most = trial, found
    if not np.isfinite(most):
        return None
    q = positions(p, best, PERIODS)[0]
    rows = stage.rows(q)
    if rows is None:
        return None
    return Proposal(described(stage.arm, p, best), q, rows, judge.evidence(members, [rows]))


def worth(stage: Stage, judge: Judge, members: Sequence[Hypothesis], p: Problem, z: Array) -> float:
    """The least evidence of one period over all pairs; minus infinity where an effort would be too large."""
    q, dq, ddq = positions(p, z, 1)
    if stage.overload(q, dq, ddq) > 1:
        return -np.inf
    rows = stage.rows(q)
    return -np.inf if rows is None else float(judge.evidence(members, [rows], wide=False).min())


def scaled(z: Array, factor: float) -> Array:
    """The same motion about the same middle, smaller."""
    return np.concatenate([z[:, :1], factor * z[:, 1:]], axis=1)


def as_run(stage: Stage, p: Problem, k: int) -> Array | None:
    """What training record k ran, as a series; None where it left the limits."""
    prepared, t = stage.prepared[k], p.at_rate()
    x = prepared.motor if p.settings.coordinates == "motor" else prepared.q
    begin = int(prepared.rows[0])
    x = (x[begin : begin + len(t)] - p.middle) / p.amplitude
    if len(x) < len(t):
        return None
    z = np.asarray(np.linalg.lstsq(p.basis.signals(t)[0], x, rcond=None)[0].T, dtype=np.float64)
    return shrunk(p, z, p.grid(), 1 - MARGIN)


def positions(p: Problem, z: Array, periods: int) -> tuple[Array, Array, Array]:
    """q, dq, ddq (N, n) of so many periods at the settings' rate."""
    signals = dict(zip(SIGNALS, p.sampled(p.motion, z, p.at_rate()), strict=True))
    q, dq, ddq = (np.tile(signals[name][:, :, 0], (periods, 1)) for name in ("q", "dq", "ddq"))
    return q, dq, ddq
