"""Filtered rows of records: efforts, and the regressor's columns that are not zero by structure."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from modelgen.backends.compiled import RegressorColumns
from modelgen.dataset import Prepared
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.evaluation.link_encoder import compliant
from modelgen.functions import Model
from modelgen.native import compiler
from modelgen.numeric import Array

LEFT = 0.5  # of the filter's weight, that a row has from samples away from rest at least
SAMPLED = ["q", "dq", "ddq"]  # what the regressor may depend on, to be compiled


class Rows:
    """Rows of a model's regressor for records, with the efforts.

    While a joint rests, be it for a moment, dry friction is whatever holds it. The filter would carry that to
    rows beside, where it looks like other friction: effort and columns of such samples are removed before.
    Friction whose sign is smoothed holds no joint, and says as much there as elsewhere.
    all_samples: they stay, for rows that are to be looked at.
    joint, parameter: (c,), places in the regressor of the c columns that are computed; those of a joint
    stand side by side, at `of_joint`. With a C compiler, columns that depend on the motion alone are computed
    by it and pass the filter on the way; else NumPy computes them for all samples, to be filtered then.
    """

    def __init__(self, model: Model, evaluator: Evaluator, *, all_samples: bool = False) -> None:
        self.model, self.evaluator, self.all_samples = model, evaluator, all_samples
        self.n, self.p = len(model.arm.coordinates), len(model.grouping.base)
        joints = [model.arm.joints[i] for i in model.arm.coordinates]
        self.slides = np.array([any(use.values.get("smoothing") for use in j.effects) for j in joints])
        self.joint = np.array(model.packed.rows, dtype=np.intp)
        self.parameter = np.array(model.packed.columns, dtype=np.intp)
        ends = np.searchsorted(self.joint, np.arange(self.n + 1))
        self.of_joint = [slice(a, b) for a, b in pairwise(ends)]
        function = model.function("regressor")
        self._compiled: dict[bool, RegressorColumns] = {}  # by whether samples have weights
        if [a.name for a in function.arguments] == SAMPLED and compiler() is not None:
            for weighted in (False, True):
                self._compiled[weighted] = RegressorColumns(function, weighted=weighted)
            assert np.array_equal(self._compiled[False].elements, self.joint * self.p + self.parameter)

    def of(self, p: Prepared, theta: Array) -> tuple[Array, Array]:
        """Effort (M, n) and columns (M, c) of a record. theta: for columns that depend on the load [base].

        Raises InputError for a free motion.
        """
        if p.input is None:
            raise InputError(f"{p.record.name}: a free motion has no effort to identify from")
        motion, awake = motion_of(p), self._awake(p)
        effort, full = self.evaluator.ideal(self.model, motion, p.input), None
        if theta.any() and compliant(self.model.arm):
            full = np.asarray(self.evaluator.regressor(self.model, motion, theta))
            effort = effort - self.evaluator.unseen(motion, full, theta)
        effort = np.asarray(p.parallel(effort if awake is None else effort * awake))
        if self._compiled and RegressorColumns.fit(p.q):
            inputs = [p.q, p.dq, p.ddq, *([] if awake is None else [awake])]
            made, d = self._compiled[awake is not None], p.decimation
            with suppress(RuntimeError):  # a compiler that knows no vectors, say
                columns = made.filtered(inputs, **vars(d)) if d else p.parallel(made.values(inputs))
                return effort, columns + self._turned(p, motion, awake)
            self._compiled = {}
        if full is None:
            full = np.asarray(self.evaluator.regressor(self.model, motion, theta))
        table = full[:, self.joint, self.parameter]
        return effort, p.parallel(table if awake is None else table * awake[:, self.joint])

    def _turned(self, p: Prepared, motion: Motion, awake: Array | None) -> Array | float:
        """Columns (M, c) to be added for joints that turn back in a sample over which efforts are means."""
        pieces = motion.pieces if motion.held else None
        if pieces is None:
            return 0.0

        def columns(samples: NDArray[np.intp], dq: Array) -> Array:
            within = replace(motion.picked(samples), dq=dq)
            made = np.asarray(self.evaluator.regressor(self.model, within, np.zeros(self.p)))
            return made[:, self.joint, self.parameter]

        samples, means = pieces.means(columns(pieces.sample, pieces.speeds(motion.dq)))
        more = means - columns(samples, motion.dq[samples])
        if awake is not None:
            more *= awake[samples][:, self.joint]
        changed = more.any(axis=0)
        full = np.zeros((len(motion.t), int(changed.sum())))
        full[samples] = more[:, changed]
        found = np.zeros((len(p.rows), len(self.joint)))
        found[:, changed] = p.parallel(full)
        return found

    def moving(self, p: Prepared) -> NDArray[np.bool_]:
        """Rows (M, n) that count: joints move there, and most of what the filter has drawn in is there."""
        awake = self._awake(p)
        return p.moving if awake is None else p.moving & (p.parallel(awake) > LEFT)

    def _awake(self, p: Prepared) -> Array | None:
        """Weights (N, n) of samples, None: all count. Those of joints that never move, which hold, do."""
        if self.all_samples or not p.settings.cutoff:  # without a filter nothing is carried
            return None
        awake = p.awake | self.slides | ~p.moving.any(axis=0)
        return None if awake.all() else p.weighted(awake)

    def whole(self, columns: Array) -> Array:
        """The columns (M, c) as a matrix by sample (M, n, p)."""
        result = np.zeros((len(columns), self.n, self.p))
        result[:, self.joint, self.parameter] = columns
        return result


def motion_of(p: Prepared) -> Motion:
    """The record's motion, and those that it runs on from; with the side of the joints that was measured,
    where that matters.
    """
    before = None if p.before is None else motion_of(p.before)
    if p.record.arm is None or not compliant(p.record.arm):
        return Motion(p.time, p.q, p.dq, p.ddq, before=before, held=p.record.held)
    sides = p.record.motor_side or (False,) * p.n
    return Motion(p.time, p.q, p.dq, p.ddq, sides, p.settings.cutoff, before, p.record.held)
