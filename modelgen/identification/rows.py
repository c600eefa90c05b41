"""Filtered rows of records: efforts, and the regressor's columns that are not zero by structure."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from modelgen.backends.compiled import RegressorColumns
from modelgen.dataset import Prepared
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model
from modelgen.native import compiler
from modelgen.numeric import Array

SAMPLED = ["q", "dq", "ddq"]  # what the regressor may depend on, to be compiled


class Rows:
    """Rows of a model's regressor for records, with the efforts.

    joint, parameter: (c,), places in the regressor of the c columns that are computed; those of a joint
    stand side by side, at `of_joint`. With a C compiler, columns that depend on the motion alone are computed
    by it and pass the filter on the way; else NumPy computes them for all samples, to be filtered then.
    """

    def __init__(self, model: Model, evaluator: Evaluator) -> None:
        self.model, self.evaluator = model, evaluator
        self.n, self.p = len(model.arm.coordinates), len(model.grouping.base)
        self.joint = np.array(model.packed.rows, dtype=np.intp)
        self.parameter = np.array(model.packed.columns, dtype=np.intp)
        ends = np.searchsorted(self.joint, np.arange(self.n + 1))
        self.of_joint = [slice(a, b) for a, b in pairwise(ends)]
        (function,) = [f for f in model.functions if f.name == "regressor"]
        self.motion_alone = [a.name for a in function.arguments] == SAMPLED
        self._compiled: RegressorColumns | None = None
        if self.motion_alone and compiler() is not None:
            self._compiled = RegressorColumns(function)
            at = self.joint * self.p + self.parameter
            assert np.array_equal(self._compiled.elements, at)

    def of(self, p: Prepared, theta: Array) -> tuple[Array, Array]:
        """Effort (M, n) and columns (M, c) of a record. theta: for columns that depend on the load [base].

        Raises InputError for a free motion.
        """
        if p.input is None:
            raise InputError(f"{p.record.name}: a free motion has no effort to identify from")
        motion = Motion(p.time, p.q, p.dq, p.ddq)
        effort = np.asarray(p.parallel(self.evaluator.ideal(self.model, motion, p.input)))
        if self._compiled is not None and self._compiled.fit(q=p.q):
            try:
                inputs, d = (p.q, p.dq, p.ddq), p.decimation
                if d is None:
                    return effort, p.parallel(self._compiled.values(inputs))
                return effort, self._compiled.filtered(inputs, **vars(d))
            except RuntimeError:  # a compiler that knows no vectors, say
                self._compiled = None
        full = np.asarray(self.evaluator.regressor(self.model, motion, theta))
        return effort, p.parallel(full[:, self.joint, self.parameter])

    def whole(self, columns: Array) -> Array:
        """The columns (M, c) as a matrix by sample (M, n, p)."""
        result = np.zeros((len(columns), self.n, self.p))
        result[:, self.joint, self.parameter] = columns
        return result
