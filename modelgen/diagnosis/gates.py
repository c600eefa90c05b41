"""The gates that a cause with evidence must pass: it helps and matters on rows that its fit has not seen.

The cause is fitted on one part of the records and carried to the other, then the other way round; the
squares of all parts count together. A part is a record, or every other one of many: a short record alone
cannot hold the rest of the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.candidates import COMPLIANT, LATER
from modelgen.diagnosis.instruments import Pairs
from modelgen.diagnosis.positions import feigned, repeating_errors
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import System, rmse, weighted_fit
from modelgen.diagnosis.trials import Trial

PRACTICAL = 1.5  # percent of the RMSE on rows that the fit has not seen
DELAYED = 3.0  # the same for a delay: sticking at reversals leaves a share of a sample; and beside one
WORSE = 0.01  # of the squares of all joints: by less, a cause that must help may make others worse
DELAY = "time_delay"
FEW = 4  # records that are tried one by one
SIGNIFICANT = 6.0  # standard deviations of an estimate by instruments
# What errors of the positions look like most: these must gain all of it where the rest is fitted anew.
FEIGNABLE = (*COMPLIANT, DELAY, LATER)
REVERSING = ("presliding", "stribeck_friction")  # show where a delay shows most
PASSING = "friction_warm_up"  # passes while the excitation and errors that correlate with it repeat

Part = tuple[list[Rows], list[int]]  # rows, and which records they are of


@dataclass(frozen=True)
class Judgement:
    """gain: percent of the RMSE measured on rows that the fit has not seen; expected: what the value found in
    all records must gain there; refused: the gate that stays shut, empty where none does.
    """

    gain: float
    expected: float
    refused: str


def with_causes(rows: Sequence[Rows], trials: Sequence[Trial]) -> list[Array]:
    """Baseline and the causes' columns side by side, by record."""
    return [np.concatenate([r.columns, *(t.columns[i] for t in trials)], axis=2) for i, r in enumerate(rows)]


def judged(
    trial: Trial,
    rows: Sequence[Rows],
    before: Sequence[Trial],
    blur: Array | None = None,
    system: System | None = None,
    narrowed: float = 1.0,
) -> Judgement:
    """Whether the cause helps and matters at a joint that it is judged by.

    Gains are measured of the whole prediction, and where the rest of the model is fitted anew to the unseen
    rows with and without the cause, which takes up much of what is slow. One must not be a loss. That the
    cause matters is asked of the gain to be expected: what a model without it gets wrong on unseen rows if
    the cause is there as found, against the noise. That has the scatter of one value, where a measured gain
    has that of all parameters of a part. What errors of the positions could feign (`blur`) must be exceeded
    by the gain where the rest is fitted anew, unless the estimate by instruments is not zero. By that gain
    must pass what such errors look like most; everything where no period repeats, since slow noise, of a size
    that nobody knows, looks like a slow cause; and causes after the first, to which its form may leave some.
    narrowed: the usual band over that of the rows.
    """
    n = rows[0].effort.shape[1]
    old, new = with_causes(rows, before), with_causes(rows, [*before, trial])
    own = old[0].shape[2]
    # what shows between records, or in some of them alone: halves of all are tried instead
    later = trial.candidate.effect == LATER or any(not c.any() for c in trial.columns)
    again = _refitted(rows, old, new, halves=later)
    whole = np.array([_left(rows, x, halves=later) for x in (old, new)])
    theta = weighted_fit(rows, new)
    shows = [replace(r, effort=c[:, :, own:] @ theta[own:]) for r, c in zip(rows, new, strict=True)]
    counts = _moving(rows)
    places = [j for j in trial.candidate.joints(n) if counts[j] > 0]
    bias = _left(shows, old, halves=later) / np.maximum(counts, 1.0)
    noise = rmse(rows, new, theta) ** 2
    expected = 100.0 * (1.0 - np.sqrt(noise / (noise + bias)))[places]
    least = practical(_least(trial, before), narrowed)
    strict = bool(before) or trial.candidate.effect in FEIGNABLE
    return _ruled(trial, least, strict, again, whole, expected, places, counts, blur, system)


def _least(trial: Trial, before: Sequence[Trial]) -> float:
    """Percent of the RMSE that the cause must gain."""
    c = trial.candidate
    delayed = [t.candidate.joint for t in before if t.candidate.effect == DELAY]
    beside = c.effect in REVERSING and (c.joint in delayed or None in delayed)
    return DELAYED if c.effect == DELAY or beside else PRACTICAL


def practical(percent: float, narrowed: float) -> float:
    """Percent of the RMSE in a narrowed band that is `percent` in the usual one.

    A band `narrowed` times as wide has that many times the power of white noise, and the cause as much as
    before: what is worth naming does not become less for being seen better.
    """
    odds = narrowed * ((1.0 - percent / 100.0) ** -2 - 1.0)  # power of the cause over that of the noise
    return 100.0 * (1.0 - float((1.0 + odds) ** -0.5))


def _moving(rows: Sequence[Rows]) -> Array:
    """Rows that count, by joint (n,)."""
    return np.asarray(np.sum([r.moving.sum(axis=0) for r in rows], axis=0))


def _left(rows: Sequence[Rows], columns: Sequence[Array], *, halves: bool) -> Array:
    """Sums of squares (n,) that predictions leave of the parts that were not fitted."""
    found = np.zeros(rows[0].effort.shape[1])
    for (fitted, at), (tried, to) in _folds(rows, halves=halves):
        theta = weighted_fit(fitted, [columns[i] for i in at])
        found += _moving(tried) * rmse(tried, [columns[i] for i in to], theta) ** 2
    return found


def _refitted(rows: Sequence[Rows], old: Sequence[Array], new: Sequence[Array], *, halves: bool) -> Array:
    """The same (2, n), without and with the cause carried over, the rest fitted to what it is tried on."""
    own = old[0].shape[2]
    found = np.zeros((2, rows[0].effort.shape[1]))
    for (fitted, at), (tried, to) in _folds(rows, halves=halves):
        theta = weighted_fit(fitted, [new[i] for i in at])[own:]
        carried = [
            replace(r, effort=r.effort - new[i][:, :, own:] @ theta) for r, i in zip(tried, to, strict=True)
        ]
        table = [old[i] for i in to]
        for k, part in enumerate((tried, carried)):
            found[k] += _moving(tried) * rmse(part, table, weighted_fit(part, table)) ** 2
    return found


def _ruled(
    trial: Trial,
    limit: float,
    strict: bool,
    again: Array,
    whole: Array,
    expected: Array,
    places: list[int],
    counts: Array,
    blur: Array | None,
    system: System | None,
) -> Judgement:
    refitted = _gains(again)[places]
    hoped = float(expected.max(initial=0.0))
    least = np.full(len(places), limit)
    could = np.zeros(len(places))
    if blur is not None and system is not None and not instrumented(trial, system):
        could = feigned(blur[places], again[0, places] / counts[places])
    if strict or system is None or not system.noise_known or (could > least).any():
        best = float(refitted[refitted >= np.maximum(least, could)].max(initial=-np.inf))
        most = float(refitted.max(initial=-np.inf))
        if not np.isfinite(best):
            return Judgement(most, hoped, "gain" if (refitted < least).all() else "positions")
        return Judgement(best, hoped, "" if _total(again, counts) < 1.0 else "other joints")
    gains = np.maximum(refitted, _gains(whole)[places])
    measured = float(gains[expected >= limit].max(initial=-np.inf))
    if measured < 0.0:
        return Judgement(float(gains.max(initial=-np.inf)), hoped, "gain")
    worse = min(_total(s, counts) for s in (again, whole)) > 1.0 + WORSE
    return Judgement(measured, hoped, "other joints" if worse else "")


def _gains(sums: Array) -> Array:
    """Percent of the RMSE by joint, from sums of squares without and with (2, n)."""
    return np.asarray(100.0 * (1.0 - np.sqrt(sums[1] / np.maximum(sums[0], 1e-300))))


def _total(sums: Array, counts: Array) -> float:
    """Mean over the joints of the squares with the cause over those without."""
    return float((sums[1] / np.maximum(sums[0], 1e-300))[counts > 0].mean())


def _folds(rows: Sequence[Rows], *, halves: bool) -> list[tuple[Part, Part]]:
    """Rows to fit, and rows to try that fit on."""
    every = list(range(len(rows)))
    if halves:
        first, second = ((part, every) for part in _masked(rows))
        return [(first, second), (second, first)]
    parts = [[i] for i in every] if len(rows) <= FEW else [every[k::2] for k in range(2)]
    folds = []
    for part in parts:
        others = [i for i in every if i not in part]
        folds.append((([rows[i] for i in others], others), ([rows[i] for i in part], part)))
    return folds


def instrumented(trial: Trial, system: System) -> bool:
    """Whether the cause shows where errors of the positions are kept out: its estimate by instruments is not
    zero, or it does not repeat as they do.
    """
    if trial.candidate.effect == PASSING:
        return True
    if trial.candidate.effect == LATER:  # does not repeat
        return False
    if trial.candidate.effect in COMPLIANT:  # searched for over what makes a filter of any errors
        return False
    table = [np.concatenate([c, t], axis=2) for c, t in zip(system.columns, trial.columns, strict=True)]
    pairs = Pairs(system.rows, table, system.periods, system.plain.sizes)
    if not pairs.enough or repeating_errors(system.rows, system.periods).any():
        return False
    values = pairs.t_values(system.plain.share)[system.columns[0].shape[2] :]
    return bool(np.abs(values).max(initial=0.0) > SIGNIFICANT)


def _masked(rows: Sequence[Rows]) -> tuple[list[Rows], list[Rows]]:
    """All records with the first half of each alone, and with the second."""
    first, second = [], []
    for r in rows:
        flags = np.zeros(len(r.effort), dtype=bool)
        flags[: len(flags) // 2] = True
        first.append(replace(r, moving=r.moving & flags[:, None]))
        second.append(replace(r, moving=r.moving & ~flags[:, None]))
    return first, second
