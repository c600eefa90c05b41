"""How far the values of causes may be off: of weighted least squares in coloured noise.

The estimate is that of the plain equations, rows weighted by joint, whose errors have the noise's colour: its
covariance is R^-1 V R^-T, with the equations X = Q R and V the variance of such noise along Q (Newey and
West 1987). What is searched for has a column as well, the slope of what its cause adds (Gauss and Newton;
Bates and Watts 1988, 2.2): what is said of the others then counts that it is not known either.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, candidate_columns
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.elastic_fit import smooth
from modelgen.diagnosis.selection.hidden_weight import hidden_weights
from modelgen.diagnosis.selection.refit_by_load import load_slopes, loaded
from modelgen.numeric import Array

STEP = 0.01  # of a value, over which slopes are taken
LEAST = 1e-6  # of a parameter's own unit
OPEN = 1e-9  # of the largest singular value: below, the rows say nothing


@dataclass(frozen=True)
class LeastSquares:
    """The least squares estimate of r combinations of p unknowns from stacked equations (R, p). back: (p, r);
    along: (R, r), orthonormal; noise: (r, r), its variance along these.
    """

    back: Array
    along: Array
    noise: Array

    @property
    def covariance(self) -> Array:
        """Of the unknowns (p, p), by noise."""
        return np.asarray(self.back @ self.noise @ self.back.T)

    def moved(self, further: Array) -> Array:
        """By how much the unknowns are off (p, h), where columns (R, h) are left out of the equations."""
        return np.asarray(self.back @ (self.along.T @ further))


def covariance_of(system: System, slopes: Sequence[Array] = ()) -> Array:
    """Covariance (p + m, p + m) of the least squares estimate of a system's columns, and of what has these
    slopes (M, n, m) of each record.
    """
    return estimate_of(system, slopes).covariance


def estimate_of(
    system: System, slopes: Sequence[Array] = (), known: Sequence[int] = (), carried: Sequence[Array] = ()
) -> LeastSquares:
    """The least squares estimate of a system's columns (p), and of what has these slopes (M, n, m) of each
    record. known: columns whose factor is. carried: (M, n, k) of each record, what simulated columns change
    by the arm's own parameters.
    """
    plain = system.plain
    matrix = plain.matrix.copy()
    matrix[:, list(known)] = 0.0
    if carried:
        matrix[:, : carried[0].shape[2]] += plain.records(carried)
    if slopes:
        matrix = np.hstack([matrix, plain.records(slopes)])
    norms = np.linalg.norm(matrix, axis=0)
    empty = norms == 0
    norms[empty] = 1.0
    u, s, vt = np.linalg.svd(matrix / norms, full_matrices=False)
    kept = s > OPEN * s.max(initial=0.0)
    along = u[:, kept]
    noise = np.eye(int(kept.sum())) / plain.share if plain.colour is None else plain.colour.variance(along)
    back = (vt[kept].T / s[kept]) / norms[:, None]
    back[empty] = 0.0
    return LeastSquares(back, along, noise)


@dataclass(frozen=True)
class Spread:
    """How far values found together may be off. causes: standard deviations of each cause's parameters by
    name; nan of what was fixed, and of what the records cannot show. arm: covariance of the unknowns of the
    equations (k, k).
    """

    causes: Sequence[Mapping[str, float]]
    arm: Array


def deviations(selection: Selection, equations: Equations) -> Spread:
    """Deviations of the causes' parameters and of the arm's, of one fit.

    equations: whose arm further columns are made for.
    """
    system, rows = selection.system, selection.system.rows
    if not selection.causes:
        return Spread((), covariance_of(system))
    of_arm = equations.with_rows(rows)
    slopes = [_slopes(c, of_arm, system.base) for c in selection.causes]
    zero = [_at_zero(c, of_arm, system) for c in selection.causes]
    further = [table for pair in zip(slopes, (tables for _, tables in zero), strict=True) for table in pair]
    together = [np.concatenate([s[k] for s in further], axis=2) for k in range(len(rows))]
    places = selection.columns
    compliant = [c.trial.candidate.elastic for c in selection.causes]
    held = [own.start for own, simulated in zip(places, compliant, strict=True) if simulated]
    carried = _carried(selection, of_arm)
    fit = estimate_of(system, together if together[0].shape[2] else (), held, carried)
    whole, hidden = fit.covariance, hidden_weights(selection.causes, system, system.plain)
    if hidden is not None:
        moved = fit.moved(hidden.whole)
        whole = whole + moved @ hidden.uncertain @ moved.T
    searched, found = len(system.theta), []
    for cause, own, slope, (columns, tables) in zip(selection.causes, places, slopes, zero, strict=True):
        last = searched + slope[0].shape[2]
        at = np.r_[own, searched:last]
        at[columns] = np.arange(last, last + tables[0].shape[2])
        found.append(_physical(cause.trial, whole[np.ix_(at, at)], own.stop - own.start))
        searched = last + tables[0].shape[2]
    return Spread(found, whole[: equations.unknowns, : equations.unknowns])


def _at_zero(cause: Cause, equations: Equations, system: System) -> tuple[list[int], list[Array]]:
    """Numbers (h) of the cause's columns that its bounds hold at zero, and what they would be, (M, n, h) of
    every record: nobody knows that a value is zero because less is not possible.

    Not of those that the records cannot show beside all others.
    """
    trial = cause.trial
    held, made, shown = _held(cause, equations, system)
    open_ = [k for k, there in zip(held, shown, strict=True) if there]
    if not open_:
        return [], [np.zeros((*t.shape[:2], 0)) for t in trial.columns]
    return open_, [t[:, :, open_] for t in made]


def unseparated(selection: Selection, equations: Equations) -> list[list[str]]:
    """Names of the parameters of each cause that the records cannot show beside all others: what they would
    add is in the arm's own parameters. equations: as of `deviations`.
    """
    system = selection.system
    of_arm = equations.with_rows(system.rows)
    found = []
    for cause in selection.causes:
        held, made, shown = _held(cause, of_arm, system)
        there = [any(t[:, :, k].any() for t in made) for k in held]
        columns = [k for k, so, alone in zip(held, there, shown, strict=True) if so and not alone]
        found.append([cause.trial.candidate.names[k] for k in columns])
    return found


def _held(
    cause: Cause, equations: Equations, system: System
) -> tuple[list[int], Sequence[Array], Sequence[bool]]:
    """Numbers (h) of the cause's columns that are zero, all its columns (M, n, k) of every record as they
    would be, and whether the records show those (h) beside all others.
    """
    trial = cause.trial
    c, tables = trial.candidate, trial.columns
    held = [] if c.elastic else np.flatnonzero(~np.any([t.any(axis=(0, 1)) for t in tables], axis=0)).tolist()
    made = candidate_columns(c, {**trial.values, **trial.around}, equations, system.base) if held else None
    if made is None:
        return [], [], []
    stacked = system.plain.stacked([t[:, :, held] for t in made])
    norms = np.linalg.norm(stacked, axis=0)
    return held, made, system.plain.shown(stacked / np.where(norms > 0.0, norms, 1.0)).tolist()


def _carried(selection: Selection, equations: Equations) -> list[Array]:
    """What elastic joints and friction by the load add changes so by the arm's own parameters, (M, n, k) of
    each record.
    """
    trials = [c.trial for c in selection.causes]
    elastic = [t for t in trials if smooth(t, equations)]
    by_load = [t for t in trials if loaded(t, equations)]
    if not elastic and not by_load:
        return []
    theta = selection.system.theta[: equations.unknowns]
    found = load_slopes(by_load, [t.gain.values for t in by_load], theta, equations)
    for trial in elastic:
        here = candidate_columns(
            trial.candidate, trial.values, equations, equations.base(theta), ringing=True
        )
        for i, value in enumerate(theta):
            step = max(STEP * abs(float(value)), LEAST)
            moved = equations.base(theta + step * (np.arange(len(theta)) == i))
            there = candidate_columns(trial.candidate, trial.values, equations, moved, ringing=True)
            if here is not None and there is not None:
                for table, a, b in zip(found, here, there, strict=True):
                    table[:, :, i] += (b - a)[:, :, 0] / step
    return found


def _slopes(cause: Cause, equations: Equations, base: Array) -> list[Array]:
    """Slopes (M, n, m) of the cause's columns by each value that was searched for, of every record."""
    trial = cause.trial
    theta = np.ones(1) if trial.candidate.elastic else trial.gain.values
    parts: list[list[Array]] = [[] for _ in equations.rows]
    for name, value in trial.values.items():
        step = STEP * (abs(value) or 1.0)
        ends = [
            candidate_columns(
                trial.candidate, {**trial.values, **trial.around, name: x}, equations, base, ringing=True
            )
            for x in (value - step, value + step)
        ]
        for k, part in enumerate(parts):
            if ends[0] is None or ends[1] is None:
                part.append(np.zeros(trial.columns[k].shape[:2]))
            else:
                part.append((ends[1][k] - ends[0][k]) @ theta / (2 * step))
    return [
        np.stack(part, axis=2) if part else np.zeros((*c.shape[:2], 0))
        for part, c in zip(parts, trial.columns, strict=True)
    ]


def _physical(trial: FittedCandidate, covariance: Array, linear: int) -> dict[str, float]:
    """Deviations of the effect's own parameters, by how they follow from what was estimated and searched."""
    names, now = list(trial.values), trial.parameters
    moved: list[dict[str, float]] = []
    sizes: Array = np.sqrt(np.maximum(0.0, np.diag(covariance)))
    for k in range(linear):
        values = trial.gain.values.copy()
        values[k] += sizes[k]
        moved.append(replace(trial, gain=replace(trial.gain, values=values)).parameters)
    for name, size in zip(names, sizes[linear:], strict=True):
        moved.append(replace(trial, values={**trial.values, name: trial.values[name] + size}).parameters)
    safe = np.where(sizes > 0, sizes, 1.0)
    found = {}
    for name, value in now.items():
        slope = np.array([other.get(name, value) - value for other in moved]) / safe
        std = math.sqrt(max(0.0, float(slope @ covariance @ slope)))
        found[name] = np.nan if std == 0.0 else std
    return found
