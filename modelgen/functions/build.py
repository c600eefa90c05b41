"""All functions of one arm."""

from __future__ import annotations

from modelgen.base_parameters import Grouping, fluid_remarks, group
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm
from modelgen.errors import InputError
from modelgen.functions.assembly import Assembly
from modelgen.functions.batch import batch_names
from modelgen.functions.combined import combined_functions
from modelgen.functions.derivatives import derivative_functions, row_wise_derivatives
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.kinematic import kinematic_functions
from modelgen.functions.levels import levels
from modelgen.functions.nominal import base_of, nominal_values
from modelgen.functions.objects import Function, Levels, Model
from modelgen.functions.options import EVALUATED, Options, prepared
from modelgen.functions.parametric import (
    base_values,
    folded_values,
    parametric_functions,
    row_wise_functions,
    standard_values,
)
from modelgen.functions.regressors import regressor_functions
from modelgen.functions.watch import watch_functions
from modelgen.model.equations import Equations

DEFAULTS = Options()
REMEMBERED = 2  # models that are evaluated, of the arms that were asked for last
_recent: list[tuple[Arm, Model]] = []  # an arm has no hash: it is found by its identity


def build_model(arm: Arm, options: Options = DEFAULTS) -> Model:
    """The functions of `arm` as programs, with its parameters and their grouping.

    Raises InputError for an effect that does not exist or lacks a value, for an unknown link of the
    Jacobian, for identified values that are not those of the base parameters, and for nominal ones that
    the description does not give.
    """
    if options != EVALUATED:
        return _built(arm, options)
    for known, model in _recent:
        if known is arm:
            return model
    model = _built(arm, options)
    _recent.append((arm, model))
    del _recent[:-REMEMBERED]
    return model


def _built(arm: Arm, options: Options) -> Model:
    arm = prepared(arm, options)
    real = Equations(arm, options.runtime_geometry, options.sincos)
    base = Equations(slid(arm), options.runtime_geometry, options.sincos)
    plain = Equations(arm)
    rows = [group(plain, row) for row in range(plain.n)] if options.gains == "row_wise" else []
    grouping = _stacked(rows) if rows else group(plain)
    a = Assembly(options, real, base, grouping)
    functions: list[Function] = []
    given = {"": ["parameters"], "_standard": ["standard_parameters"], "_identified": [], "_nominal": []}
    dynamics: dict[str, Dynamics] = {}
    if rows:
        functions += row_wise_functions(a, rows)
    else:
        dynamics[""] = Dynamics(base, base_values(base, grouping))
        functions += parametric_functions(a, dynamics[""], "", given[""])
    regressors, packed = regressor_functions(a, _representatives(a.n, grouping, rows))
    functions += regressors
    dynamics["_standard"] = Dynamics(real, standard_values(real))
    functions += parametric_functions(a, dynamics["_standard"], "_standard", given["_standard"])
    if options.identified:
        _check(arm.name, options, grouping)
        dynamics["_identified"] = Dynamics(base, folded_values(base, grouping, options.identified))
        functions += parametric_functions(a, dynamics["_identified"], "_identified", [])
    nominal = _nominal(options, real, grouping)
    if nominal:
        dynamics["_nominal"] = Dynamics(base, folded_values(base, grouping, nominal))
        functions += parametric_functions(a, dynamics["_nominal"], "_nominal", [])
    functions += kinematic_functions(a)
    if options.derivatives:
        functions += row_wise_derivatives(a, rows)
        for suffix in [suffix for suffix in given if suffix in dynamics]:
            functions += derivative_functions(a, dynamics[suffix], suffix, given[suffix])
    if options.watch:
        whole = {suffix: dynamics[suffix] for suffix in given if suffix in dynamics}
        folded = {"_identified": options.identified, "_nominal": nominal}
        functions += watch_functions(a, whole, given, folded)
    if options.combined:
        functions += combined_functions(arm, functions)
    return Model(
        arm,
        real.standard,
        grouping,
        tuple(functions),
        packed,
        tuple(arm.symbols) if options.runtime_geometry else (),
        tuple(real.state_names()),
        tuple(nominal.values()),
        _levels(a, options),
        batch_names(arm.name, options.batch, functions),
        (*fluid_remarks(plain, grouping), *_gain_remarks(options, arm)),
    )


def _levels(a: Assembly, options: Options) -> Levels | None:
    """Where there is noise to set them by."""
    if options.noise is None or not options.identified or not options.watch:
        return None
    return levels(a, options.noise, [options.identified[b.name] for b in a.grouping.base])


def _gain_remarks(options: Options, arm: Arm) -> list[str]:
    """Remarks on what the mode of the drive gains means for the parameters."""
    driven = [f"gamma{n + 1}" for n, i in enumerate(arm.coordinates) if arm.joints[i].drive.driven]
    if options.gains == "estimated" and driven:
        return [
            f"estimated gains: {', '.join(driven)}, true over described torque constant, join the parameters",
            "their common scale needs a run with a known payload; the functions are those of known gains",
        ]
    if options.gains == "row_wise":
        return [
            "row-wise gains: each row has parameters of its own scale",
            "mass_matrix, forward_dynamics and energy exist for standard parameters only",
        ]
    return []


def _nominal(options: Options, equations: Equations, grouping: Grouping) -> dict[str, float]:
    """Nominal values of the base parameters where they are asked for, else none."""
    if not options.nominal:
        return {}
    if options.gains == "row_wise":
        raise InputError("--nominal: nominal parameters cannot be folded in with row-wise gains")
    values = nominal_values(equations.arm, equations.standard)
    return base_of(grouping, equations.arm, list(values.values()))


def _stacked(rows: list[Grouping]) -> Grouping:
    """The rows' base parameters one after the other."""
    without = set(rows[0].without_effect).intersection(*(row.without_effect for row in rows))
    return Grouping(tuple(b for row in rows for b in row.base), tuple(sorted(without)))


def _representatives(n: int, grouping: Grouping, rows: list[Grouping]) -> list[list[int]]:
    """For every row of the regressor, its columns' standard parameters; -1 where the row has none."""
    if not rows:
        return [[base.representative for base in grouping.base]] * n
    table = []
    for own in range(n):
        table.append([b.representative if k == own else -1 for k, row in enumerate(rows) for b in row.base])
    return table


def _check(arm: str, options: Options, grouping: Grouping) -> None:
    expected = [base.name for base in grouping.base]
    missing = [name for name in expected if name not in options.identified]
    extra = [name for name in options.identified if name not in expected]
    if options.gains == "row_wise":
        raise InputError("identified parameters cannot be folded in with row-wise gains")
    if missing or extra:
        what = [f"missing {', '.join(missing)}"] if missing else []
        what += [f"unknown {', '.join(extra)}"] if extra else []
        raise InputError(
            f"{arm}: identified parameters do not fit the arm: {'; '.join(what)}; expected those of modelgen "
            "identify for this description"
        )
