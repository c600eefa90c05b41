"""What each of the causes takes away on the test record, against a model that is fitted without it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.diagnosis.errors import compared
from modelgen.diagnosis.forms import with_causes
from modelgen.diagnosis.objects import Share
from modelgen.diagnosis.outcome import columns_of
from modelgen.diagnosis.rows import Rows
from modelgen.diagnosis.selection import Selection
from modelgen.diagnosis.system import rmse, weighted_fit
from modelgen.numeric import Array
from modelgen.probing import Prober


def shares(selection: Selection, test: Rows, prober: Prober, base: Array) -> list[Share]:
    """Of every cause, over the joints where it acts, each in units of what all causes leave there.

    The model is fitted to the training records, with all causes and with all but this one; values that were
    searched for stay. Not a number where one of them cannot stand on that record. base: of `prober`'s arm.
    """
    rows, trials = selection.system.rows, [cause.trial for cause in selection.causes]
    made = [columns_of(trial, test, prober, base) for trial in trials]
    there = [table for table in made if table is not None and np.isfinite(table).all()]
    if len(there) < len(trials):
        return [Share()] * len(trials)

    def left(kept: Sequence[int]) -> tuple[Array, Array]:
        """Residuals (M, n) of the model with these causes, and their RMSE by joint (n,)."""
        theta = weighted_fit(rows, with_causes(rows, [trials[k] for k in kept]))
        table = np.concatenate([test.columns, *(there[k] for k in kept)], axis=2)
        return test.effort - table @ theta, rmse([test], [table], theta)

    every, found = range(len(trials)), []
    with_all, sizes = left(every)
    sizes = np.maximum(sizes, 1e-300)
    for k in every:
        without, _ = left([i for i in every if i != k])
        places = trials[k].candidate.joints(len(sizes))
        before, after = (
            np.concatenate([e[test.moving[:, j], j] / sizes[j] for j in places]) for e in (without, with_all)
        )
        found.append(Share(*compared(before, after)[2:]))
    return found
