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

from modelgen.dataset import Chosen, Prepared, Settings, choose, prepare
from modelgen.dataset.processing.content import motion_bandwidth
from modelgen.dataset.processing.periods import rows_in, with_whole_rows
from modelgen.dataset.processing.sequence import in_sequence
from modelgen.diagnosis.equations.checks import check_excitation, check_motion, check_test
from modelgen.diagnosis.equations.drive_inertia import described_by, hidden_inertias
from modelgen.diagnosis.equations.equations import Equations
from modelgen.diagnosis.equations.free_motion import away_from_rest
from modelgen.diagnosis.equations.position_errors import feigned, with_errors
from modelgen.diagnosis.equations.prior import Unknowns, estimated, held
from modelgen.diagnosis.equations.rows import Rows, rows_of
from modelgen.diagnosis.equations.study import Study
from modelgen.effects.placement import extended_arm
from modelgen.evaluation import Evaluator
from modelgen.evaluation.link_encoder import compliant
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import rmse, weighted_fit

# Budgets: how finely the equations settle decides nothing.
TURNS = 12  # of parameters and what elastic joints make of them
CLOSE = 1e-4  # of every parameter, by which the last turn changes it


@dataclass(frozen=True)
class Band:
    """Equations of the training records in one band. chosen: how records were processed; test: the test
    record, processed alike; theta: unknowns (k,) of a first fit.
    """

    equations: Equations
    chosen: Chosen
    test: Prepared
    theta: Array

    @property
    def base(self) -> Array:
        """Base parameters (p,) of the first fit."""
        return self.equations.base(self.theta)

    @property
    def feigned(self) -> float:
        """Percent of the RMSE that errors of the positions alone could gain at some joint."""
        e = self.equations
        return float(feigned(e.blur, rmse(e.rows, e.columns, self.theta) ** 2).max())


def bands(study: Study) -> Iterator[Band]:
    """Yield the bands to ask, the next where one cannot tell.

    Where errors of the positions could feign a little more than what counts, the wide band is asked first: it
    shows what is fast. Raises InputError where the records are too short, rest, or excite too little.
    """
    limits = study.thresholds
    wide = _band(study, study.settings)
    lost, cutoff = wide.feigned, np.inf
    if study.narrower:
        widths = [motion_bandwidth(record, limits.dataset) for record in study.records[:-1]]
        cutoff = limits.equations.narrow_cutoff_over_bandwidth * max(widths)
    narrowed = cutoff < wide.chosen.cutoff and lost > limits.validation.min_gain_percent
    if not narrowed or lost <= limits.equations.lost_band_percent:
        yield wide
    if narrowed:
        narrow = _band(study, replace(study.settings, cutoff=cutoff))
        equations = replace(narrow.equations, narrowed=wide.chosen.cutoff / cutoff)
        yield replace(narrow, equations=equations)


def _band(study: Study, settings: Settings) -> Band:
    model, records, lengths = study.model, study.records, study.lengths
    chosen = with_whole_rows(choose(list(records[:-1]), settings), lengths)
    choose(list(records), chosen)  # the test record has no say in what is chosen, and its rate all the same
    periods = [rows_in(p, chosen) for p in lengths]
    prepared = in_sequence([prepare(record, chosen) for record in records])
    free = records[0].input is None
    if free:
        prepared = [away_from_rest(p) for p in prepared]
    check_test(prepared[-1])
    known = held(model) if free else estimated(model, study.thresholds.equations)
    rows = settled_rows(study.evaluator, model, prepared[:-1], known)
    equations = Equations(model, study.evaluator, rows, periods, study.thresholds)
    check_motion(equations)
    check_excitation(equations)
    theta = weighted_fit(rows, equations.columns)
    equations = replace(with_errors(equations, theta), apart=_apart(equations, theta))
    return Band(equations, chosen, prepared[-1], theta)


def _apart(equations: Equations, theta: Array) -> Evaluator | None:
    """Evaluator of the arm whose drives have the inertia that its parameters hold with their links'."""
    every, least = range(1, equations.n + 1), equations.thresholds.extended.min_inertia_share
    found = hidden_inertias(equations.model, equations.base(theta), every, least)
    return Evaluator(extended_arm(equations.arm, described_by(found))) if found else None


def settled_rows(
    evaluator: Evaluator,
    model: Model,
    prepared: Sequence[Prepared],
    baseline: Unknowns,
    start: Array | None = None,
) -> list[Rows]:
    """The records' equations; made again where they depend on the parameters, until these stay as they are
    where the arm has elastic joints. start: unknowns (k,).
    """
    rows, theta = [rows_of(evaluator, model, p, start, baseline) for p in prepared], start
    by_load = model.function("regressor").reads("load", "state")
    for _ in range(TURNS if compliant(model.arm) else int(by_load)):
        before, theta = theta, weighted_fit(rows, [r.columns for r in rows])
        if before is not None and np.allclose(theta, before, rtol=CLOSE):
            break
        rows = [rows_of(evaluator, model, p, theta, baseline) for p in prepared]
    return rows
