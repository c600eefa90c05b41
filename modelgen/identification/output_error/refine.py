"""Output-error refinement: parameters tuned until the simulated motion is the measured one.

Direct multiple shooting (Bock 1983): the states at which intervals begin are unknowns too, and equations ask
that each interval ends where the next begins. Every Gauss-Newton step condenses them to the parameters and
the initial state of each part.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.recorded import Recorded
from modelgen.effects import applied_effects
from modelgen.errors import InputError
from modelgen.identification.output_error.parts import Guess, parts
from modelgen.identification.output_error.sensitivities import Sensitive
from modelgen.identification.output_error.shooting import Fit, Linear, Step, scored
from modelgen.numeric import Array
from modelgen.simulation.metrics import Scores
from modelgen.simulation.plant import Plant

ROUNDS = 40
BOUNDARY = 0.9  # of the way to a bound in one step
BLOCKED = 0.01  # of a step, at which a bound is so near that its parameter stays and the others go on
HALVINGS = 8  # of a step that does not lower the cost
LEAST_GAIN = 1e-4  # of the cost, at which a fit ends
UNKEPT = 0.01  # of the cost: where a step promises more and brings less than the least, nothing has converged


@dataclass(frozen=True)
class Refined:
    """A base parameter before and after; std None where it was held, or the fit did not converge: then the
    values are not those of the least errors, and nothing says how far from them they are.

    per_unit: how far one unit of it moves the simulated positions (RMS [rad, m]) of the coordinate `shown_by`
    (from 0), at which it shows most beside the errors; 0 where it was held.
    """

    name: str
    unit: str
    start: float
    value: float
    std: float | None
    per_unit: float = 0.0
    shown_by: int = 0
    held: bool = False

    @property
    def moves(self) -> float:
        """How far its standard deviation moves the simulated positions (RMS [rad, m]); 0 without one."""
        return self.per_unit * (self.std or 0.0)


@dataclass(frozen=True)
class Refinement:
    """plant: with the refined parameters. before, after: scores of the whole simulated parts (rad, m), each
    from the initial states that suit its parameters best, so that what the parameters gain is theirs.

    measured, simulated, started: positions part by part (K, n), those of the refined parameters and of
    where they started; t their times. rounds: Gauss-Newton steps.
    stopped: why it ended before it converged, empty where it did converge. effort: whether the logs have
    efforts; else the motions are free. records: what was read.
    """

    plant: Plant
    parameters: tuple[Refined, ...]
    before: Scores
    after: Scores
    t: tuple[Array, ...]
    measured: tuple[Array, ...]
    simulated: tuple[Array, ...]
    started: tuple[Array, ...]
    rounds: int
    stopped: str
    effort: bool
    records: tuple[Recorded, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether no step is left that would lower the cost by what is worth it."""
        return not self.stopped


def default_free(plant: Plant, effort: bool) -> list[str]:
    """All base parameters where efforts give the scale, else those of effects alone: the links hold it."""
    of_links = {p.name for p in plant.model.standard} - set(_bounds(plant))
    standard = plant.model.standard
    return [
        base.name
        for base in plant.model.grouping.base
        if effort or not any(standard[i].name in of_links for i, _ in base.terms)
    ]


def refine(
    plant: Plant,
    records: Sequence[Prepared],
    *,
    free: Sequence[str] = (),
    window: float | None = None,
    interval: float = 1.0,
    progress: Callable[[int, float], None] | None = None,
) -> Refinement:
    """Base parameters of `plant` named in `free`, tuned from their values on the positions of `records`.

    free: default_free by default; the others are held. window: the simulation starts anew after so long
    [s], with initial states of their own, for arms that run away from their logs; by default a record is one
    part. interval: of multiple shooting [s]. Joints are weighted by their remaining errors; standard
    deviations are those given the held values, of noise of positions and efforts. Raises
    InputError for unknown names, states of effects, values that the motion does not tell apart, and a
    simulation that does not run.
    """
    effort = records[0].input is not None
    if any((r.input is None) == effort for r in records):
        raise InputError("found logs with effort and without, expected one kind")
    chosen = _chosen(plant, free, effort)
    every = [part for record in records for part in parts(record, window, interval)]
    model = Sensitive(plant, chosen)
    p, low, high = plant.parameters.copy(), *_limits(plant, chosen)
    guesses = [part.guess() for part in every]
    fit = Fit(model, every)
    names = [plant.model.grouping.base[k].name for k in chosen]
    rounds, stopped, singles = 0, "", [part.single() for part in every]
    started = _started(Fit(model, singles), p, _first(guesses), names)
    for stage in (every, singles):
        # Shooting at many points finds the way; the last steps are those of the motion as one.
        fit = Fit(model, stage)
        guesses = [Guess(g.states[: len(part.intervals)]) for g, part in zip(guesses, stage, strict=True)]
        done, stopped = False, f"the errors still fell at step {ROUNDS}, the last one"
        while rounds < ROUNDS and not done:
            rounds += 1
            now = fit.linear(p, guesses)
            weights = now.weights()
            cost, (step, alpha) = now.cost(weights), _step(now, weights, names, p[chosen], low, high)
            promised = 1.0 - step.promised / max(cost, 1e-300)
            end = "" if promised < UNKEPT else _unkept(rounds, promised)
            moved = _lowered(fit, p, guesses, step, alpha, chosen, weights, cost)
            done = moved is None
            if moved is not None:
                p, guesses, done = moved
            stopped = end if done else stopped
            if progress is not None:
                progress(rounds, cost)
    final = fit.linear(p, guesses)
    weights = final.weights()
    # of what is no best fit nothing says how far it is from that
    std = None if stopped else final.deviations(weights, fit.steps(p, guesses) if effort else [])
    per_unit = np.sqrt((np.concatenate(final.columns) ** 2).mean(axis=0))  # (n, f)
    shown = np.argmax(per_unit * weights[:, None], axis=0)
    runs = Fit(model, every).runs(p, guesses)
    base = plant.model.grouping.base
    found = []
    for k, b in enumerate(base):
        start, value = float(plant.parameters[k]), float(p[k])
        if k not in chosen:
            found.append(Refined(b.name, b.unit, start, value, None, held=True))
            continue
        i = chosen.index(k)
        j = int(shown[i])
        deviation = None if std is None else float(std[i])
        found.append(Refined(b.name, b.unit, start, value, deviation, float(per_unit[j, i]), j))
    return Refinement(
        Plant(plant.slip, p, p),
        tuple(found),
        scored(every, started),
        scored(every, runs),
        tuple(part.t for part in every),
        tuple(part.q for part in every),
        tuple(runs),
        tuple(started),
        rounds,
        stopped,
        effort,
    )


def _first(guesses: Sequence[Guess]) -> list[Guess]:
    """The initial states alone."""
    return [Guess(g.states[:1]) for g in guesses]


def _started(fit: Fit, p: Array, guesses: Sequence[Guess], names: Sequence[str]) -> list[Array]:
    """Positions (K, n) of every part at parameters p, from the initial states that bring them nearest to the
    measured ones; from those guessed where no motion near them runs.
    """
    held, found, done = np.zeros(len(names), dtype=bool), list(guesses), False
    try:
        for _ in range(ROUNDS):
            now = fit.linear(p, found)
            weights = now.weights()
            moved = _lowered(
                fit, p, found, now.step(weights, names, held), 1.0, [], weights, now.cost(weights)
            )
            if moved is None:
                break
            _, found, done = moved
            if done:
                break
    except InputError:
        found = list(guesses)
    return fit.runs(p, found)


def _lowered(
    fit: Fit,
    p: Array,
    guesses: Sequence[Guess],
    step: Step,
    alpha: float,
    chosen: Sequence[int],
    weights: Array,
    cost: float,
) -> tuple[Array, list[Guess], bool] | None:
    """Parameters and guesses after as much of a step as lowers the cost, and whether that was too little for
    another one; None where no part of it lowers the cost. alpha: how much of the step may be gone at most.
    """
    for _ in range(HALVINGS):
        tried = p.copy()
        tried[chosen] += alpha * step.parameters[: len(chosen)]
        moved = [g.moved(x, alpha) for g, x in zip(guesses, step.states, strict=True)]
        value = fit.cost(tried, moved, weights)
        if value < cost:
            return tried, moved, cost - value < LEAST_GAIN * cost
        alpha /= 2
    return None


def _unkept(number: int, promised: float) -> str:
    """Why a fit ends at a step that promised a share of the cost and brought nothing."""
    return (
        f"step {number} promises {100 * promised:.2g} % less of the squared errors, and no part of it, down "
        f"to 1/{2 ** (HALVINGS - 1)}, keeps that"
    )


def _step(
    now: Linear, weights: Array, names: Sequence[str], p: Array, low: Array, high: Array
) -> tuple[Step, float]:
    """The step from parameters p (f,), and how much of it stays inside their bounds.

    A parameter that a bound stops at once is held: the others would creep with it.
    """
    free = np.ones(len(p), dtype=bool)
    while True:
        step = now.step(weights, names, free)
        room = _room(p, step.parameters, low, high)
        stuck = free & (room < BLOCKED)
        if not stuck.any():
            return step, float(min(1.0, room.min(initial=1.0)))
        free &= ~stuck


def _bounds(plant: Plant) -> Mapping[str, tuple[float, float]]:
    """Bounds of the standard parameters of effects by name."""
    return {s.name: x.bounds for e in applied_effects(plant.arm) for x, s in e.parameters}


def _limits(plant: Plant, chosen: Sequence[int]) -> tuple[Array, Array]:
    """Bounds of the free base parameters that are one parameter of an effect."""
    standard, known = plant.model.standard, _bounds(plant)
    found = []
    for k in chosen:
        terms = plant.model.grouping.base[k].terms
        alone = known.get(standard[terms[0][0]].name) if len(terms) == 1 else None
        found.append(alone or (-np.inf, np.inf))
    low, high = np.array(found).T
    return low, high


def _room(p: Array, step: Array, low: Array, high: Array) -> Array:
    """How much of the step each parameter (f,) may go before its bound is near."""
    edge = np.where(step < 0, low, high) - p
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where((step != 0) & np.isfinite(edge), BOUNDARY * edge / step, np.inf)


def _chosen(plant: Plant, free: Sequence[str], effort: bool) -> list[int]:
    names = [b.name for b in plant.model.grouping.base]
    if plant.model.states or plant.slip.standard:
        raise InputError(
            f"{plant.arm.name}: an effect with states of its own is not refined; expected the arm without it"
        )
    for name in free:
        if name not in names:
            raise InputError(f"--free {name}: found no such base parameter, expected of {', '.join(names)}")
    wanted = list(free) or default_free(plant, effort)
    if not wanted:
        raise InputError(f"{plant.arm.name}: no parameter of an effect to tune; name others with --free")
    return [k for k, name in enumerate(names) if name in wanted]
