"""Equations on which thresholds of the diagnosis are tried: those of an arm, or some that are all known."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
from diagnosis_support import ARM, coarse, equations_of, made, offset, record

from modelgen.dataset import Record
from modelgen.diagnosis.candidates import FittedCandidate
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.equations import Band, Equations, bands, study_of
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.options import Options, Thresholds
from modelgen.errors import InputError
from modelgen.numeric import Array

Seen = Callable[[Thresholds], Any]


def refusal(act: Callable[[], Any]) -> Any:
    """What it returns, or the sentence by which it refuses."""
    try:
        return act()
    except InputError as error:
        return str(error)


@cache
def logs(*, fine: bool = True) -> tuple[Record, ...]:
    """Two training records and a test record of the bench, with Coulomb friction's columns and no more."""
    found = tuple(record(None, 1, 0.0, k, f"r{k}") for k in range(3))
    return found if fine else tuple(coarse(r) for r in found)


@cache
def band(*, fine: bool = True) -> Band:
    return next(bands(study_of(ARM, logs(fine=fine), Options(cutoff=18.0))))


def real(limits: Thresholds, *, fine: bool = True) -> Equations:
    """Equations of the bench."""
    return replace(band(fine=fine).equations, thresholds=limits)


def known(limits: Thresholds, force: Any = offset, seed: int = 0, *, repeat: bool = True) -> Equations:
    """Equations of one joint of which all is known."""
    rows, _, periods = made(force, seed)
    return replace(equations_of(rows, periods if repeat else None), thresholds=limits)


def law(equations: Equations, column: Any, effect: str = "friction_offset") -> FittedCandidate:
    """A candidate with this column of the first column of the equations."""
    columns = [column(r.columns[:, 0, 0])[:, None, None] for r in equations.rows]
    gain = System(equations).gain(columns)
    assert gain is not None
    return FittedCandidate(Candidate(effect, 1), {}, columns, gain)


def with_columns(equations: Equations, trial: FittedCandidate) -> list[Array]:
    """Columns (M, n, p) of the equations with those of a candidate."""
    pairs = zip(equations.rows, trial.columns, strict=True)
    return [np.concatenate([r.columns, c], axis=2) for r, c in pairs]


def valued(delta_bic: float, effect: str = "friction_offset", joint: int | None = 1, **more: Any) -> Any:
    """A candidate of which no more than its evidence is asked."""
    gain = SimpleNamespace(delta_bic=delta_bic, rank=more.pop("rank", 2), values=np.ones(1))
    return FittedCandidate(Candidate(effect, joint), more, [], gain)  # type: ignore[arg-type]
