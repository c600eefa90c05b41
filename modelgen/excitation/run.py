"""An arm's excitation trajectory: many starts in parallel, the best one kept."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.excitation.counting import Progress, counted
from modelgen.excitation.optimisation import Optimiser, merit
from modelgen.excitation.problem import SIGNALS, Problem, problem, smooth
from modelgen.excitation.random_motion import feasible
from modelgen.excitation.spectrum import condition
from modelgen.jobs import Where, run
from modelgen.numeric import Array
from modelgen.options import ExcitationOptions


@dataclass(frozen=True)
class Excitation:
    """A trajectory of one period.

    z: its coefficients as the problem has them. t: (N,) [s], the period's end excluded. signals: name to
    (N, n): q, dq, ddq in joint coordinates, qm, dqm, ddqm in motor coordinates, input [A, or N m and N],
    effort [N m, N], the latter two NaN without nominal parameters. condition: after scaling the columns of
    the observation matrix to unit norm; raw: without, so of the units as they are. usage: largest share of
    every limit. values: condition numbers that the starts ended with, in their order.
    """

    arm: Arm
    problem: Problem
    z: Array
    t: Array
    signals: dict[str, Array]
    condition: float
    raw: float
    usage: dict[str, float]
    values: tuple[float, ...]


def excite(arm: Arm, settings: ExcitationOptions, progress: Progress | None = None) -> Excitation:
    """The best trajectory of all starts; the same wherever they run, in any number of processes.

    Raises InputError for settings that make no trajectory, missing limits, limits that exclude each
    other, and a cluster that cannot be reached.
    """
    p = problem(arm, settings)
    found: list[Array | None] = [None] * settings.starts
    where = Where(settings.processes, settings.dask)
    # One job per start; a worker keeps the programme that it has built.
    eased = smooth(arm, settings)
    with counted(settings.starts, settings.iterations, progress) as counts:
        starts = [(p, eased, k, counts.file(k)) for k in range(settings.starts)]
        for k, z in run(_one, starts, where):
            found[k] = z
            counts.ended(k)
    merits = [np.inf if z is None else merit(p, z) for z in found]
    best = found[int(np.argmin(merits))]
    if best is None or not np.isfinite(min(merits)):
        raise InputError(f"{arm.name}: no start found a trajectory that excites every base parameter")
    return described(arm, p, best, tuple(found))


def described(arm: Arm, p: Problem, z: Array, found: tuple[Array | None, ...] = ()) -> Excitation:
    """A trajectory with its signals and figures."""
    t = p.at_rate()
    w, _ = p.observation(z, t)
    limits = p.sampled(p.exact, z, t)[1][:, :, 0]
    signals = {name: value[:, :, 0] for name, value in zip(SIGNALS, p.sampled(p.motion, z, t), strict=True)}
    values = [np.inf if one is None else condition(p.observation(one, t)[0]) for one in found]
    usage = dict(zip(p.constraints, (float(x) for x in np.abs(limits).max(axis=0)), strict=True))
    return Excitation(
        arm, p, z, t, signals, condition(w), condition(w, scaled=False), usage, tuple(map(float, values))
    )


def random_conditions(p: Problem, count: int, seed: int) -> Array:
    """Condition numbers (count,) of random trajectories within the limits, at the settings' rate."""
    rng = np.random.default_rng(seed)
    t = p.at_rate()
    return np.array([condition(p.observation(feasible(p, rng), t)[0]) for _ in range(count)])


_kept: list[tuple[tuple[str | bytes | ExcitationOptions, ...], Optimiser]] = []


def _one(start: tuple[Problem, ca.Function, int, str]) -> Array | None:
    p, eased, k, count = start
    # Of another arm the names may be the same: the programme itself is compared.
    key = (p.settings, eased.serialize(), p.middle.tobytes(), p.amplitude.tobytes())
    if not _kept or _kept[0][0] != key:
        _kept[:] = [(key, Optimiser(p, eased))]
    return _kept[0][1].start(k, count)
