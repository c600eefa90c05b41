"""Efforts that are counted the other way: refused where the other sign was tried, and explains them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.doubts import of_other_sign
from modelgen.identification.identify import estimates_of
from modelgen.identification.impossible import driving
from modelgen.identification.validation import beginning, regression_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution

ALIKE = 1.1  # times what is left as the log stands, that the other sign may leave to explain as much
BETTER = 0.33  # the same of efforts whose friction, inertia and weight do not ask for the other sign
DEPENDENT = 1e-10  # eigenvalue of the normal matrix at unit length, below which columns depend on others


@dataclass(frozen=True)
class _Tried:
    """left: what a fit leaves of the efforts, as a part of them. driving: coordinates (from 0) whose friction
    is below zero. other: those whose inertia is, or whose weight has the other sign.
    """

    regression: Regression
    left: float
    driving: frozenset[int]
    other: frozenset[int]


def check_signs(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    added: Sequence[Array] | None = None,
    *,
    whole: bool = True,
) -> None:
    """Refuse efforts of joints with whose other sign the model explains far more, or as much where friction
    comes out below zero and inertia or weight with the other sign; all of these must be possible then.

    Where that is not so the model lacks something instead. added: as for `regression_of`. whole: whether all
    rows are looked at, or as many as show the signs. Raises InputError with the question.
    """
    if any(p.input is None or p.record.arm is None for p in train):
        return
    try:
        records = train if whole else [beginning(p, model) for p in train]
        own = _tried(records, model, evaluator, added, frozenset())
        sets = [own.driving & own.other, own.driving, *(frozenset({j}) for j in sorted(own.driving))]
        sets += _best_signs(own.regression)
        tried = [(some, _tried(records, model, evaluator, added, some)) for some in {*sets} if some]
    except (np.linalg.LinAlgError, FloatingPointError):
        return  # what is wrong is said where the parameters are found
    right = [(x.left, sorted(some)) for some, x in tried if _explains(x, own, some)]
    if not right:
        return
    left, some = min(right)
    joints, name = ", ".join(model.arm.coordinate_names[j] for j in some), train[0].record.name
    expected = (
        "expected efforts that act in the direction of the positions: is their sign the other way round, or "
        "that of torque_constant?"
    )
    if own.driving & own.other >= set(some):
        raise InputError(
            f"{name}: friction at {joints} comes out below zero, and inertia or weight with the other sign; "
            f"{expected}"
        )
    raise InputError(
        f"{name}: with the other sign of the efforts of {joints} {100 * left:.2g} % of the efforts are left "
        f"unexplained, as the log stands {100 * own.left:.2g} %; {expected}"
    )


def _best_signs(regression: Regression) -> list[frozenset[int]]:
    """Joints (from 0) whose efforts, turned one after the other, leave the least of them, and all others: by
    what is left the two are alike. None where that is not far less.

    By the normal matrices of the joints' rows, which the signs do not change.
    """
    n = regression.effort[0].shape[1]
    efforts, moving = np.concatenate(regression.effort), np.concatenate(regression.moving)
    size = np.sqrt((efforts**2 * moving).sum(axis=0))
    share = np.where(size > 0.0, 1.0 / np.maximum(size, 1e-300), 0.0)
    table, right = np.concatenate(regression.columns), efforts * share * moving
    parts = [table[:, j] * (share[j] * moving[:, j])[:, None] for j in range(n)]
    normal = sum((x.T @ x for x in parts), np.zeros((table.shape[2],) * 2))
    scale = np.sqrt(np.diag(normal))
    scale = np.where(scale > 0.0, 1.0 / np.maximum(scale, 1e-300), 0.0)
    inverse = np.linalg.pinv(normal * np.outer(scale, scale), rcond=DEPENDENT, hermitian=True)
    products = np.stack([(x.T @ right[:, j]) * scale for j, x in enumerate(parts)], axis=1)

    def left(signs: Array) -> float:
        made = products @ signs
        return float(np.sum(share > 0.0) - made @ inverse @ made)

    signs = np.ones(n)
    first = least = left(signs)
    for _ in range(n):
        trials = [left(np.where(np.arange(n) == j, -signs, signs)) for j in range(n)]
        best = int(np.argmin(trials))
        if trials[best] >= least:
            break
        signs[best], least = -signs[best], trials[best]
    if least >= BETTER**2 * first:
        return []
    return [frozenset(np.flatnonzero(some * signs < 0.0).tolist()) for some in (1.0, -1.0)]


def _explains(turned: _Tried, own: _Tried, some: frozenset[int]) -> bool:
    """Whether the other sign of some joints' efforts is that of the arm."""
    if some & (turned.driving | turned.other):
        return False
    return turned.left <= (ALIKE if some <= own.driving & own.other else BETTER) * own.left


def _tried(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    added: Sequence[Array] | None,
    some: frozenset[int],
) -> _Tried:
    """The fit with the efforts of some joints turned. Raises InputError."""
    signs = np.where(np.isin(np.arange(train[0].n), sorted(some)), -1.0, 1.0)
    records = [replace(p, input=None if p.input is None else p.input * signs) for p in train]
    theta: Array = np.zeros(len(model.grouping.base))
    theta = regression_of(evaluator, model, records, theta, added).least_squares()
    regression = regression_of(evaluator, model, records, theta, added)
    found: Solution = regression.solve("wls")
    spread = np.sqrt(np.maximum(np.diag(found.covariance), 0.0))
    estimates = estimates_of(model, found.theta, np.where(found.determined, spread, np.nan))
    below = frozenset(e.joint - 1 for e in driving(estimates))
    # A turned inertia must be possible however small its part of the efforts is.
    part = 0.0 if some else None
    fit = found.theta, found.covariance, found.determined
    other = frozenset(of_other_sign(records, model, evaluator, *fit, part=part))
    return _Tried(regression, _left(regression.effort, regression.moving, found.sigma), below, other)


def _left(effort: Sequence[Array], moving: Sequence[NDArray[np.bool_]], sigma: Array) -> float:
    """What residuals of sizes sigma (n,) are of the efforts (M, n), over the rows that move (M, n)."""
    both, there = np.concatenate(effort), np.concatenate(moving)
    size = np.sqrt((both**2 * there).sum(axis=0) / np.maximum(there.sum(axis=0), 1))
    used = there.any(axis=0)
    return float(np.sqrt(np.mean((sigma[used] / np.maximum(size[used], 1e-300)) ** 2)))
