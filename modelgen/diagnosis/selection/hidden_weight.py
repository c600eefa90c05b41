"""What nobody knows of the weight that shows only where gravity is turned.

A base that leans makes parts of the links weigh which no record of the upright arm shows. The description's
nominal inertials say how much, and are wrong: what a tilt makes of that is no spring, and moves no tilt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, system_of
from modelgen.diagnosis.evidence import StackedEquations, System, mean_squares
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.effects import DescriptionEffect, described
from modelgen.effects.placement import with_effect
from modelgen.numeric import Array
from modelgen.regression.weighted import orthonormal

UNKNOWN = 1e3  # kg, kg m, that a weight may be off of which nothing is known


@dataclass(frozen=True)
class HiddenWeights:
    """Hidden weights that causes turn, beside the equations of a system. tables: what one standard deviation
    of each adds, (M, n, h) of every record; whole: (R, h), stacked; columns: the same without what the system
    explains; basis: (R, p), orthonormal, of that; share: of the equations, those that are independent.
    """

    tables: Sequence[Array]
    whole: Array
    columns: Array
    basis: Array
    share: float

    def beyond(self, stacked: Array) -> Array:
        """Stacked values (R,) without what the system explains."""
        return np.asarray(stacked - self.basis @ (self.basis.T @ stacked))

    def amounts(self, stacked: Array) -> Array:
        """Deviations (h,) that explain stacked values (R,) best that have no more of them than chance has
        (Hoerl and Kennard 1970).
        """
        return np.asarray(self.uncertain @ (self.share * (self.columns.T @ self.beyond(stacked))))

    def explain(self, stacked: Array) -> Array:
        """What of stacked values (R,) they explain."""
        return np.asarray(self.columns @ self.amounts(stacked))

    @property
    def uncertain(self) -> Array:
        """Covariance (h, h) of their amounts, known so."""
        square = self.share * (self.columns.T @ self.columns)
        return np.asarray(np.linalg.inv(square + np.eye(len(square))))


def hidden_weights(causes: Sequence[Cause], system: System, w: StackedEquations) -> HiddenWeights | None:
    """Those that causes turn, in stacked equations of a system; None where they turn no gravity, and where
    nothing is hidden.
    """
    several = [t for c in causes if (t := _by_deviation(c.trial, system)) is not None]
    if not several:
        return None
    tables = [np.concatenate(parts, axis=2) for parts in zip(*several, strict=True)]
    whole, basis = w.records(tables), orthonormal(w.matrix)
    return HiddenWeights(tables, whole, whole - basis @ (basis.T @ whole), basis, w.share)


def beside_hidden_weight(selection: Selection) -> Selection:
    """The selection without what hidden weights add to the efforts by which its causes explain most."""
    system = selection.system
    hidden = hidden_weights(selection.causes, system, system.plain)
    if hidden is None:
        return selection
    amounts = hidden.amounts(system.plain.right)
    rows = [
        replace(r, effort=r.effort - t @ amounts) for r, t in zip(system.rows, hidden.tables, strict=True)
    ]
    system = system_of(system.equations.with_rows(rows), [c.trial for c in selection.causes])
    return replace(selection, system=system)


def left_beside_hidden_weight(cause: Cause, selection: Selection) -> float:
    """Share of the evidence for a cause that is left beside the hidden weights that its companions turn: what
    these explain is no evidence. 1 beside causes that turn no gravity.
    """
    others = [c for c in selection.causes if c is not cause]
    if not any(issubclass(c.trial.candidate.definition, DescriptionEffect) for c in others):
        return 1.0
    rest = system_of(selection.system.equations, [c.trial for c in others])
    hidden = hidden_weights(others, rest, rest.fair)
    if hidden is None:
        return 1.0
    values = np.ones(1) if cause.trial.candidate.elastic else cause.trial.gain.values
    own = hidden.beyond(rest.fair.records([t @ values[:, None] for t in cause.trial.columns])[:, 0])
    return 1.0 - float(own @ hidden.explain(own)) / max(float(own @ own), 1e-300)


def explained_by_hidden_weight(selection: Selection) -> Array:
    """Mean squares (n,) of what the causes leave that hidden weights explain which they turn."""
    less = mean_squares(selection.system) - mean_squares(beside_hidden_weight(selection).system)
    return np.asarray(np.maximum(0.0, less))


def _by_deviation(trial: FittedCandidate, system: System) -> list[Array] | None:
    """What one standard deviation of each hidden weight adds to the equations of every record, (M, n, h);
    None where a cause turns no gravity, and where nothing is hidden.

    Nominal inertials are as far off as the records say of those that they show; of what no description tells
    anything may be there.
    """
    c, equations = trial.candidate, system.equations
    evaluator, said = equations.evaluator, equations.rows[0].baseline.said
    if not issubclass(c.definition, DescriptionEffect):
        return None
    leaning = described(with_effect(evaluator.arm, c.effect, c.joint, trial.parameters))
    turned = np.subtract(leaning.gravity, described(evaluator.arm).gravity)
    if not turned.any():
        return None
    tables = [r.filtered(evaluator.hidden_weight.by_scale(r.motion, turned)) for r in equations.rows]
    if not any(t.any() for t in tables):
        return None
    scale = UNKNOWN
    if evaluator.hidden_weight.known and said is not None:
        scale = equations.thresholds.equations.nominal_scatter * said.scatter(system.base)
    return [scale * t for t in tables]
