"""A delay that a log has by when it reads its channels is no cause, and says when the efforts were read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset.processing.instants import EffortInstant, fitting
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.selection import Cause, Selection, deviations


def out_of_step(cause: Cause, equations: Equations) -> str:
    """Why a delay is none of the arm: a log may read its channels in turn, or efforts and positions apart.

    A delay that all joints share is the log's where a log may have it that nobody has said anything of. A
    single joint has nothing to share it with where the mapping says when the efforts were read.
    """
    c = cause.trial.candidate
    delay = c.definition.delays(cause.trial.parameters)
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
    delay = c.definition.delays(cause.trial.parameters)
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
