"""Effects that no motion of this arm can tell apart, and those that the base parameters absorb.

Derived from the model along a synthetic motion, before any data are seen: equal spans of the columns,
once what the base parameters explain is taken off.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from scipy.linalg import subspace_angles

from modelgen.base_parameters.numeric_rank import random_states
from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import Candidate, Values
from modelgen.diagnosis.candidates.columns import of_part, slopes
from modelgen.diagnosis.candidates.fitted import FittedCandidate, beside
from modelgen.diagnosis.evidence.system import System
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.compliance import alternatives
from modelgen.diagnosis.selection.history import COARSE
from modelgen.diagnosis.thresholds import RATHER
from modelgen.diagnosis.validation.form_error import with_causes
from modelgen.effects import Presence
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model
from modelgen.model.equations import Equations
from modelgen.numeric import Array
from modelgen.regression.weighted import orthonormal

EQUAL = 1e-6  # rad, principal angle
ABSORBED = 1e-6  # part of a column that is left
SEED = 20181101


def synthetic(arm: Arm, model: Model, samples: int = 400) -> Motion:
    """Random states within the strokes and limits, as a motion without order in time."""
    found = random_states(Equations(model.arm), samples, SEED)
    q, dq, ddq = (np.asarray(found[name], dtype=np.float64) for name in ("q", "dq", "ddq"))
    return Motion(0.01 * np.arange(samples, dtype=np.float64), q, dq, ddq)


def aliases(
    causes: Sequence[Candidate], pool: Sequence[Candidate], evaluator: Evaluator, model: Model, base: Array
) -> list[list[Candidate]]:
    """For every cause the candidates whose columns span the same, whatever their values or with some of those
    that a search begins with: drag of a single joint is friction with the square of its speed.
    """
    motion = synthetic(evaluator.arm, model)
    q = orthonormal(evaluator.regressor(model, motion, base).reshape(-1, len(base)))
    spans = {id(c): [_span(c, values, evaluator, motion, base, q) for values in _values(c)] for c in pool}
    result = []
    for cause in causes:
        own = None if cause.searched else _span(cause, {}, evaluator, motion, base, q)
        equal = []
        for other in pool:
            if other.place == cause.place:
                continue
            if any(_equal(own, there) for there in spans[id(other)]):
                equal.append(other)
        result.append(equal)
    return result


def _equal(a: Array | None, b: Array | None) -> bool:
    if a is None or b is None or a.shape != b.shape:
        return False
    return float(subspace_angles(a, b).max()) < EQUAL


def _values(c: Candidate) -> Iterator[Values]:
    """Of what is searched, where that has no unit; nothing else is the same for every arm."""
    if all(p.scale == "1" for p in c.searched):
        for values in product(*(p.grid for p in c.searched)):
            yield {p.name: value for p, value in zip(c.searched, values, strict=True)}


def _span(
    c: Candidate, values: Values, evaluator: Evaluator, motion: Motion, base: Array, q: Array
) -> Array | None:
    """An orthonormal basis of what the candidate adds; None where the motion is no motion for it."""
    effect = c.definition  # states follow one another
    if effect.held(c.fixed) or effect.presence is Presence.LATER or effect.periodic:
        return None
    try:
        if c.curved:
            table = slopes(c, {**c.fixed, **values}, motion, evaluator, base)
        else:
            (table,) = of_part(c, [evaluator.columns(c.effect, c.joint, motion, {**c.fixed, **values}, base)])
    except (InputError, ValueError):
        return None
    flat = table.reshape(-1, table.shape[2])
    sizes = np.linalg.norm(flat, axis=0)
    flat = flat[:, sizes > 1e-5 * sizes.max(initial=0.0)] if sizes.any() else flat[:, :0]
    if not flat.shape[1]:
        return None
    own = flat - q @ (q.T @ flat)
    left = np.linalg.norm(own, axis=0) > ABSORBED * np.linalg.norm(flat, axis=0)
    return orthonormal(own[:, left]) if left.any() else None


def without_indistinguishable(
    selection: Selection, equal: Sequence[Sequence[Candidate]], narrowed: float
) -> tuple[Selection, list[Cause]]:
    """The selection, with no cause at all where rivals come close to some, and these with such rivals alone.

    What the other causes explain depends on which of them it is. In the usual band none is lost. Aliases say
    the same thing, and so does a law with more freedom that holds the cause's own and makes no use of it.
    equal: aliases of every cause; narrowed: the usual band over that of the equations.
    """
    if narrowed == 1.0:
        return selection, []
    found = []
    for cause, same in zip(selection.causes, equal, strict=True):
        places = [other.place for other in same]
        near = [(t, by) for t, by in cause.rivals if by <= RATHER and t.candidate.place not in places]
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
    rows = selection.system.rows
    others = [c.trial for c in selection.causes if c is not cause]
    system = System(rows, with_causes(rows, [*others, rival]), selection.system.periods)
    return beside(cause.trial, system) is None
