"""Inertia of drives that base parameters contain together with their links'.

No motion of a rigid arm tells the inertia of a first joint's drive from that of its link: the grouping adds
them. An elastic joint moves one against the other, so that its equations need both: the description's
nominal value of `drive_inertia` then says what is the drive's.
"""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.base_parameters.objects import BaseParameter, Contained
from modelgen.model.equations import Equations


def contained(equations: Equations, base: Sequence[BaseParameter]) -> tuple[Contained, ...]:
    """All of the arm's."""
    result = []
    for effect in equations.effects:
        if not effect.effect.of_rotor or effect.joint is None:
            continue
        ((parameter, symbol),) = effect.parameters
        nominal = effect.nominal.get(parameter.name)
        result += [
            Contained(effect.joint, symbol.name, place, factor, nominal)
            for place, b in enumerate(base)
            for k, factor in b.terms
            if equations.standard[k].name == symbol.name and k != b.representative
        ]
    return tuple(result)
