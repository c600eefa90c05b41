"""Effects that no motion of this arm can tell apart, and those that the base parameters absorb.

Derived from the model along a synthetic motion, before any data are seen: equal spans of the columns,
once what the base parameters explain is subtracted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from scipy.linalg import subspace_angles

from modelgen.base_parameters.numeric_rank import random_states
from modelgen.description import Arm
from modelgen.diagnosis.candidates import (
    Candidate,
    FittedCandidate,
    Values,
    beside,
    of_part,
    slopes,
    system_of,
)
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.selection import COARSE, Cause, Selection, alternatives
from modelgen.errors import InputError
from modelgen.evaluation import Motion
from modelgen.functions import Model
from modelgen.model.equations import Equations as Dynamics
from modelgen.numeric import Array
from modelgen.regression.weighted import orthonormal

SEED = 20181101


def synthetic(arm: Arm, model: Model, samples: int = 400) -> Motion:
    """Random states within the strokes and limits, as a motion without order in time."""
    found = random_states(Dynamics(model.arm), samples, SEED)
    q, dq, ddq = (np.asarray(found[name], dtype=np.float64) for name in ("q", "dq", "ddq"))
    return Motion(0.01 * np.arange(samples, dtype=np.float64), q, dq, ddq)


def aliases(
    causes: Sequence[Candidate], pool: Sequence[Candidate], equations: Equations, base: Array
) -> list[list[Candidate]]:
    """For every cause the candidates whose columns span the same, whatever their values or with some of those
    that a search begins with: drag of a single joint is friction with the square of its speed. base: base
    parameters (p,).
    """
    where = _Motion(equations, base)
    most = equations.thresholds.adequacy.max_alias_angle
    spans = {id(c): [where.span(c, values) for values in _values(c)] for c in pool}
    result = []
    for cause in causes:
        own = None if cause.searched else where.span(cause, {})
        equal = []
        for other in pool:
            if other.place == cause.place:
                continue
            if any(_equal(own, there, most) for there in spans[id(other)]):
                equal.append(other)
        result.append(equal)
    return result


def _equal(a: Array | None, b: Array | None, most: float) -> bool:
    if a is None or b is None or a.shape != b.shape:
        return False
    return float(subspace_angles(a, b).max()) < most


def _values(c: Candidate) -> Iterator[Values]:
    """Yield values of what is searched, where it has no unit; nothing else is the same for every arm."""
    if all(p.scale == "1" for p in c.searched):
        for values in product(*(p.grid for p in c.searched)):
            yield {p.name: value for p, value in zip(c.searched, values, strict=True)}


class _Motion:
    """A synthetic motion, along which what effects add is compared once the base parameters' part is off."""

    def __init__(self, equations: Equations, base: Array) -> None:
        self.evaluator, self.base = equations.evaluator, base
        self.least = equations.thresholds.adequacy.min_absorbed_share
        self.motion = synthetic(equations.arm, equations.model)
        regressor = self.evaluator.regressor(equations.model, self.motion, base)
        self.own = orthonormal(regressor.reshape(-1, len(base)))

    def span(self, c: Candidate, values: Values) -> Array | None:
        """An orthonormal basis of what the candidate adds; None where the motion is no motion for it."""
        effect = c.definition  # states follow one another
        if effect.held(c.fixed) or c.coming or effect.periodic:
            return None
        given = {**c.fixed, **values}
        try:
            if c.curved:
                table = slopes(c, given, self.motion, self.evaluator, self.base)
            else:
                every = self.evaluator.columns(c.effect, c.joint, self.motion, given, self.base)
                (table,) = of_part(c, [every])
        except (InputError, ValueError):
            return None
        flat = table.reshape(-1, table.shape[2])
        sizes = np.linalg.norm(flat, axis=0)
        flat = flat[:, sizes > 1e-5 * sizes.max(initial=0.0)] if sizes.any() else flat[:, :0]
        if not flat.shape[1]:
            return None
        own = flat - self.own @ (self.own.T @ flat)
        left = np.linalg.norm(own, axis=0) > self.least * np.linalg.norm(flat, axis=0)
        return orthonormal(own[:, left]) if left.any() else None


def without_indistinguishable(
    selection: Selection, equal: Sequence[Sequence[Candidate]]
) -> tuple[Selection, list[Cause]]:
    """The selection, with no cause at all where rivals come close to some, and these with such rivals alone.

    What the other causes explain depends on which of them it is. In the usual band none is lost. Aliases say
    the same thing, and so does a law with more freedom that holds the cause's own and makes no use of it.
    equal: aliases of every cause.
    """
    equations = selection.system.equations
    if not equations.coarse:
        return selection, []
    found, most = [], equations.thresholds.selection.rival_margin_bic
    for cause, same in zip(selection.causes, equal, strict=True):
        places = [other.place for other in same]
        near = [(t, by) for t, by in cause.rivals if by <= most and t.candidate.place not in places]
        rivals = [(t, by) for t, by in near if not _the_same(t, cause, selection)]
        if rivals:
            found.append(replace(cause, rivals=rivals))
    return (selection.without(selection.causes, COARSE), found) if found else (selection, [])


def _the_same(rival: FittedCandidate, cause: Cause, selection: Selection) -> bool:
    """Whether the cause adds nothing to the rival in its place, or the two are an elastic joint and a gap,
    which are told apart by what they carry to other records.
    """
    if alternatives(rival.candidate, cause.trial.candidate):
        return True
    others = [c.trial for c in selection.causes if c is not cause]
    system = system_of(selection.system.equations, [*others, rival])
    return beside(cause.trial, system) is None
