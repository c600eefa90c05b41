"""A trajectory that separates causes: T-optimal over the coefficients of a Fourier series.

Atkinson and Fedorov (1975): the smallest discrepancy over all pairs of members is made as large as limits on
both sides of the drives allow, from random feasible starts, large and small, by an evolution strategy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.equations import Rows
from modelgen.diagnosis.experiment.discrimination import Discriminator, Hypothesis
from modelgen.diagnosis.experiment.motions import Setup
from modelgen.effects import Shows
from modelgen.errors import InputError
from modelgen.excitation.problem import SIGNALS, Problem, problem
from modelgen.excitation.random_motion import feasible, shrunk
from modelgen.excitation.run import Excitation, described
from modelgen.jobs import HERE, Where, forked
from modelgen.numeric import Array

# Budgets of the search.
SCALES = (1.0, 0.3, 0.1)  # of the random starts: some causes show in small motions
DRAWS = 8  # of each scale
STEPS = 30  # of the evolution strategy, from each of the best starts
BEST = 2  # starts that are refined
FIRST_STEP = 0.3  # of the coefficients' size
GROWTH, DECAY = 1.5, 0.84  # of a step that succeeded, or not: a fifth should (Rechenberg 1973)
Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Proposal:
    """A trajectory of one period. q (N, n), rows, evidence (k, k; see Discriminator): of all periods."""

    excitation: Excitation
    q: Array
    rows: Rows
    evidence: Array


def propose(
    stage: Setup,
    judge: Discriminator,
    members: Sequence[Hypothesis],
    period: int | None,
    progress: Progress | None = None,
    where: Where = HERE,
) -> Proposal | None:
    """The best of all starts, refined; None where no motion is within the limits or separates anything.

    where: processes among which starts are shared; the answer is the same.
    """
    settings, margin = stage.settings(period), stage.limits.limit_margin
    try:
        p = problem(stage.arm, settings)
        first = np.random.default_rng(settings.seed)
        drawn = [feasible(p, first, margin) for _ in range(DRAWS)]
    except InputError:
        return None
    runs = [as_run(stage, p, k) for k in range(len(stage.prepared))]
    starts = [z for z in runs if z is not None] + [scaled(z, factor) for z in drawn for factor in SCALES]

    asked = any(Shows.BRIEFLY in h.candidate.definition.shows for h in members)
    effects = [h.candidate.definition for h in (*members, *judge.before)]
    stepped = any(e.states for e in effects) or bool(stage.model.states)
    seen = stage if asked or stepped else stage.coarse

    def value(z: Array) -> float:
        return worth(seen, judge, members, p, z)

    def told(k: int) -> None:
        if progress is not None:
            progress("next experiment", k, len(starts) + BEST)

    found = forked(lambda k: value(starts[k]), len(starts), where, told)
    order = sorted(range(len(starts)), key=lambda k: -found[k])[:BEST]

    def refined(k: int) -> tuple[Array, float]:
        rng = np.random.default_rng([settings.seed, 1, k])
        return evolved(p, value, starts[order[k]], found[order[k]], rng, margin)

    ends = forked(refined, len(order), where, lambda k: told(len(starts) + k))
    best, most = max(ends, key=lambda end: end[1])
    if not np.isfinite(most):
        return None
    q = positions(p, best, stage.limits.periods)[0]
    rows = stage.rows(q)
    if rows is None:
        return None
    return Proposal(described(stage.arm, p, best), q, rows, judge.evidence(members, [rows]))


def evolved(
    p: Problem,
    value: Callable[[Array], float],
    best: Array,
    most: float,
    rng: np.random.Generator,
    margin: float,
) -> tuple[Array, float]:
    """Coefficients better than these, whose value is `most`, and theirs: one parent, one child. margin: of
    every limit.
    """
    step = FIRST_STEP
    for _ in range(STEPS):
        size = np.abs(best[:, 1:]).max(axis=1, keepdims=True)
        z = best.copy()
        z[:, 1:] += step * size * rng.normal(size=z[:, 1:].shape)
        z[:, :1] += step * np.minimum(1.0, size) * rng.normal(size=(len(z), 1))
        trial = shrunk(p, z, p.grid(), 1 - margin)
        found = -np.inf if trial is None else value(trial)
        step *= GROWTH if found > most else DECAY
        if trial is not None and found > most:
            best, most = trial, found
    return best, most


def worth(stage: Setup, judge: Discriminator, members: Sequence[Hypothesis], p: Problem, z: Array) -> float:
    """The least evidence of one period over all pairs; minus infinity where an effort would be too large."""
    q, dq, ddq = positions(p, z, 1, stage.every)
    if stage.overload(q, dq, ddq) > 1:
        return -np.inf
    rows = stage.rows(q)
    return -np.inf if rows is None else float(judge.evidence(members, [rows], wide=False).min())


def scaled(z: Array, factor: float) -> Array:
    """Shrink the motion about its middle."""
    return np.concatenate([z[:, :1], factor * z[:, 1:]], axis=1)


def as_run(stage: Setup, p: Problem, k: int) -> Array | None:
    """Motion of training record k as a series; None where it left the limits."""
    prepared, t = stage.prepared[k], p.at_rate()
    x = prepared.motor if p.settings.coordinates == "motor" else prepared.q
    begin = int(prepared.rows[0])
    x = (x[begin : begin + len(t)] - p.middle) / p.amplitude
    if len(x) < len(t):
        return None
    z = np.asarray(np.linalg.lstsq(p.basis.signals(t)[0], x, rcond=None)[0].T, dtype=np.float64)
    return shrunk(p, z, p.grid(), 1 - stage.limits.limit_margin)


def positions(p: Problem, z: Array, periods: int, every: int = 1) -> tuple[Array, Array, Array]:
    """q, dq, ddq (N, n) of so many periods at every so many samples of the settings' rate."""
    signals = dict(zip(SIGNALS, p.sampled(p.motion, z, p.at_rate()[::every]), strict=True))
    q, dq, ddq = (np.tile(signals[name][:, :, 0], (periods, 1)) for name in ("q", "dq", "ddq"))
    return q, dq, ddq
