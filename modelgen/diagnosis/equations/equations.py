"""The equations of all training records as one object, with what further columns of them are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.description import Arm
from modelgen.diagnosis.equations.prior import Unknowns
from modelgen.diagnosis.equations.rows import Rows, rows_of
from modelgen.diagnosis.options.thresholds import Thresholds
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.numeric import Array


@dataclass(frozen=True)
class Equations:
    """y = X b + e of the training records, in one band.

    model: of the arm as described. evaluator: of the inputs that the arm, or a changed one, needs along the
    records' motions. rows: of each record. periods: rows in a period of each record, None where nothing
    repeats. blur: what errors of the positions, and those of efforts in steps that repeat, leave in the
    residuals, mean squares by joint (n,); stepped: of it that of the efforts. narrowed:
    the usual cut-off over that of these equations. thresholds: by which everything made of them decides.
    apart: of the arm with the inertia of drives that its parameters hold with their links', None where there
    is none: what is elastic lies between the two.
    """

    model: Model
    evaluator: Evaluator
    rows: Sequence[Rows]
    periods: Sequence[int | None]
    thresholds: Thresholds
    blur: Array = field(default_factory=lambda: np.zeros(1))
    stepped: Array = field(default_factory=lambda: np.zeros(1))
    narrowed: float = 1.0
    apart: Evaluator | None = None

    @property
    def arm(self) -> Arm:
        """The evaluator's: as described, or changed by what was found."""
        return self.evaluator.arm

    @property
    def n(self) -> int:
        """Number of joints."""
        return int(self.rows[0].effort.shape[1])

    @property
    def columns(self) -> list[Array]:
        """The model's own columns (M, n, k), of each record."""
        return [r.columns for r in self.rows]

    @property
    def unknowns(self) -> int:
        """Number of the model's own columns."""
        return int(self.rows[0].columns.shape[2])

    @property
    def baseline(self) -> Unknowns:
        """Unknowns that the model's own columns belong to."""
        return self.rows[0].baseline

    @property
    def free(self) -> bool:
        """Whether the records are free motions, without efforts."""
        return self.rows[0].prepared.input is None

    @property
    def coarse(self) -> bool:
        """Whether coarse positions asked for a narrower band than the usual one."""
        return self.narrowed > 1.0

    def base(self, theta: Array) -> Array:
        """Base parameters (p,) of unknowns, the model's own first; more of them do not count."""
        return self.baseline.base(theta[: self.unknowns])

    def of_record(self, prepared: Prepared, theta: Array) -> Rows:
        """Equations of another record with the same unknowns. theta: (k,), for loads."""
        return rows_of(self.evaluator, self.model, prepared, theta, self.baseline)

    def with_rows(self, rows: Sequence[Rows]) -> Equations:
        """Equations with other rows of the records, or with those of other records."""
        return replace(self, rows=rows)

    def with_evaluator(self, evaluator: Evaluator) -> Equations:
        """Equations whose further columns are made for another arm."""
        return replace(self, evaluator=evaluator, apart=None)
