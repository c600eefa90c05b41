"""Columns of effects in which nothing is linear: how the inputs change with their parameters, by differences.

A slope is right for small values. A delay of a quarter of the fastest period, or a tilt that turns heavy
links, is beyond that: its column is then the whole change over the value, a secant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.diagnosis.candidates.candidate import COMPLIANT, LATER, STEPS, Candidate, Values
from modelgen.diagnosis.equations.rows import Rows
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.numeric import Array

FORWARD = "torque_constant_saturation"  # not negative
INVISIBLE = 1e-5  # of the largest column
TAIL = 1e-6  # of the largest of all records


def sensitivities(
    effect: str,
    joint: int | None,
    motion: Motion,
    evaluator: Evaluator,
    base: Array,
    names: Sequence[str],
    around: Mapping[str, float],
) -> Array:
    """Changes of the inputs (N, n, k) with the named parameters of the effect, per unit.

    around: values by name; where one is given, and is more than the step of a slope, the column is what that
    value alone changes, over it. Raises InputError where the arm does not admit it.
    """
    parts = []
    for name in names:
        step, value = STEPS[effect][name], around.get(name, 0.0)
        if abs(value) > step:
            parts.append(evaluator.contribution(effect, joint, motion, {name: value}, base) / value)
            continue
        ahead = evaluator.contribution(effect, joint, motion, {name: step}, base)
        if effect == FORWARD:
            parts.append(ahead / step)
        else:
            behind = evaluator.contribution(effect, joint, motion, {name: -step}, base)
            parts.append((ahead - behind) / (2 * step))
    together = np.stack(parts, axis=2)
    # what differences leave of an effect that does not show is no column
    sizes = np.abs(together).max(axis=(0, 1))
    return np.where(sizes > INVISIBLE * sizes.max(initial=0.0), together, 0.0)


def payload(
    joint: int | None, motion: Motion, evaluator: Evaluator, base: Array, around: Mapping[str, float]
) -> Array:
    """Changes of the inputs (N, n, 4) with mass and first moments of what the last link carries.

    around: mass and place of what was found; its second moments are as if it were all there. At the link's
    origin where there is none.
    """
    step = 1e-3
    place = {a: around.get(a, 0.0) if around.get("mass", 0.0) > 0 else 0.0 for a in "xyz"}

    def of(**moved: float) -> Array:
        return evaluator.contribution("payload_change", joint, motion, {"mass": 1.0, **place, **moved}, base)

    moments = []
    for a in "xyz":
        ahead, behind = (of(**{a: place[a] + d}) for d in (step, -step))
        moments.append((ahead - behind) / (2 * step))
    mass = of() - sum(place[a] * moment for a, moment in zip("xyz", moments, strict=True))
    return np.stack([mass, *moments], axis=2)


def unchanging(candidate: Candidate, evaluator: Evaluator) -> bool:
    """Whether its columns are the same whatever the arm's parameters are."""
    if candidate.effect in (*STEPS, LATER, *COMPLIANT):
        return False
    return not evaluator.needs_load(candidate.effect, candidate.joint, candidate.fixed)


def candidate_columns(
    candidate: Candidate, values: Values, rows: Sequence[Rows], evaluator: Evaluator, base: Array
) -> list[Array] | None:
    """Its columns (M, n, k) in every record for values of what is searched, or about which a column that
    follows no line is taken; None where it cannot stand.
    """
    try:
        found = [
            r.filtered(_at_full_rate(candidate, values, r, k, evaluator, base)) for k, r in enumerate(rows)
        ]
    except InputError:
        return None
    if candidate.effect in COMPLIANT:  # the tail of a filter, of what lies outside the rows, is nothing
        largest = max((np.abs(table).max(initial=0.0) for table in found), default=0.0)
        found = [t if np.abs(t).max(initial=0.0) > TAIL * largest else np.zeros_like(t) for t in found]
    return found if candidate.effect in STEPS else of_part(candidate, found)


def of_part(candidate: Candidate, tables: Sequence[Array]) -> list[Array]:
    """Of columns (M, n, k) of all parameters, those that are asked for."""
    if not candidate.part:
        return list(tables)
    kept = [candidate.every.index(name) for name in candidate.names]
    return [table[:, :, kept] for table in tables]


def _at_full_rate(
    c: Candidate, values: Values, r: Rows, record: int, evaluator: Evaluator, base: Array
) -> Array:
    motion = r.motion
    if c.effect in STEPS:
        return sensitivities(c.effect, c.joint, motion, evaluator, base, c.names, values)
    if c.effect == LATER:  # in all records but the first
        return (
            payload(c.joint, motion, evaluator, base, values)
            if record
            else np.zeros((*r.prepared.q.shape, 4))
        )
    given = {**c.fixed, **values}
    if c.effect in COMPLIANT:
        given["damping"] = given.pop("relaxation") * given["stiffness"]
        return evaluator.contribution(c.effect, c.joint, motion, given, base)[:, :, None]
    return evaluator.columns(c.effect, c.joint, motion, given, base)
