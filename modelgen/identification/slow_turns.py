"""Efforts that do not turn round as fast as the model's dry friction does: they are smoothed in the log, by a
filter forwards and backwards or a mean, or friction itself turns round smoothly.

No delay shows it, for smoothing acts alike on both sides in time. An effort as it was read has noise, and a
step where friction turns round; one that is smoothed has hardly any of either, and is explained better where
the model's efforts are smoothed likewise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d

from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model
from modelgen.identification.objects import DIAGNOSING, Doubt
from modelgen.identification.rows import motion_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

WIDTHS = (0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.5, 0.8, 1.2)  # periods of the cut-off, of what smooths
PROBE = 0.25  # of a width: what is smoothed by it has hardly anything that is faster
SMOOTHER = 0.1  # of the power that the model's dry friction has there, that the log's efforts have at most
SLOWED, STAYS = 1e-3, 0.5  # times the speed, at which so much of dry friction's columns stays
LEFT = 0.8  # of what is left, that a smoothing leaves at most
MOVED, PART = 2.0, 5e-3  # deviations by which it moves a parameter, and part of its value
SAID = "Parameters may be wrong by more than their deviations say."


def slow_turns(
    records: Sequence[Prepared], own: Regression, model: Model, evaluator: Evaluator
) -> list[Doubt]:
    """Questions about joints whose efforts are smoother than the model's where friction turns round.

    own: the regression of the records.
    """
    first, before = records[0], own.solve("wls")
    if not first.settings.cutoff or first.record.arm is None:
        return []
    rate = 1.0 / first.record.step
    widths = [w * rate / first.settings.cutoff for w in WIDTHS if w * rate / first.settings.cutoff >= 1.0]
    deviations = np.sqrt(np.maximum(np.diag(before.covariance), 0.0))
    columns = [_dry_friction(p, model, evaluator, before.theta) for p in records]
    dry = [c @ before.theta for c in columns]
    of_friction = np.any([np.abs(c).max(axis=(0, 1)) > 0.0 for c in columns], axis=0)
    said = []
    for j, name in enumerate(first.record.arm.coordinate_names):
        tried = [w for w in widths if _smoother(records, dry, j, PROBE * w)]
        if not tried:
            continue
        full = [np.asarray(evaluator.regressor(model, motion_of(p), before.theta))[:, j] for p in records]
        found = [(w, _smoothed(records, own, full, j, w).solve("wls")) for w in tried]
        width, after = min(found, key=lambda x: float(x[1].sigma[j]))
        known = of_friction & before.determined & after.determined & (deviations > 0.0)
        apart = np.abs(after.theta - before.theta)
        known &= apart > PART * np.abs(before.theta)
        moved = apart / np.where(known, deviations, np.inf)
        if after.sigma[j] > LEFT * before.sigma[j] or moved.max() < MOVED:
            continue
        most = int(np.argmax(moved))
        said.append(
            Doubt(
                f"The efforts of {name} change as slowly at its turns as means over "
                f"{float(f'{1e3 * np.sqrt(12.0) * width / rate:.2g}'):g} ms; so read, "
                f"{model.grouping.base[most].name} is {after.theta[most]:.3g}, not "
                f"{before.theta[most]:.3g}: are they smoothed before they "
                f"are logged, or does friction turn round smoothly{DIAGNOSING}? {SAID}",
                [name],
            )
        )
    return said


def _dry_friction(p: Prepared, model: Model, evaluator: Evaluator, theta: Array) -> Array:
    """Columns (N, n, p) of the model at full rate that stay when the joints creep: those of dry friction."""
    nothing = np.zeros_like(p.q)
    motions = (Motion(p.time, p.q, dq, nothing) for dq in (p.dq, SLOWED * p.dq, nothing))
    moving, creeping, still = (np.asarray(evaluator.regressor(model, m, theta)) for m in motions)
    stays = np.abs(creeping - still).max(axis=(0, 1)) > STAYS * np.abs(moving - still).max(axis=(0, 1))
    return np.asarray((creeping - still) * stays)


def _smoother(records: Sequence[Prepared], dry: Sequence[Array], j: int, width: float) -> bool:
    """Whether the log's efforts of a joint are smoother than its dry friction (N, n) where it turns, below a
    width [samples].
    """
    logged = made = 0.0
    for p, friction in zip(records, dry, strict=True):
        assert p.record.input is not None
        reach = int(12.0 * width) + 1  # as far as the smoothing that is tried has no end of the record in it
        near = np.zeros(len(p.time))
        near[1:] = np.sign(p.dq[1:, j]) != np.sign(p.dq[:-1, j])
        at = p.awake[:, j] & (np.convolve(near, np.ones(4 * int(width) + 5), "same") > 0.5)
        at[:reach] = at[-reach:] = False
        logged += float(_fast(p.record.input[:, j], width)[at].sum())
        made += float(_fast(friction[:, j], width)[at].sum())
    return made > 0.0 and logged < SMOOTHER * made


def _fast(values: Array, width: float) -> Array:
    """Squares (N,) of what values (N,) have that is faster than a width [samples]."""
    return np.asarray((values - gaussian_filter1d(values, max(width, 1.0))) ** 2)


def _smoothed(
    records: Sequence[Prepared], own: Regression, full: Sequence[Array], j: int, width: float
) -> Regression:
    """The regression with the columns of a joint smoothed; full: (N, p) of each record."""
    columns = []
    for p, made, old in zip(records, full, own.columns, strict=True):
        new = old.copy()
        new[:, j] = p.parallel(gaussian_filter1d(made, width, axis=0, mode="nearest") * p.weights[:, j, None])
        columns.append(new)
    return Regression(own.effort, columns, own.moving, own.white)
