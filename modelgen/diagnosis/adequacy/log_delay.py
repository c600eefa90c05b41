"""A delay that a log has by when it reads its channels is no cause, and says when the efforts were read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset.processing.instants import CONVENTIONS, EffortInstant, fitting
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import mean_squares
from modelgen.diagnosis.selection import Cause, Selection, deviations, effort_rates, refit_elastic

ROUNDS, NARROWER = 2, 5.0  # of parabolas, and how much narrower the next one is


def out_of_step(cause: Cause, equations: Equations) -> str:
    """Why a delay is none of the arm: a log may read its channels in turn, or efforts and positions apart.

    A delay that all joints share is the log's where a log may have it that nobody has said anything of. A
    single joint has nothing to share it with where the mapping says when the efforts were read.
    """
    c = cause.trial.candidate
    delay = cause.trial.delay
    if delay is None:
        return ""
    after = _of_the_log(cause, equations)
    if after is not None:
        return (
            f"with {delay:.2g} s the efforts of all joints lie {after:.2f} samples after the positions' "
            "stamps, which a log may have by when it reads them: `hold` of the mapping says when"
        )
    interval = max(r.prepared.record.step for r in equations.rows)
    if c.joint is None or equations.n == 1 or abs(delay) >= interval:
        return ""
    return (
        f"{delay:.2g} s at one joint is less than a sample of {interval:.2g} s, in which a log "
        "may read one channel after the other; log faster to tell"
    )


def _of_the_log(cause: Cause, equations: Equations) -> float | None:
    """Samples after the positions' stamps at which the efforts were read, None for a delay of the arm."""
    c, record = cause.trial.candidate, equations.rows[0].prepared.record
    delay = cause.trial.delay
    alone = equations.n == 1
    if delay is None or not (c.joint is None or alone) or (alone and record.hold_known == "mapping"):
        return None
    after = (record.hold + delay) / record.step
    limits = equations.thresholds.dataset
    return None if fitting(after, 0.0, record.step, limits) is None else after


def instant_shown(
    suspects: Sequence[Cause], selection: Selection, equations: Equations
) -> EffortInstant | None:
    """When the efforts were read, as a delay of all joints among the suspects says it; None where none does,
    or where the mapping says when.

    selection: with the suspects, which gives the deviation of the delay. It is found beside all other causes,
    in the band of the diagnosis, and so says more than what `identify` finds in a narrower one.
    """
    record = equations.rows[0].prepared.record
    if record.hold_known == "mapping":
        return None
    for cause in suspects:
        after = _of_the_log(cause, equations)
        if after is None:
            continue
        place = [c.trial.candidate for c in selection.causes].index(cause.trial.candidate)
        std = float(np.nanmax([*deviations(selection, equations).causes[place].values()])) / record.step
        fits = fitting(after, std, record.step, equations.thresholds.dataset)
        if fits is not None and fits != record.effort_hold:
            return EffortInstant(fits, "data", record.step, after, std, fits)
    return None


def instant_beside_elastic(selection: Selection, equations: Equations) -> EffortInstant | None:
    """When the efforts were read, as elastic joints among the causes have it; None where none is behind
    a motor, where it is known, and where the instant that is used is as likely.

    Half a sample does much what damping does, so that a rigid model cannot tell. With the joints' values
    found anew for every convention, what is left is a parabola over the instant.
    """
    record, limits = equations.rows[0].prepared.record, equations.thresholds
    elastic = [c for c in selection.causes if c.trial.candidate.elastic]
    late = any(c.trial.delay is not None for c in selection.causes)
    if not elastic or late or not record.hold_std or record.effort_hold not in CONVENTIONS:
        return None
    used = CONVENTIONS[str(record.effort_hold)]
    rates = effort_rates(selection, equations)
    counts, own = selection.system.plain.counts, mean_squares(selection.system)

    def left(after: float) -> float:
        rows = [
            replace(r, effort=r.effort + (used - after) * r.prepared.record.step * rate)
            for r, rate in zip(equations.rows, rates, strict=True)
        ]
        found = mean_squares(refit_elastic(selection, equations.with_rows(rows)).system)
        return float(counts @ (found / np.maximum(own, 1e-300)))

    best, reach = 0.0, max(CONVENTIONS.values())
    for _ in range(ROUNDS):
        places = best + reach * np.array([-1.0, 0.0, 1.0])
        bend, slope, level = np.polyfit(places, [left(x) for x in places], 2)
        if bend <= 0.0:
            return None
        best = float(np.clip(-0.5 * slope / bend, places[0] - reach, places[2] + reach))
        reach /= NARROWER
    least, total = level + 0.5 * slope * best, float(counts.sum())
    if least <= 0.0 or total * np.log(total / least) < limits.adequacy.max_behind_refused:
        return None
    std = float(np.sqrt(least / total / bend))
    fits = fitting(best, std, record.step, limits.dataset)
    if fits in (None, record.effort_hold):
        return None
    return EffortInstant(fits, "data", record.step, best, std, fits)
