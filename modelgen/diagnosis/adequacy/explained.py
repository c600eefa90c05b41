"""How much of what is not noise the causes of a joint explain together.

What still repeats from period to period is not noise. It counts at the frequencies at which the causes act: a
law that replaces another leaves a part of what that one does, at the same frequencies. Elsewhere it is
of another origin: a jolt of another joint between two samples repeats as well, and spreads over the band.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
from scipy import ndimage

from modelgen.dataset.processing.periods import folded
from modelgen.diagnosis.adequacy.free_form import shapes_at
from modelgen.diagnosis.adequacy.lack_of_fit import lack_of_fit
from modelgen.diagnosis.adequacy.smooth_functions import Worth, log_evidence, smooth_functions
from modelgen.diagnosis.candidates import FittedCandidate, with_causes
from modelgen.diagnosis.evidence import System, mean_squares
from modelgen.diagnosis.selection import Selection, explained_by_hidden_weight
from modelgen.diagnosis.validation import Check
from modelgen.numeric import Array
from modelgen.regression.weighted import rmse, weighted_fit

NEIGHBOURS = 3  # lines of a spectrum over which what a cause does is evened


def explained(
    selection: Selection, terms: Mapping[int, Worth], suspects: Sequence[FittedCandidate] = ()
) -> list[Check]:
    """Whether the causes at the joints of each cause explain most of what is not noise there.

    What errors of the positions repeat is no lack of the model, and what the further terms of a law that is
    the first ones of a series explain is its own, where they are the lesser part, as is the weight that a
    tilt turns and an upright arm hides. Passed as well where no
    more repeats than noise leaves by chance. Where nothing repeats, what the best function of no law explains
    beside the causes is not noise, nor is what suspects explain. Not asked of free motions that do not
    repeat. terms: by joint, see `further_terms`; suspects: that are not among the causes.
    """
    system, limits = selection.system, selection.system.equations.thresholds.adequacy
    equations, least = system.equations, limits.min_explained_share
    fit = lack_of_fit(system)
    if fit is None and equations.free:
        text = "a free motion that does not repeat cannot tell how much is left to explain"
        return [Check("explains", None, True, float("nan"), least, text) for _ in selection.causes]
    sizes, theta = mean_squares(system), weighted_fit(equations.rows, equations.columns)
    gained = (rmse(equations.rows, equations.columns, theta) ** 2 - sizes) / sizes
    if fit is None:
        at = {j for c in selection.causes for j in c.trial.candidate.joints(system.n)}
        left = np.maximum(left_smoothly(system, sorted(at)), _of_suspects(selection, suspects))
    else:
        left = left_alike(system, theta)
    theirs = _of_further_terms(selection, terms) + explained_by_hidden_weight(selection)
    rest = np.maximum(0.0, left - theirs) / sizes
    found = []
    for cause in selection.causes:
        joints = cause.trial.candidate.joints(system.n)
        more, less = float(gained[joints].sum()), float(rest[joints].sum())
        share = more / (more + less) if more + less > 0.0 else 0.0
        passed = share >= least or (fit is not None and fit.usual(joints, limits.usual_null_share))
        text = (
            f"the causes at its joints explain {100.0 * share:.0f} % of what is not noise there together; "
            f"{100.0 * least:.0f} % is asked"
        )
        if passed and share < least:
            text += ", or that no more repeats than noise leaves by chance, as here"
        found.append(Check("explains", passed, True, share, least, text))
    return found


def _of_suspects(selection: Selection, suspects: Sequence[FittedCandidate]) -> Array:
    """Mean squares (n,) that suspects explain beside the causes, zero where they explain nothing."""
    if not suspects:
        return np.zeros(selection.system.n)
    equations = selection.system.equations
    columns = with_causes(equations, [*(c.trial for c in selection.causes), *suspects])
    theta = weighted_fit(equations.rows, columns)
    return np.maximum(0.0, mean_squares(selection.system) - rmse(equations.rows, columns, theta) ** 2)


def left_smoothly(system: System, joints: Sequence[int]) -> Array:
    """Mean squares (n,) that a function of no law explains beside the causes, the best of each of these
    joints (from 0).

    Of where the arm is, or of what is set against causes there. Only of one that has more evidence than slow
    noise, whose colour is not known here, is worth to it.
    """
    equations, sizes, found = system.equations, mean_squares(system), np.zeros(system.n)
    least = equations.thresholds.adequacy.min_evidence_in_noise
    alone = (s for s in smooth_functions(system) if len(s.columns) == 1 and s.columns.keys() <= set(joints))
    for shape in chain(alone, *(shapes_at(j, equations) for j in joints)):
        (j,) = shape.columns
        worth = log_evidence(shape, system)
        if worth.evidence > least:
            found[j] = max(found[j], sizes[j] * worth.share)
    return found


def left_alike(system: System, theta: Array) -> Array:
    """Mean squares (n,) that the residuals of each joint repeat at the frequencies at which the causes act.

    theta: (p,) of the fit without the causes. Less noise, and less what errors of the positions repeat. What
    the causes do evenly over time says nothing of frequencies: to that share all count alike.
    """
    found = np.zeros(system.n)
    for j in range(system.n):
        spectra = [s for i in range(len(system.rows)) if (s := _spectra(system, theta, i, j)) is not None]
        if spectra:
            found[j] = max(0.0, _weighted(spectra))
    return found


@dataclass(frozen=True)
class _Spectra:
    """Power of a record by line of its period, one-sided, of mean squares: what the causes do (k,), what is
    left less noise (k,). rows: of the record that count.
    """

    done: Array
    left: Array
    rows: int


def _spectra(system: System, theta: Array, i: int, j: int) -> _Spectra | None:
    """Of record i and joint j; None where nothing repeats there."""
    rows, r = system.periods[i], system.rows[i]
    if rows is None:
        return None
    residual, moving = system.residuals[i][:, j], r.moving[:, j]
    bare = r.effort[:, j] - system.equations.columns[i][:, j] @ theta
    table = folded(np.where(moving, residual, np.nan), rows)
    there = np.isfinite(table)
    count = there.sum(axis=0)
    often = count >= 2
    if not often.any():
        return None

    def mean(values: Array) -> Array:
        sums = np.where(there, np.nan_to_num(folded(values, rows)), 0.0).sum(axis=0)
        return np.where(often, sums / np.maximum(count, 1), 0.0)

    level = mean(residual)
    apart = np.where(there & often, np.nan_to_num(table) - level, 0.0)
    times = float(count[often].mean())
    noise = _power(apart).sum(axis=0) / (times * (times - 1.0))
    alike = 0.0 if r.repeated is None else _power(mean(r.repeated[:, j]))
    return _Spectra(_power(mean(bare - residual)), _power(level) - noise - alike, int(moving.sum()))


def _weighted(spectra: Sequence[_Spectra]) -> float:
    """Power that is left, by line as the causes act there, of all records."""
    every = float(sum(s.rows for s in spectra))
    done = np.concatenate([s.done * s.rows for s in spectra]) / every
    left = np.concatenate([s.left * s.rows for s in spectra]) / every
    varying = [np.concatenate([[0.0], s.done[1:]]) for s in spectra]
    evened = np.concatenate([ndimage.uniform_filter1d(x, NEIGHBOURS, mode="nearest") for x in varying])
    moved, total = float(np.concatenate(varying) @ evened), float(done.sum())
    if not (moved > 0.0 and total > 0.0):
        return float(left.sum())
    steady = float(sum(s.done[0] * s.rows for s in spectra)) / every / total
    own = total / float(done @ evened) * evened
    return float(left @ ((1.0 - steady) * own + steady))


def _power(values: Array) -> Array:
    """Mean squares by line of the last axis, one-sided."""
    size = values.shape[-1]
    power = np.abs(np.fft.rfft(values) / size) ** 2
    power[..., 1 : (size + 1) // 2] *= 2.0
    return np.asarray(power)


def _of_further_terms(selection: Selection, terms: Mapping[int, Worth]) -> Array:
    """Mean squares (n,) that the further terms of laws explain beside all causes, where they are lesser."""
    system, sizes, found = selection.system, mean_squares(selection.system), np.zeros(selection.system.n)
    most = system.equations.thresholds.adequacy.max_further_terms_share
    for cause in selection.causes:
        c = cause.trial.candidate
        if c.joint is None or not c.definition.series:
            continue
        best = terms[c.joint]
        if 0.0 < best.evidence < most * cause.delta_bic:
            found[c.joint - 1] = sizes[c.joint - 1] * best.share
    return found
