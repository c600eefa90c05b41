"""Inertia of drives that the arm's parameters hold with that of their links.

The links' share decides what a spring of some stiffness does, and no rigid model's parameter tells it. Where
the description gives a drive none, the drive's is what was identified of both beyond the links' nominal
inertials.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from modelgen.effects import CATALOGUE
from modelgen.effects.placement import Found
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.functions.nominal import factor_value, nominal_links
from modelgen.numeric import Array


def hidden_inertias(model: Model, base: Array, joints: Collection[int], least: float) -> dict[int, float]:
    """Inertia of the drives of `joints` (coordinates from 1), at the motor.

    base: parameters (p,). Of those alone that base parameters of links contain, and that the description
    leaves without a value; none where links have no nominal inertials, or these leave to the drive, or to the
    link, less than the share `least`.
    """
    try:
        known = nominal_links(model.arm)
    except InputError:
        return {}
    symbols = model.arm.symbols
    found = {}
    for drive in model.grouping.drives:
        number = model.arm.coordinates.index(drive.joint) + 1
        if number not in joints or drive.nominal is not None:
            continue
        terms = {model.standard[k].name: factor for k, factor in model.grouping.base[drive.base].terms}
        factor = factor_value(terms.pop(drive.name), symbols)
        if not terms.keys() <= known.keys():
            continue
        links = sum(known[name] * factor_value(f, symbols) for name, f in terms.items())
        whole = float(base[drive.base])
        if least * whole < links < (1.0 - least) * whole:
            found[number] = float(f"{(whole - links) / factor:.9g}")
    return found


def described_by(values: Mapping[int, float]) -> list[Found]:
    """Inertia of drives by coordinate (from 1) as what a description is extended by."""
    rotor = next(effect for effect in CATALOGUE.values() if effect.of_rotor)
    (inertia,) = rotor.linear
    return [(rotor.name, number, {inertia.name: value}) for number, value in values.items()]
