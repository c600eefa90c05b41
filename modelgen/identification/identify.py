"""An identification from prepared records to parameters, and its validation on other records."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from modelgen.dataset import Prepared
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.evaluation.link_encoder import compliant
from modelgen.functions import Model, Options, build_model
from modelgen.functions.nominal import payload_base
from modelgen.functions.options import prepared as reduced
from modelgen.identification.by_load import fitted_by_load, slopes_of
from modelgen.identification.consistent import consistent
from modelgen.identification.essential import essential, only, part, refit
from modelgen.identification.gains import Gain, estimated, with_gains
from modelgen.identification.instrumental import Comparison, compared
from modelgen.identification.objects import Estimate, Identification, Validation
from modelgen.identification.reading_errors import with_reading_errors
from modelgen.identification.validation import regression_of, rows_in_period, validate
from modelgen.numeric import Array
from modelgen.regression.instruments import Instrument, of_period
from modelgen.regression.least_squares import Regression, Solution

METHODS = ("ols", "wls", "gls", "robust", "iv")
INSTRUMENTS = ("auto", "period", "simulated")
TURNS = 5  # of simulation and estimate, at most
SETTLED = 0.1  # standard deviations by which a turn may move a parameter yet

# The motion that a model makes of a record: base parameters by name to the same rows without its errors.
Simulated = Callable[[Prepared, Mapping[str, float]], Prepared]


@dataclass(frozen=True)
class Instruments:
    """Source of the instruments. source: one of INSTRUMENTS. simulated: of the model under control.

    "auto" takes other periods where the motion repeats, and for the method "iv" the simulation else.
    """

    source: str = "auto"
    simulated: Simulated | None = None


ROUNDS = 12  # of parameters and the states that follow from them
CLOSE = 1e-4  # of every parameter, by which the last turn changes it
RUNS_AWAY = (
    "elastic joints or play swing beyond all bounds along this motion with the parameters that are found; "
    "are their described values right?"
)


def identify(
    train: Sequence[Prepared],
    arm: Arm,
    options: Options | None = None,
    *,
    test: Sequence[Prepared] = (),
    method: str = "wls",
    physical: bool = False,
    instruments: Instruments | None = None,
    essential_only: bool = False,
    payloads: Mapping[int, Sequence[float]] | None = None,
) -> Identification:
    """Base parameters from `train`, validated on `test`. method: one of METHODS.

    physical: the physically consistent ones closest to those; standard deviations stay those of the others.
    essential_only: the others are left out of the fit. payloads: mass [kg] and, if wanted, x, y, z [m] of a
    point that the last link carries in a record, by number in `train` followed by `test`. With the gains
    "estimated" of the options they give the torque constants too.

    Raises InputError for free motions, an unknown method, and records with too few moving rows.
    """
    if method not in METHODS:
        raise InputError(f"--method: found '{method}', expected {', '.join(METHODS)}")
    options = options or Options()
    _refuse(options, method, physical=physical, payloads=bool(payloads))
    known = options.evaluated
    if options.gains == "estimated":
        known = replace(known, gains="known")
    model, evaluator = build_model(arm, known), Evaluator(reduced(arm, known))
    carried = payloads or {}
    added = [payload_base(model, carried.get(k, ())) for k in range(len(train) + len(test))]
    plain = "wls" if method == "iv" else method
    gains: tuple[Gain, ...] = ()
    if options.gains == "estimated":
        solution, gains = _with_gains(train, evaluator, model, added, plain, essential_only=essential_only)
        arm = with_gains(arm, gains)
        model, evaluator = build_model(arm, known), Evaluator(reduced(arm, known))
        found = concluded(arm, model, evaluator, method, solution, test, physical=physical, added=added)
        return replace(found, gains=gains)
    regression, solution = _fitted(train, evaluator, model, added, plain)
    if essential_only:
        solution = only(regression, solution, plain)
    both = _by_instruments(
        train, model, evaluator, regression, solution, instruments or Instruments(), wanted=method == "iv"
    )
    if method == "iv":
        if both is None:
            raise InputError(
                "--method iv: found no motion that repeats, expected two identical periods or more in a "
                "record (see modelgen excite), or --instrument simulated"
            )
        solution = both.solution
    solution = with_reading_errors(solution, regression, train, model, evaluator, added)
    found = concluded(arm, model, evaluator, method, solution, test, physical=physical, added=added)
    return replace(found, comparison=both)


def _refuse(options: Options, method: str, *, physical: bool, payloads: bool) -> None:
    """Raises InputError for what does not go together."""
    if options.gains == "row_wise":
        for name, asked in (("--consistent", physical), ("--payload", payloads)):
            if asked:
                raise InputError(f"--gains row_wise: rows have no common scale, which {name} needs")
    if options.gains == "estimated" and method == "iv":
        raise InputError("--gains estimated: found --method iv, expected ols, wls, gls or robust")


def _columns_by_load(model: Model) -> bool:
    """Whether columns of the regressor depend on the parameters, by loads or states."""
    return model.function("regressor").reads("load", "state")


def errors_of(
    train: Sequence[Prepared], test: Sequence[Prepared], model: Model, evaluator: Evaluator
) -> tuple[Solution, Validation]:
    """The model fitted to `train` as `identify` does it by default, and its errors on `test`.

    Raises InputError.
    """
    _, solution = _fitted(train, evaluator, model, None, "wls")
    return solution, validate(evaluator, model, test, solution.theta)


def _fitted(
    train: Sequence[Prepared],
    evaluator: Evaluator,
    model: Model,
    added: Sequence[Array] | None,
    method: str,
) -> tuple[Regression, Solution]:
    """Rows and least squares. Columns that depend on the load follow the load as it is found."""
    theta = np.zeros(len(model.grouping.base))
    # noise that joints share is shared by whole rows alone
    whole = method == "gls"
    regression = regression_of(evaluator, model, train, theta, added, all_samples=whole)
    enough(model.arm, regression)
    solution = regression.solve(method)
    # what elastic joints add follows from the parameters, and these from that
    turns = ROUNDS if compliant(model.arm) else int(_columns_by_load(model))
    for _ in range(turns):
        before = solution.theta
        regression = regression_of(evaluator, model, train, before, added, all_samples=whole)
        try:
            solution = regression.solve(method)
        except FloatingPointError:
            raise InputError(f"{train[0].record.name}: {RUNS_AWAY}") from None
        if np.allclose(solution.theta, before, rtol=CLOSE):
            break
    if compliant(model.arm) or _columns_by_load(model):
        more = [theta] * len(train) if added is None else added
        regression, solution = fitted_by_load(
            lambda at: regression_of(evaluator, model, train, at, added, all_samples=whole),
            partial(slopes_of, evaluator, model, train, more),
            solution,
            method,
        )
    return regression, solution


def _with_gains(
    train: Sequence[Prepared],
    evaluator: Evaluator,
    model: Model,
    added: Sequence[Array],
    method: str,
    *,
    essential_only: bool,
) -> tuple[Solution, tuple[Gain, ...]]:
    """Parameters and torque constants; what a payload takes stays in the effort."""
    theta = np.zeros(len(model.grouping.base))
    for _ in range(2 if _columns_by_load(model) else 1):
        regression = regression_of(evaluator, model, train, theta)
        enough(model.arm, regression)
        carried = [c @ more for c, more in zip(regression.columns, added, strict=False)]
        solution, gains = estimated(model.arm, regression, carried, method)
        theta = solution.theta
    if essential_only:
        # Each elimination finds the gains anew.
        solution = refit(
            solution, lambda kept: estimated(model.arm, part(regression, kept), carried, method)[0]
        )
        gains = estimated(model.arm, part(regression, solution.determined), carried, method)[1]
    return solution, gains


def enough(arm: Arm, regression: Regression) -> None:
    """Raises InputError for records with fewer moving rows than three per parameter."""
    count = sum(int(m.sum()) for m in regression.moving)
    size = regression.columns[0].shape[2]
    if count < 3 * size:
        raise InputError(
            f"{arm.name}: {count} moving rows for {size} parameters: the records are too short or move "
            "too little, expected at least three times as many; see modelgen excite"
        )


def _by_instruments(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    regression: Regression,
    least: Solution,
    given: Instruments,
    *,
    wanted: bool,
) -> Comparison | None:
    """Least squares beside instruments; None where there are none."""
    if given.source not in INSTRUMENTS:
        raise InputError(f"--instrument: found '{given.source}', expected {', '.join(INSTRUMENTS)}")
    if given.source != "simulated":
        periods = [rows_in_period(p) for p in train]
        found = compared(
            regression,
            least,
            [
                None if period is None else of_period(table, moving, period)
                for table, moving, period in zip(regression.columns, regression.moving, periods, strict=True)
            ],
        )
        if found is not None or given.source == "period" or not wanted:
            return found
    if given.simulated is None:
        return None
    names = [b.name for b in model.grouping.base]
    theta, found = least.theta, None
    for _ in range(TURNS):
        motions = [given.simulated(p, dict(zip(names, theta.tolist(), strict=True))) for p in train]
        # of the same samples
        motions = [replace(m, awake=p.awake) for m, p in zip(motions, train, strict=True)]
        made = regression_of(evaluator, model, motions, theta)
        instruments = [Instrument(c, m) for c, m in zip(made.columns, made.moving, strict=True)]
        found = compared(regression, least, instruments)
        if found is None:
            break
        spread = np.sqrt(np.maximum(np.diag(found.solution.covariance), 0.0))
        moved = np.abs(found.solution.theta - theta)
        theta = found.solution.theta
        if (moved <= SETTLED * spread).all():
            break
    return None if found is None else replace(found, simulated=True)


def concluded(
    arm: Arm,
    model: Model,
    evaluator: Evaluator,
    method: str,
    solution: Solution,
    test: Sequence[Prepared],
    *,
    physical: bool,
    added: Sequence[Array] = (),
) -> Identification:
    """Estimates and validation of a solution. added: base parameters of payloads, those of `test` last."""
    found = consistent(model, solution.theta, solution.precision) if physical else None
    theta: Array = solution.theta if found is None else found.base
    spread = np.sqrt(np.maximum(np.diag(solution.covariance), 0.0))
    values = estimates_of(model, theta, np.where(solution.determined, spread, np.nan))
    estimates = tuple(
        replace(e, essential=bool(flag) and not dropped, dropped=bool(dropped))
        for e, flag, dropped in zip(values, essential(solution), solution.dropped, strict=True)
    )
    carried = added[len(added) - len(test) :] if added else None
    validation = validate(evaluator, model, test, theta, carried) if test else None
    return Identification(arm, model, method, solution, estimates, validation, found)


def estimates_of(model: Model, theta: Array, spread: Array) -> tuple[Estimate, ...]:
    """Estimates of base parameters theta (p,). spread: (p,) standard deviations, not a number where none is
    known.
    """
    given = zip(model.grouping.base, theta, spread, joints_of(model), strict=True)
    return tuple(
        Estimate(
            b.name,
            float(value),
            float(std) if np.isfinite(std) else None,
            b.unit,
            essential=True,
            joint=joint,
            standard=model.standard[b.representative].name,
        )
        for b, value, std, joint in given
    )


def joints_of(model: Model) -> list[int]:
    """Number of the last coordinate whose row contains each base parameter, (p,)."""
    last = [0] * len(model.grouping.base)
    for row, column in zip(model.packed.rows, model.packed.columns, strict=True):
        last[column] = max(last[column], row + 1)
    return last
