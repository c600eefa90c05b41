"""Columns of effects in which nothing is linear: how the inputs change with their parameters, by differences.

A slope is right for small values. A delay of a quarter of the fastest period, or a tilt that turns heavy
links, is beyond that: its column is then the whole change over the value, a secant.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.diagnosis.candidates.candidate import Candidate, Values, at_links
from modelgen.diagnosis.equations import Equations, Rows
from modelgen.effects import Shows
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.numeric import Array

TAIL = 1e-6  # of the largest of all records: less is rounding


def unchanging(candidate: Candidate, evaluator: Evaluator) -> bool:
    """Whether its columns are the same whatever the arm's parameters are."""
    if not candidate.definition.linear:
        return False
    return not evaluator.needs_load(candidate.effect, candidate.joint, candidate.fixed)


def candidate_columns(
    candidate: Candidate, values: Values, equations: Equations, base: Array, *, ringing: bool = False
) -> list[Array] | None:
    """Its columns (M, n, k) in every record of the equations for values of what is searched, or about which a
    column that follows no line counts; None where it cannot stand. base: base parameters (p,). ringing: an
    elastic joint may ring as a record begins.
    """
    evaluator = equations.evaluator
    if candidate.elastic and equations.apart is not None:
        evaluator = equations.apart
    try:
        found = [r.filtered(_at_full_rate(candidate, values, r, evaluator, base)) for r in equations.rows]
    except InputError:
        return None
    if ringing and candidate.elastic and Shows.IMPACTS not in candidate.definition.shows:
        least = equations.thresholds.candidates.certain_delta_bic
        found = [
            t + _begun(candidate, values, r, evaluator, base, r.effort - t[:, :, 0], least)
            for t, r in zip(found, equations.rows, strict=True)
        ]
    if candidate.elastic:  # the tail of a filter, of what lies outside the rows, is nothing
        largest = max((np.abs(table).max(initial=0.0) for table in found), default=0.0)
        found = [t if np.abs(t).max(initial=0.0) > TAIL * largest else np.zeros_like(t) for t in found]
    return where_there(candidate, of_part(candidate, found) if candidate.definition.linear else found)


def columns_at_rows(candidate: Candidate, values: Values, equations: Equations, base: Array) -> list[Array]:
    """Columns (M, n, k) of a linear effect at the rows of every record, as `candidate_columns` before the
    filter.
    """
    found = []
    for r in equations.rows:
        rows, given = r.motion.picked(r.prepared.rows), {**candidate.fixed, **values}
        found.append(equations.evaluator.columns(candidate.effect, candidate.joint, rows, given, base))
    return where_there(candidate, of_part(candidate, found))


def of_part(candidate: Candidate, tables: Sequence[Array]) -> list[Array]:
    """Pick the columns that are asked for, of those (M, n, k) of all parameters."""
    if not candidate.part:
        return list(tables)
    kept = [candidate.every.index(name) for name in candidate.names]
    return [table[:, :, kept] for table in tables]


def where_there(candidate: Candidate, tables: Sequence[Array]) -> list[Array]:
    """Columns (M, n, k) of all records, zero in those without the effect."""
    return [np.zeros_like(t) if k in candidate.absent else t for k, t in enumerate(tables)]


def _at_full_rate(c: Candidate, values: Values, r: Rows, evaluator: Evaluator, base: Array) -> Array:
    given = {**c.fixed, **values}
    if c.definition.linear:
        return evaluator.columns(c.effect, c.joint, r.motion, given, base)
    return slopes(c, given, r.motion, evaluator, base)


def slopes(c: Candidate, values: Values, motion: Motion, evaluator: Evaluator, base: Array) -> Array:
    """Columns (N, n, k) at full rate of an effect in which nothing is linear, about values."""

    def added(values: Values) -> Array:
        return evaluator.contribution(c.effect, c.joint, motion, values, base)

    return c.definition.slopes(c.names, values, added)


def _begun(
    c: Candidate, values: Values, r: Rows, evaluator: Evaluator, base: Array, effort: Array, least: float
) -> Array:
    """What an elastic joint adds to the equations that rings as the record begins, (M, n, 1), by lag and rate
    that leave least; zero where that has less evidence, and where the link was measured.

    effort: (M, n), without what the joint does that begins where its load holds it. least: delta BIC.
    """
    assert c.joint is not None
    none, j = np.zeros((*effort.shape, 1)), c.joint - 1
    if at_links(c.joint, [r]):
        return none
    given = c.definition.physical({**c.fixed, **values})
    rings = r.filtered(evaluator.ringing(c.effect, c.joint, r.motion, given, base))
    rigid = r.filtered(evaluator.inputs(r.motion, base)[:, :, None])[:, :, 0]
    moving = r.moving[:, j]
    left, own = (effort - rigid)[moving, j], rings[moving, j]
    start = np.linalg.lstsq(own, left, rcond=None)[0]
    before, after = float(np.sum(left**2)), float(np.sum((left - own @ start) ** 2))
    evidence = len(left) * np.log(max(before, 1e-300) / max(after, 1e-300)) - 2.0 * np.log(len(left))
    return np.asarray((rings @ start)[:, :, None]) if evidence > least else none
