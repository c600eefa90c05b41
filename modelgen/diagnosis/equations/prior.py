"""The description tells of base parameters before any record, and is believed up to a point.

Two causes that look alike often differ in what they make of the links: the wrong one needs a link that weighs
what nobody would have drawn. Nominal inertials are off, by some per cent or by tens of them, and nobody says
by how much: they count as measurements of the base parameters whose common scatter is unknown, and about
`nominal_scatter` at first (a multivariate t distribution; Lange, Little and Taylor 1989). That guess is worth
as much as they are, `min_nominal_weight` at least: a description that the records contradict loses its word,
and one link that is not as described cannot outvote the records.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from modelgen.description.objects import Arm
from modelgen.diagnosis.options.thresholds import EquationThresholds
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.functions.nominal import base_matrix, factor_value, natural_scale, nominal_links
from modelgen.numeric import Array

NOTHING = 1e-9  # of the largest scatter: less is rounding


@dataclass(frozen=True)
class NominalPrior:
    """Equations rows @ base parameters = right, each with scatter 1. rows: (k, p), right: (k,). least: number
    of measurements that the expected scatter is worth at least.
    """

    rows: Array
    right: Array
    least: float

    def scatter(self, base: Array) -> float:
        """How far base parameters (p,) are from what is given of them, root mean square; 1 is expected."""
        left = self.rows @ base - self.right
        return float(np.sqrt((self.least + left @ left) / (self.least + len(left))))


def told(model: Model, limits: EquationThresholds) -> NominalPrior | None:
    """Of the links; what drives and effects have is not given, nor what a link has nothing of. None where a
    link has no inertials.
    """
    try:
        known = nominal_links(model.arm)
    except InputError:
        return None
    size = _sizes(model.arm)
    known = {name: value for name, value in known.items() if size[name] > 0.0}
    factors = base_matrix(model)
    of_links = np.array([p.name in known for p in model.standard], dtype=bool)
    names = [p.name for p in model.standard if p.name in known]
    links, others = factors[:, of_links], factors[:, ~of_links]
    places = np.flatnonzero(links.any(axis=1))
    if not len(places):
        return None
    links, others = links[places], others[places]
    # combinations that no drive and no effect has a part in
    kept = null_space(others.T) if others.any() else np.eye(len(places))
    scatter = kept.T @ links * np.array([limits.nominal_scatter * size[name] for name in names])
    u, s, _ = np.linalg.svd(scatter, full_matrices=False)
    there = s > NOTHING * s.max(initial=0.0)
    if not there.any():
        return None
    turned = (u[:, there] / s[there]).T @ kept.T
    rows = np.zeros((len(turned), len(factors)))
    rows[:, places] = turned
    right = turned @ (links @ np.array([known[name] for name in names]))
    return NominalPrior(rows, right, limits.min_nominal_weight)


def _sizes(arm: Arm) -> dict[str, float]:
    """Sizes of the links' standard parameters by name: mass, mass times radius, and that times radius."""
    found: dict[str, float] = {}
    for i, link in enumerate(arm.links, start=1):
        if link is None:
            continue
        mass, first = natural_scale(link)
        second = first * first / mass if mass > 0 else 0.0
        found[f"M{i}"] = mass
        found |= {f"M{a}{i}": first for a in "XYZ"}
        found |= {f"{a}{i}": second for a in ("XX", "XY", "XZ", "YY", "YZ", "ZZ")}
    return found


@dataclass(frozen=True)
class Unknowns:
    """Base parameters = fixed + lift theta. fixed: (p,); lift: (p, k), for k unknowns. said: what the
    description tells of unknown ones.
    """

    fixed: Array
    lift: Array
    said: NominalPrior | None = None

    def base(self, theta: Array) -> Array:
        """Base parameters (p,) of the unknowns (k,)."""
        return np.asarray(self.fixed + self.lift @ theta)


def estimated(model: Model, limits: EquationThresholds) -> Unknowns:
    """Every base parameter is unknown."""
    p = len(model.grouping.base)
    return Unknowns(np.zeros(p), np.eye(p), told(model, limits))


def held(model: Model) -> Unknowns:
    """Links as the description has them, effects unknown. Raises InputError where a link has no inertials."""
    try:
        known = nominal_links(model.arm)
    except InputError as error:
        raise InputError(
            f"{error.message}: the records have no effort column, and a free motion shows ratios of "
            "parameters alone; give `links` in the description, or a log with i<n> or tau<n>",
            error.where,
        ) from error
    symbols, base = model.arm.symbols, model.grouping.base
    fixed = np.zeros(len(base))
    unknown: dict[int, Array] = {}
    for k, parameter in enumerate(base):
        for i, factor in parameter.terms:
            value = factor_value(factor, symbols)
            name = model.standard[i].name
            if name in known:
                fixed[k] += value * known[name]
            else:
                unknown.setdefault(i, np.zeros(len(base)))[k] = value
    lift = np.column_stack([unknown[i] for i in sorted(unknown)]) if unknown else np.zeros((len(base), 0))
    return Unknowns(fixed, lift)
