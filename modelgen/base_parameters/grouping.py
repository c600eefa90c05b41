"""The base parameters of an arm: rules for what they can name, the numeric rank for the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from modelgen.base_parameters.closed_form import Factors, closed_forms
from modelgen.base_parameters.drive_inertia import contained
from modelgen.base_parameters.numeric_rank import rank, regressor_values
from modelgen.base_parameters.objects import BaseParameter, Grouping
from modelgen.base_parameters.printing import printed
from modelgen.base_parameters.rules import Combination, about_foot, composed, passed_on, slid, tidy
from modelgen.description.objects import Arm, Scalar, geometry_symbol
from modelgen.graph import Expr
from modelgen.model.effect_forces import EffectForces
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, base_motion, link_motions
from modelgen.model.regressor import Plan, Regressor
from modelgen.transmission import of_joint

Columns = list[dict[int, Expr]]  # standard index -> {coordinate: effort per unit}


def standard_columns(equations: Equations) -> Columns:
    """Columns of the standard regressor, rows as efforts at the joints, without a search for plans.

    Unlike inputs, efforts do not depend on the units of the motor coordinates.
    """
    rates = Rates(equations.vector("dq"), equations.vector("ddq"))
    frames = equations.frames
    regressor = Regressor(frames, link_motions(frames, rates), base_motion(frames))
    table = regressor.columns([Plan()] * len(equations.arm.joints))
    gains = [drive.k1 * drive.transmission.torque_constant for drive in equations.drives]
    columns: Columns = [column for link in table for column in link]
    effects = EffectForces(equations, rates).columns()
    columns += [{n: e * gains[n] for n, e in column.items()} for column in effects]
    return columns


def group(equations: Equations, row: int | None = None) -> Grouping:
    """The base parameters of the arm that `equations` describe.

    With `row`, those of that coordinate's row alone (each row with parameters of its own scale).
    """
    arm = equations.arm
    moved = slid(arm)
    per_link = equations.per_link
    rules = composed(about_foot(arm, per_link), passed_on(moved, per_link))
    rules += [{k: 1.0} for k in range(len(rules), len(equations.standard))]
    candidates = sorted({k for combination in rules for k in combination})
    settled = _settled(moved, candidates, row)
    return _grouping(
        equations, composed(rules, settled), [k for k in candidates if settled[k] == {k: 1.0}], row
    )


def _settled(arm: Arm, candidates: Sequence[int], row: int | None) -> list[Combination]:
    """Each candidate as a combination of the independent ones, by the numeric oracle."""

    def factors(values: dict[str, float]) -> tuple[tuple[int, ...], Factors]:
        equations = Equations(replace(arm, symbols=values) if values else arm)
        columns = standard_columns(equations)
        chosen = [columns[k] for k in candidates]
        if row is not None:
            chosen = [{n: e for n, e in column.items() if n == row} for column in chosen]
        links = sum(k < equations.per_link * len(arm.joints) for k in candidates)
        result = rank(regressor_values(chosen, equations), links)
        pairs = {
            (candidates[k], candidates[m]): f for k, of in result.dependent.items() for m, f in of.items()
        }
        return tuple(candidates[k] for k in result.kept), pairs

    kept, found = factors(dict(arm.symbols))
    formulas = closed_forms(arm.symbols, lambda values: factors(values)[1], found, _of_mechanisms(arm))
    settled: list[Combination] = [{} for _ in range(max(candidates, default=-1) + 1)]
    for k in kept:
        settled[k] = {k: 1.0}
    for (k, m), factor in formulas.items():
        settled[k][m] = factor
    return settled


def _of_mechanisms(arm: Arm) -> set[str]:
    """Symbols in drives of varying ratio: no factor depends on them, other values may leave no mechanism."""
    varying = (joint.drive for joint in arm.joints if of_joint(arm, joint).varies)
    return set().union(*(drive.free_symbols() for drive in varying))


def _grouping(
    equations: Equations, rules: Sequence[Combination], kept: Sequence[int], row: int | None
) -> Grouping:
    standard = equations.standard
    terms: dict[int, list[tuple[int, Scalar]]] = {k: [] for k in kept}
    without = []
    for k, combination in enumerate(rules):
        if not combination:
            without.append(k)
        for base, factor in combination.items():
            terms[base].append((k, tidy(factor)))
    suffix = "" if row is None else f"_row{row + 1}"
    result = []
    for base in kept:
        ordered = sorted(terms[base], key=lambda term: (term[0] != base, term[0]))
        names = [(standard[k].name, factor) for k, factor in ordered]
        name = standard[base].name + ("R" if len(ordered) > 1 else "") + suffix
        result.append(BaseParameter(name, standard[base].unit, tuple(ordered), printed(names)))
    return Grouping(tuple(result), tuple(without), contained(equations, result))


def base_values(grouping: Grouping, standard: Sequence[float], symbols: dict[str, float]) -> list[float]:
    """Values of the base parameters for values of the standard ones."""
    known = {geometry_symbol(name): value for name, value in symbols.items()}

    def number(factor: Scalar) -> float:
        return float(factor.subs(known)) if isinstance(factor, sp.Expr) else factor

    return [sum(number(f) * standard[k] for k, f in b.terms) for b in grouping.base]


def fluid_remarks(equations: Equations, grouping: Grouping) -> list[str]:
    """Remarks on what a fluid makes identifiable: volumes alone, and those seen only with the mass.

    Gravity sees M - density V, inertia sees M: where a first moment of the mass shows in the inertia
    as well, that of the volume follows from it.
    """
    if not equations.arm.fluid_density:
        return []

    def volume(k: int) -> bool:
        return equations.standard[k].name.startswith("V")

    apart = [b.name for b in grouping.base if volume(b.representative)]
    mixed = [
        b.name for b in grouping.base if not volume(b.representative) and any(volume(k) for k, _ in b.terms)
    ]
    return [
        f"identifiable in the fluid besides those in air: {', '.join(apart) or 'none'}",
        f"mass and displaced volume only together, as gravity sees them: {', '.join(mixed) or 'none'}",
    ]
