"""The equations of the records, in the band that the encoders leave.

Errors of the positions come into the equations by way of accelerations: below a cut-off f their power grows
as f^5, that of the motion does not. Where a wide band is lost in them, a narrow one, still far above the
motion, is not. Effort and regressor pass one filter, so that a narrow band biases nothing; it sees less of
what is fast.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset import Chosen, Prepared, Record, Settings, choose, prepare
from modelgen.dataset.processing.periods import with_whole_rows
from modelgen.dataset.processing.settings import motion_bandwidth
from modelgen.diagnosis.equations.checks import check_excitation, check_motion, check_test
from modelgen.diagnosis.equations.free_motion import away_from_rest
from modelgen.diagnosis.equations.position_errors import feigned, with_errors
from modelgen.diagnosis.equations.prior import Unknowns, estimated, held
from modelgen.diagnosis.equations.rows import Rows, rows_of
from modelgen.diagnosis.thresholds import PRACTICAL
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import rmse, weighted_fit

OVER_MOTION = 10.0  # narrow cut-off over the bandwidth of the motion
LOST = 5.0  # percent of the RMSE that errors of the positions could feign where a band is lost in them


@dataclass(frozen=True)
class Equations:
    """Of the training records; the last of `prepared` is the test record.

    periods: rows in a period of each training record. theta: of a first fit. blur: what errors of the
    positions leave in the residuals, mean squares by joint (n,). narrowed: the usual cut-off over that of the
    rows.
    """

    chosen: Chosen
    periods: Sequence[int | None]
    prepared: Sequence[Prepared]
    rows: Sequence[Rows]
    theta: Array
    blur: Array
    narrowed: float = 1.0

    @property
    def feigned(self) -> float:
        """Percent of the RMSE that errors of the positions alone could gain at some joint."""
        squares = rmse(self.rows, [r.columns for r in self.rows], self.theta) ** 2
        return float(feigned(self.blur, squares).max())


def bands(
    model: Model,
    evaluator: Evaluator,
    found: Sequence[Record],
    lengths: Sequence[int | None],
    settings: Settings,
    *,
    narrower: bool,
) -> Iterator[Equations]:
    """Of records of which the last is the test record, in the bands to ask, the next where one cannot tell.

    narrower: whether a band in which coarse positions are lost may give way to a narrower one. Where they
    could feign a little more than what counts, the wide one is asked first: it shows what is fast.
    Raises InputError where the records are too short, rest, or excite too little.
    """
    wide = _equations(model, evaluator, found, lengths, settings)
    lost = wide.feigned
    cutoff = OVER_MOTION * max(motion_bandwidth(record) for record in found[:-1]) if narrower else np.inf
    narrowed = cutoff < wide.chosen.cutoff and lost > PRACTICAL
    if not narrowed or lost <= LOST:
        yield wide
    if narrowed:
        narrow = _equations(model, evaluator, found, lengths, replace(settings, cutoff=cutoff))
        yield replace(narrow, narrowed=wide.chosen.cutoff / cutoff)


def _equations(
    model: Model,
    evaluator: Evaluator,
    found: Sequence[Record],
    lengths: Sequence[int | None],
    settings: Settings,
) -> Equations:
    chosen = with_whole_rows(choose(list(found[:-1]), settings), lengths)
    choose(list(found), chosen)  # the test record has no say in what is chosen, and its rate all the same
    periods = [None if p is None or p % chosen.factor else p // chosen.factor for p in lengths]
    prepared = [prepare(record, chosen) for record in found]
    free = found[0].input is None
    if free:
        prepared = [away_from_rest(p) for p in prepared]
    check_test(prepared[-1])
    train = prepared[:-1]
    rows = rows_twice(evaluator, model, train, held(model) if free else estimated(model))
    check_motion(model.arm, rows)
    check_excitation(model.arm, model, rows)
    theta = weighted_fit(rows, [r.columns for r in rows])
    rows, blur = with_errors(rows, periods, evaluator, model, theta)
    return Equations(chosen, periods, prepared, rows, theta, blur)


def rows_twice(
    evaluator: Evaluator,
    model: Model,
    prepared: Sequence[Prepared],
    baseline: Unknowns,
    start: Array | None = None,
) -> list[Rows]:
    """The records' equations; made twice where columns depend on the parameters. start: unknowns (k,)."""
    rows = [rows_of(evaluator, model, p, start, baseline) for p in prepared]
    (regressor,) = [f for f in model.functions if f.name == "regressor"]
    if {"load", "state"} & {a.name for a in regressor.arguments}:
        theta = weighted_fit(rows, [r.columns for r in rows])
        rows = [rows_of(evaluator, model, p, theta, baseline) for p in prepared]
    return rows
