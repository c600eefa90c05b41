"""A case as methods see it: the equations of modelgen's diagnosis, and everything that it would ask for.

All methods get the same filtered equations, those of the band that the diagnosis asks first, and the same
columns, those at which each of its candidates explains most beside the user's model alone. They differ in
what they choose, and in nothing else.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from blind.case import TRUTH, Array, Case
from blind.others.method import Answer, Method, Motion, Place, Problem, Record, Term
from modelgen.description import loads
from modelgen.diagnosis.adequacy import aliases
from modelgen.diagnosis.candidates import (
    Candidate,
    FittedCandidate,
    Search,
    at_motor,
    candidate_columns,
    candidates,
    fit_pool,
)
from modelgen.diagnosis.equations import Band, Rows, bands, study_of
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.pipeline import records
from modelgen.effects import known_effects
from modelgen.jobs import HERE


@dataclass(frozen=True)
class Asked:
    """A problem, and what is needed to judge its answer. test: equations of the test record; own: effort (M,
    n) that the user's model, fitted to the training records, predicts there; pool: all candidates; forms:
    those that the terms were made of, by place.
    """

    problem: Problem
    band: Band
    test: Rows
    own: Array
    pool: Sequence[Candidate]
    forms: Mapping[Place, Candidate]


def asked(case: Case, folder: Path) -> Asked:
    """Write a case and make its problem. The test record and the truth do not stay in the folder.

    Raises InputError where the records cannot answer.
    """
    case.write(folder)
    options = Options()
    (folder / TRUTH).unlink()
    arm = loads(case.arms, "arms.yaml", known_effects())[case.arm]
    train, test = [str(folder / f"{n}.csv") for n in case.train], folder / f"{case.test}.csv"
    mapping = None if case.mapping is None else folder / "mapping.yaml"
    found = records(arm, train, [str(test)], mapping, options.thresholds.dataset)
    test.unlink()
    band = next(bands(study_of(arm, found, options)))
    equations = band.equations
    pool = [
        c
        for c in candidates(equations)
        if not c.elastic or not equations.coarse or at_motor(c.joint, equations.rows)
    ]
    fitted = best_forms(fit_pool(pool, Search(System(equations)), HERE))
    unseen = equations.of_record(band.test, band.theta)
    there = [(t, _along(t, unseen, band)) for t in fitted]
    kept = [(t, c) for t, c in there if c is not None and np.isfinite(c).all()]
    trials = [t for t, _ in kept]
    terms = [Term(*t.candidate.place, t.parameters, len(t.values)) for t in trials]
    training = [_record(r, [t.columns[k] for t in trials]) for k, r in enumerate(equations.rows)]
    motion = _motion(unseen, [c for _, c in kept])
    problem = Problem(folder, arm, terms, training, motion)
    forms = {t.candidate.place: t.candidate for t in trials}
    return Asked(problem, band, unseen, unseen.columns @ band.theta, pool, forms)


def best_forms(trials: Sequence[FittedCandidate | None]) -> list[FittedCandidate]:
    """The form of each effect at each place that explains most, in the order of the candidates."""
    best: dict[Place, FittedCandidate] = {}
    for t in trials:
        if t is None or not any(c.any() for c in t.columns):
            continue
        before = best.get(t.candidate.place)
        if before is None or t.gain.delta_bic > before.gain.delta_bic:
            best[t.candidate.place] = t
    return list(best.values())


def _motion(r: Rows, terms: Sequence[Array]) -> Motion:
    p = r.prepared
    q, dq, ddq = (p.picked(x) for x in (p.q, p.dq, p.ddq))
    return Motion(p.time[p.rows], q, dq, ddq, r.moving, r.columns, terms)


def _record(r: Rows, terms: Sequence[Array]) -> Record:
    m = _motion(r, terms)
    return Record(m.time, m.q, m.dq, m.ddq, m.moving, m.own, m.terms, r.effort)


def _along(trial: FittedCandidate, test: Rows, band: Band) -> Array | None:
    """Columns (M, n, k) of a term along the test record; None where it cannot be there."""
    candidate = replace(trial.candidate, absent=frozenset())  # as if a payload of some records is there
    values = {**trial.values, **trial.around}
    found = candidate_columns(candidate, values, band.equations.with_rows([test]), band.base)
    return None if found is None else found[0]


def answered(ask: Asked, by: Method) -> dict[str, Any]:
    """Answer of a method in the form that the judge reads, with its CPU time [s] beyond the equations."""
    begin = time.process_time()
    answer = by.answer(ask.problem)
    spent = time.process_time() - begin
    return {"diagnosis": said(ask, answer), "cpu_s": round(spent, 2)}


def said(ask: Asked, answer: Answer) -> dict[str, Any]:
    """An answer as a diagnosis.

    Errors are RMSE by joint over the moving rows of the test record, in the log's unit. Of what is named the
    aliases are listed as modelgen lists its own: no record can tell them apart.
    """
    if answer.effort.shape != ask.test.effort.shape or not np.isfinite(answer.effort).all():
        raise ValueError(
            f"found efforts of shape {answer.effort.shape}, expected finite ones of {ask.test.effort.shape}"
        )
    places = sorted(answer.named, key=lambda p: (p[0], p[1] or 0))
    known = [ask.forms[place] for place in places if place in ask.forms]
    found = aliases(known, ask.pool, ask.band.equations, ask.band.base) if known else []
    equal = {c.place: dict.fromkeys(o.place for o in same) for c, same in zip(known, found, strict=True)}
    causes = [
        {
            "effect": effect,
            "joint": joint,
            "aliases": [{"effect": e, "joint": j} for e, j in equal.get((effect, joint), ())],
        }
        for effect, joint in places
    ]
    return {
        "verdict": "named" if causes else "nothing_missing",
        "error": {"before": _errors(ask, ask.own), "after": _errors(ask, answer.effort)},
        "causes": causes,
        "suspects": [],
    }


def _errors(ask: Asked, effort: Array) -> list[float]:
    left = (ask.test.effort - effort) * ask.test.gain
    moving = ask.test.moving
    return [
        float(f"{np.sqrt(np.mean(left[m, j] ** 2)):.6g}") if m.any() else 0.0 for j, m in enumerate(moving.T)
    ]
