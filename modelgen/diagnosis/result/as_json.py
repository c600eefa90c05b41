"""A diagnosis as plain data: diagnosis.json."""

from __future__ import annotations

from typing import Any

import numpy as np

from modelgen.diagnosis.experiment import experiment_json
from modelgen.diagnosis.extended import NamedCause, Positions
from modelgen.diagnosis.result.diagnosis import Diagnosis
from modelgen.diagnosis.selection import Ranked
from modelgen.diagnosis.validation import Check
from modelgen.numeric import Array


def to_json(d: Diagnosis) -> dict[str, Any]:
    """diagnosis.json."""
    fit = d.lack_of_fit
    where = d.lack_of_fit_part
    return {
        "schema": 1,
        "arm": d.arm.name,
        "verdict": d.verdict,
        "reason": d.reason,
        "doubts": list(d.doubts),
        "causes": [_cause(c) for c in d.causes],
        "suspects": [_cause(c) for c in d.suspects],
        "not_identifiable": [{"effect": name, "reason": reason} for name, reason in d.not_identifiable],
        "lack_of_fit": None
        if fit is None
        else {
            "statistic": rounded(fit.statistic),
            "threshold": rounded(fit.threshold),
            "by_joint": numbers(fit.by_joint),
            "periods": fit.periods,
            "test": fit.worst.kind,
            "joint": fit.worst.joint + 1,
            "part": None
            if where is None
            else {"record": where[0], "from_s": rounded(where[1]), "to_s": rounded(where[2])},
        },
        "most_like": None
        if d.likeness is None
        else {"text": d.likeness.shape.text, "delta_bic": rounded(d.likeness.evidence)},
        "error": {
            "unit": d.errors.unit,
            "before": numbers(d.errors.before),
            "after": numbers(d.errors.after),
            "gain_percent": numbers(d.errors.gain),
            "gain_interval_percent": [
                [rounded(a), rounded(b)] for a, b in zip(d.errors.low, d.errors.high, strict=True)
            ],
            "overall_gain_percent": rounded(d.errors.overall),
            "overall_gain_interval_percent": numbers(np.array(d.errors.interval)),
            "with_rest": None if d.identified is None else numbers(d.identified.rmse),
            "by_cause": [
                {
                    "effect": c.effect,
                    "joint": c.joint,
                    "gain_percent": rounded(c.share.gain),
                    "gain_interval_percent": [rounded(c.share.low), rounded(c.share.high)],
                }
                for c in d.causes
            ],
        },
        "simulation": {
            name: {"f_gof": [], "mae": [], "rmse": []}
            if scores is None
            else {"f_gof": numbers(scores.f_gof), "mae": numbers(scores.mae), "rmse": numbers(scores.rmse)}
            for name, scores in zip(("before", "after"), d.simulation, strict=True)
        },
        "drive_inertias": [
            {"joint": number, "value": rounded(e.value), "unit": e.unit} for number, e in d.inertias.items()
        ],
        "next_experiment": experiment_json(d.next_experiment),
        "ranking": [[_rank(r) for r in turn] for turn in d.ranking],
        "positions": None if d.positions is None else _positions(d.positions),
        "log": d.log.to_json(),
        "settings": dict(d.settings),
    }


def _rank(r: Ranked) -> dict[str, Any]:
    return {
        "effect": r.effect,
        "joint": r.joint,
        "delta_bic": rounded(r.delta_bic),
        "cross_gain_percent": None if r.cross_gain is None else rounded(r.cross_gain),
        "expected_gain_percent": None if r.expected_gain is None else rounded(r.expected_gain),
        "chosen": r.chosen,
        "refused": r.refused or None,
    }


def _positions(p: Positions) -> dict[str, Any]:
    test = p.endogeneity
    return {
        "feigned_percent": numbers(p.feigned),
        "durbin_wu_hausman": None
        if test is None
        else {
            "statistic": rounded(test.statistic),
            "threshold": rounded(test.threshold),
            "degrees": test.degrees,
            "share_percent": numbers(test.share),
            "cost_percent": numbers(test.cost),
        },
    }


def _cause(c: NamedCause) -> dict[str, Any]:
    return {
        "effect": c.effect,
        "joint": c.joint,
        "joint_name": c.joint_name,
        **({} if c.records is None else {"records": list(c.records)}),
        "parameters": {
            name: {"value": rounded(e.value), "std": rounded(e.std), "unit": e.unit}
            | ({} if e.separate else {"separate": False})
            for name, e in c.parameters.items()
        },
        "evidence": {
            "delta_bic": rounded(c.delta_bic),
            "cross_gain_percent": rounded(c.cross_gain),
            "expected_gain_percent": rounded(c.expected_gain),
        },
        "aliases": [{"effect": effect, "joint": joint} for effect, joint in c.aliases],
        "ambiguous_with": [
            {"effect": effect, "joint": joint, "delta_bic": rounded(behind)}
            for effect, joint, behind in c.ambiguous_with
        ],
        "checks": [_check(check) for check in c.checks],
    }


def _check(c: Check) -> dict[str, Any]:
    return {
        "name": c.name,
        "passed": c.passed,
        "decides": c.decides,
        "value": rounded(c.value),
        "threshold": rounded(c.threshold),
        "text": c.text,
    }


def rounded(value: float) -> float | None:
    """Six digits; None for what is no number."""
    return float(f"{value:z.6g}") if np.isfinite(value) else None


def numbers(values: Array) -> list[float | None]:
    """A list of rounded numbers."""
    return [rounded(float(v)) for v in values]
