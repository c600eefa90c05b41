"""An identification from prepared records to parameters, and its validation on other records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.dataset.periods import period_of
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions import Model, Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.consistent import Consistent, consistent
from modelgen.identification.instrumental import Comparison, compared, needed
from modelgen.identification.regression import Array, Regression, Solution
from modelgen.identification.rows import Rows
from modelgen.probing import Prober

METHODS = ("ols", "wls", "robust", "iv")
NEEDED = 2.0  # standard deviations that a parameter of the data's support is away from zero
POOR = 30.0  # % of relative standard deviation from which a parameter is called poorly determined


@dataclass(frozen=True)
class Estimate:
    """A base parameter. std: None where the records do not determine it; essential: they support it."""

    name: str
    value: float
    std: float | None
    unit: str
    essential: bool

    @property
    def relative(self) -> float | None:
        """Standard deviation in % of the value, None without one."""
        return None if self.std is None or not self.value else 100.0 * self.std / abs(self.value)


@dataclass(frozen=True)
class Validation:
    """On test records, by joint, in the unit that the log carried: rmse (n,), nrmse (n,) in % of the effort.

    t: (M,) [s]; measured, predicted: (M, n), records one after the other.
    """

    unit: tuple[str, ...]
    rmse: Array
    nrmse_percent: Array
    t: Array
    measured: Array
    predicted: Array


@dataclass(frozen=True)
class Identification:
    """What the training records say about an arm, and how it does on the test records."""

    arm: Arm
    model: Model
    method: str
    solution: Solution
    estimates: tuple[Estimate, ...]
    test: Validation | None
    consistent: Consistent | None = None
    comparison: Comparison | None = None


def identify(
    train: Sequence[Prepared],
    arm: Arm,
    options: Options | None = None,
    *,
    test: Sequence[Prepared] = (),
    method: str = "wls",
    physical: bool = False,
) -> Identification:
    """Base parameters from `train`, validated on `test`. method: one of METHODS.

    physical: the physically consistent ones closest to those; standard deviations stay those of the others.

    Raises InputError for free motions, an unknown method, and records with too few moving rows.
    """
    if method not in METHODS:
        raise InputError(f"--method: found '{method}', expected {', '.join(METHODS)}")
    options = options or Options()
    model, prober = build_model(arm, options), Prober(reduced(arm, options))
    theta = np.zeros(len(model.grouping.base))
    regression = _regression(prober, model, train, theta)
    count = sum(int(m.sum()) for m in regression.moving)
    if count < 3 * len(theta):
        raise InputError(
            f"{arm.name}: {count} moving rows for {len(theta)} parameters: the records are too short or move "
            "too little, expected at least three times as many; see modelgen excite"
        )
    plain = "wls" if method == "iv" else method
    solution = regression.solve(plain)
    (function,) = [f for f in model.functions if f.name == "regressor"]
    if {"load", "state"} & {a.name for a in function.arguments}:
        # Columns that depend on the load are evaluated anew with the load that was found.
        regression = _regression(prober, model, train, solution.theta)
        solution = regression.solve(plain)
    both = compared(regression, solution, [_rows_in_period(p) for p in train])
    if method == "iv":
        solution = needed(both).solution
    found = concluded(arm, model, prober, method, solution, test, physical=physical)
    return replace(found, comparison=both)


def _rows_in_period(p: Prepared) -> int | None:
    """Rows in a period of the motion; None where it does not repeat, or not on whole rows."""
    samples = period_of(p.record, None)
    whole = samples is not None and samples % p.settings.factor == 0
    return samples // p.settings.factor if whole and samples is not None else None


def concluded(
    arm: Arm,
    model: Model,
    prober: Prober,
    method: str,
    solution: Solution,
    test: Sequence[Prepared],
    *,
    physical: bool,
) -> Identification:
    """Estimates and validation of a solution."""
    found = consistent(model, solution.theta, solution.precision) if physical else None
    theta = solution.theta if found is None else found.base
    needed = essential(solution)
    estimates = tuple(
        Estimate(b.name, float(v), float(np.sqrt(c)) if known else None, b.unit, bool(e))
        for b, v, c, known, e in zip(
            model.grouping.base,
            theta,
            np.maximum(np.diag(solution.covariance), 0.0),
            solution.determined,
            needed,
            strict=True,
        )
    )
    validation = validate(prober, model, test, theta) if test else None
    return Identification(arm, model, method, solution, estimates, validation, found)


def essential(solution: Solution) -> NDArray[np.bool_]:
    """Flags (p,) of the parameters that backward elimination leaves.

    The least significant goes first; the others then take its part over by their covariance.
    """
    theta, v = solution.theta.copy(), solution.covariance.copy()
    left = list(np.flatnonzero(solution.determined & (np.diag(v) > 0)))
    flags = solution.determined.copy()
    while left:
        k = min(left, key=lambda i: theta[i] ** 2 / v[i, i])
        if theta[k] ** 2 >= NEEDED**2 * v[k, k]:
            break
        column, size = v[:, k].copy(), v[k, k]
        theta = theta - column * (theta[k] / size)
        v = v - np.outer(column, column) / size
        flags[k] = False
        left = [i for i in left if i != k and v[i, i] > 0]
    return np.asarray(flags)


def validate(prober: Prober, model: Model, records: Sequence[Prepared], theta: Array) -> Validation:
    """Prediction error on records that were not fitted. Raises InputError for a free motion."""
    regression = _regression(prober, model, records, theta)
    gain = [np.ones(p.effort.shape) if p.gain is None else p.gain[p.rows] for p in records]
    measured = np.concatenate([y * g for y, g in zip(regression.effort, gain, strict=True)])
    wrong = np.concatenate([e * g for e, g in zip(regression.residuals(theta), gain, strict=True)])
    moving = np.concatenate(regression.moving)
    if not moving.any():
        raise InputError(f"{records[0].record.name}: no joint moves in the test records; expected a motion")
    rmse, share = [], []
    for j in range(measured.shape[1]):
        # A joint that rests throughout is judged by all its rows: holding is an effort too.
        rows = moving[:, j] if moving[:, j].any() else np.ones(len(moving), dtype=bool)
        e, y = wrong[rows, j], measured[rows, j]
        rmse.append(float(np.sqrt(np.mean(e**2))))
        share.append(100.0 * float(np.linalg.norm(e)) / max(float(np.linalg.norm(y)), 1e-300))
    t = np.concatenate([p.t for p in records])
    unit = records[0].effort_unit or ("",) * measured.shape[1]
    return Validation(unit, np.array(rmse), np.array(share), t, measured, measured - wrong)


def _regression(prober: Prober, model: Model, records: Sequence[Prepared], theta: Array) -> Regression:
    made = Rows(model, prober)
    rows = [made.of(p, theta) for p in records]
    return Regression([y for y, _ in rows], [made.whole(w) for _, w in rows], [p.moving for p in records])


def verdict(found: Identification) -> str:
    """In words: what is well determined, what is not, what would help."""
    lost = [e.name for e in found.estimates if e.std is None]
    poor = [e.name for e in found.estimates if e.std is not None and (e.relative or np.inf) > POOR]
    good = len(found.estimates) - len(lost) - len(poor)
    text = [f"{good} of {len(found.estimates)} parameters are determined to {POOR:g} % or better."]
    if poor:
        text.append(f"Poorly determined: {', '.join(poor)}.")
    if lost:
        text.append(f"Not determined by these records, set to zero: {', '.join(lost)}.")
    if found.comparison is not None and found.comparison.biased:
        text.append(
            "Errors of the positions bias least squares (test of Durbin, Wu and Hausman)"
            + ("; these are by instruments." if found.method == "iv" else ": use --method iv.")
        )
    if found.consistent is not None:
        wrong = found.consistent.violated
        text.append(
            f"Physically consistent; the plain solution closest to the prior is not: {'; '.join(wrong)}."
            if wrong
            else "Physically consistent, as the plain solution is."
        )
    if poor or lost:
        text.append("Faster motion of the joints they belong to would help; see modelgen excite.")
    return " ".join(text)


def to_json(found: Identification) -> dict[str, Any]:
    """identification.json."""
    test = found.test
    return {
        "schema": 1,
        "arm": found.arm.name,
        "method": found.method,
        "condition_number": found.solution.condition,
        "parameters": [
            {
                "name": e.name,
                "value": e.value,
                "std": e.std,
                "relative_std_percent": e.relative,
                "unit": e.unit,
                "essential": e.essential,
            }
            for e in found.estimates
        ],
        "test": None
        if test is None
        else {
            "unit": ", ".join(dict.fromkeys(test.unit)),
            "rmse": [float(x) for x in test.rmse],
            "nrmse_percent": [float(x) for x in test.nrmse_percent],
        },
        "verdict": verdict(found),
        "least_squares": _least_squares(found.comparison),
        **_physical(found),
    }


def _least_squares(c: Comparison | None) -> dict[str, Any] | None:
    """The test of Durbin, Wu and Hausman; None where no motion repeats."""
    if c is None or not c.degrees:
        return None
    return {
        "biased": c.biased,
        "statistic": c.statistic,
        "degrees": c.degrees,
        "threshold": c.threshold,
    }


def _physical(found: Identification) -> dict[str, Any]:
    """Standard parameters that could exist, and what was wrong with the plain ones."""
    if found.consistent is None:
        return {}
    c = found.consistent
    return {
        "standard_parameters": [
            {"name": p.name, "value": float(x), "unit": p.unit}
            for p, x in zip(found.model.standard, c.standard, strict=True)
        ],
        "consistency": {"plain_solution": list(c.violated), "chi_square_per_parameter": c.distance},
    }
