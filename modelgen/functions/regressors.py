"""Functions that give the regressor: linear in the parameters, which they do not need."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.functions.arguments import input_units
from modelgen.functions.assembly import Assembly
from modelgen.functions.objects import Function, Output, SparsityTable
from modelgen.functions.regressor_plans import Choice, LinkColumns
from modelgen.graph import Expr
from modelgen.model.effect_forces import EffectForces
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates

Columns = list[dict[int, Expr]]  # {coordinate: input per unit of the parameter}


def input_columns(
    e: Equations, rates: Rates, needed: Sequence[int], choice: Choice | None = None
) -> tuple[Columns, Choice]:
    """Columns of the standard parameters `needed`, rows in the unit of the input, and how it was done.

    `choice` repeats how an equal set of columns was computed for another motion.
    """
    links = e.per_link * len(e.arm.joints)
    link_columns = LinkColumns(e, rates, [k for k in needed if k < links])
    choice = choice or link_columns.cheapest()
    bodies = link_columns.columns(choice)
    effects = EffectForces(e, rates).columns()
    return [bodies[k] if k < links else effects[k - links] for k in needed], choice


def regressor_functions(a: Assembly, rows: Sequence[Sequence[int]]) -> tuple[list[Function], SparsityTable]:
    """The regressor in its four forms and the places of the packed one.

    rows: per coordinate, the base parameters' representatives in the order of the columns; -1 where a
    column belongs to another row (row-wise gains).
    """
    base, real = a.base, a.real
    motion = Rates(base.vector("dq"), base.vector("ddq"))
    reference = Rates(base.vector("dq"), base.vector("ddq_r"), base.vector("dq_r"))
    columns, choice = _by_rows(base, motion, rows)
    adaptive, _ = _by_rows(base, reference, rows, choice)
    real_motion = Rates(real.vector("dq"), real.vector("ddq"))
    standard, _ = input_columns(real, real_motion, range(len(real.standard)))
    places = [(n, k) for n in range(a.n) for k, column in enumerate(columns) if _present(column, n)]
    table = SparsityTable(tuple(n for n, _ in places), tuple(k for _, k in places))
    unit = f"{input_units(base)} per unit of the parameter"
    packed = Output("matrix", len(places), 1, unit, "structural non-zeros, row after row")
    inputs = ["q", "dq", "ddq"]
    by_column = sorted(range(len(places)), key=lambda i: places[i][::-1])
    functions = [
        _matrix(a, base, "regressor", "Inputs per unit of each base parameter.", inputs, columns, unit),
        _matrix(
            a,
            real,
            "regressor_standard",
            "Inputs per unit of each standard parameter.",
            inputs,
            standard,
            unit,
        ),
        a.function(
            "regressor_packed",
            "Structural non-zeros of the regressor.",
            inputs,
            [(packed, [columns[k][n] for n, k in places])],
            order=[("matrix", i) for i in by_column],
        ),
        _matrix(
            a,
            base,
            "slotine_li_regressor",
            "Regressor of M ddq_r + C dq_r + g + friction, with dM/dt - 2 C skew-symmetric.",
            ["q", "dq", "dq_r", "ddq_r"],
            adaptive,
            unit,
        ),
    ]
    return functions, table


def _present(column: dict[int, Expr], n: int) -> bool:
    return n in column and not column[n].is_zero


def _by_rows(
    e: Equations, rates: Rates, rows: Sequence[Sequence[int]], choice: Choice | None = None
) -> tuple[Columns, Choice]:
    """Columns of which each row shows those that `rows` gives it."""
    needed = sorted({k for row in rows for k in row if k >= 0})
    values, choice = input_columns(e, rates, needed, choice)
    found = dict(zip(needed, values, strict=True))
    columns: Columns = [{} for _ in rows[0]]
    for n, row in enumerate(rows):
        for place, k in enumerate(row):
            if k >= 0 and n in found[k]:
                columns[place][n] = found[k][n]
    return columns, choice


def _matrix(
    a: Assembly, e: Equations, name: str, text: str, inputs: Sequence[str], columns: Columns, unit: str
) -> Function:
    """A dense n x len(columns) matrix, computed column after column."""
    count = len(columns)
    zero = e.graph.zero
    flat = [columns[k].get(n, zero) for n in range(a.n) for k in range(count)]
    order = [("matrix", n * count + k) for k in range(count) for n in range(a.n)]
    output = Output("matrix", a.n, count, unit, f"{text[0].lower()}{text[1:-1]}")
    return a.function(name, text, inputs, [(output, flat)], order=order)
