"""Which of the base parameters the records are fitted with, and which are known before.

With measured efforts all are unknown, and what the description says of the links is evidence besides. A free
motion has no effort to give its equations a scale: the links' parameters are then the nominal ones of the
description, and those of the effects are unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.told import Told, told
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.functions.nominal import factor_value, nominal_links
from modelgen.numeric import Array


@dataclass(frozen=True)
class Baseline:
    """Base parameters = fixed + lift theta. fixed: (p,); lift: (p, k), for k unknowns. said: what the
    description tells of unknown ones.
    """

    fixed: Array
    lift: Array
    said: Told | None = None

    def base(self, theta: Array) -> Array:
        """Base parameters (p,) of the unknowns (k,)."""
        return np.asarray(self.fixed + self.lift @ theta)


def estimated(model: Model) -> Baseline:
    """Every base parameter is unknown."""
    p = len(model.grouping.base)
    return Baseline(np.zeros(p), np.eye(p), told(model))


def held(model: Model) -> Baseline:
    """Links as the description has them, effects unknown. Raises InputError where a link has no inertials."""
    try:
        known = nominal_links(model)
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
    return Baseline(fixed, lift)
