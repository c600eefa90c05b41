"""Causes that may stand for something else: they pass the gates, and most of what repeats is left.

An effect outside the catalogue has a share in common with those inside, and the most similar of them gains
something. The right cause leaves noise; where the lack of fit is found still, a cause should at least have
explained two thirds of what repeats from period to period at the joints that it acts on, and most of it in
the part of the period that shows most; and what is left elsewhere should be less than what it explains.
Play, whose impacts are simulated roughly, is exempt where its evidence is beyond that of a resemblance.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.diagnosis.causes import Cause
from modelgen.diagnosis.lack_of_fit import Test, in_parts, lack_of_fit, repeating
from modelgen.diagnosis.rows import Rows
from modelgen.diagnosis.selection import Selection
from modelgen.diagnosis.system import System, mean_squares
from modelgen.numeric import Array

LEAST = 2 / 3  # of what repeats, explained
MOST = 1 / 2  # of what repeats in the part of the period that shows most, left
PLAIN = 250.0  # delta BIC; play gave 500 to 2800
ROUGH = "backlash"
PLAINLY = 1.5  # times the threshold in a part, where a cause falls by what is left elsewhere
MUCH = 0.1  # of the residuals' power that repeats: below, the joint is explained


def doubtful(selection: Selection, rows: Sequence[Rows]) -> list[Cause]:
    """The causes that leave most of what repeats."""
    system = selection.system
    if not selection.causes:
        return []
    old = System(rows, [r.columns for r in rows], system.periods)
    fit = lack_of_fit(old)
    if fit is None or not fit.found:
        return []
    sizes = mean_squares(old)
    first, last = repeating(old) / sizes, repeating(system) / sizes
    much = repeating(system) > MUCH * mean_squares(system)
    parts = in_parts(system)
    worst, left = (_worst(tests, system.n) / sizes for tests in (in_parts(old), parts))
    found = any(t.found for t in parts)
    clearly = any(t.statistic > PLAINLY * t.threshold for t in parts)
    doubted = []
    for cause in selection.causes:
        if cause.trial.candidate.effect == ROUGH and cause.delta_bic > PLAIN:
            continue
        joints = cause.trial.candidate.joints(system.n)
        little = much[joints].any() and last[joints].sum() > (1 - LEAST) * first[joints].sum()
        shown = worst[joints].max()
        missed = (found and left[joints].max() > MOST * shown) or (clearly and left.max() > shown)
        if little or missed:
            doubted.append(cause)
    return doubted


def _worst(tests: Sequence[Test], n: int) -> Array:
    """What repeats in the part of the period that shows most, by joint (n,) [effort^2]."""
    found = np.zeros(n)
    for t in tests:
        found[t.joint] = max(found[t.joint], t.excess)
    return found
