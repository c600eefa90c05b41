"""Values of the parameters that the description's nominal inertials and effects give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from modelgen.base_parameters import Grouping
from modelgen.description.objects import Arm, Inertial
from modelgen.effects import applied_effects
from modelgen.errors import InputError
from modelgen.functions.objects import Model
from modelgen.model.parameters import StandardParameter


def nominal_standard(model: Model) -> dict[str, float]:
    """Nominal standard parameters by name, in the model's order and units. Raises as nominal_values does."""
    return nominal_values(model.arm, model.standard)


def nominal_values(arm: Arm, standard: Sequence[StandardParameter]) -> dict[str, float]:
    """Nominal values of these standard parameters by name, in their order and units.

    A link's tensor and first moments are about the origin of its frame: the parallel-axis theorem
    (Huygens, Steiner) moves the tensor there. Raises InputError for a link without nominal inertials,
    for an effect without a nominal value, and for an arm in a fluid, whose volumes have none.
    """
    values = nominal_links(arm) | _of_effects(arm)
    for p in standard:
        if p.name not in values:
            raise InputError(
                f"{arm.name}: {p.name}, {p.text}, has no nominal value in the description", arm.where
            )
    return {p.name: values[p.name] for p in standard}


def is_nominal(arm: Arm) -> bool:
    """Whether the description gives every link and every effect its nominal values."""
    effects = all(p.name in e.nominal for e in applied_effects(arm) for p, _ in e.parameters)
    return effects and not arm.fluid_density and all(link is not None for link in arm.links)


def nominal_links(arm: Arm) -> dict[str, float]:
    """Nominal standard parameters of the links alone, by name. Raises InputError where a link has none."""
    for i, link in enumerate(arm.links):
        if link is None:
            raise InputError(f"{arm.name}: link {arm.joints[i].name} has no nominal inertials", arm.where)
    return _of_links(arm)


def _of_links(arm: Arm) -> dict[str, float]:
    """Standard parameters, by name, of the links that have nominal inertials."""
    return {
        f"{name}{i + 1}": value
        for i, link in enumerate(arm.links)
        if link is not None
        for name, value in about_origin(link).items()
    }


def _of_effects(arm: Arm) -> dict[str, float]:
    """Standard parameters, by name, of the effects that have nominal values."""
    return {
        symbol.name: effect.nominal[parameter.name]
        for effect in applied_effects(arm)
        for parameter, symbol in effect.parameters
        if parameter.name in effect.nominal
    }


def nominal_base(model: Model) -> dict[str, float]:
    """Nominal base parameters by name, in the order of `parameters`. Raises as nominal_standard does."""
    return grouped(model, list(nominal_standard(model).values()))


def known_base(model: Model) -> dict[str, float]:
    """Nominal base parameters by name, of those alone to which the description gives every part."""
    values = _of_links(model.arm) | _of_effects(model.arm)
    found = grouped(model, [values.get(p.name, np.nan) for p in model.standard])
    return {name: value for name, value in found.items() if np.isfinite(value)}


def grouped(model: Model, standard: Sequence[float]) -> dict[str, float]:
    """Base parameters by name that the standard vector gives, both in the model's order."""
    return base_of(model.grouping, model.arm, standard)


def base_of(grouping: Grouping, arm: Arm, standard: Sequence[float]) -> dict[str, float]:
    """Base parameters by name, in the order of the grouping, that the standard vector gives."""
    return {
        base.name: float(sum(standard[i] * factor_value(factor, arm.symbols) for i, factor in base.terms))
        for base in grouping.base
    }


def base_matrix(model: Model) -> NDArray[np.float64]:
    """K (p, s): base parameters = K standard parameters."""
    result = np.zeros((len(model.grouping.base), len(model.standard)))
    for k, base in enumerate(model.grouping.base):
        for i, factor in base.terms:
            result[k, i] += factor_value(factor, model.arm.symbols)
    return result


def about_origin(link: Inertial) -> Mapping[str, float]:
    """The ten standard parameters of a link by name, about the origin of its frame."""
    m, (x, y, z) = link.mass, link.com
    xx, xy, xz, yy, yz, zz = link.inertia
    return {
        "XX": xx + m * (y * y + z * z),
        "XY": xy - m * x * y,
        "XZ": xz - m * x * z,
        "YY": yy + m * (x * x + z * z),
        "YZ": yz - m * y * z,
        "ZZ": zz + m * (x * x + y * y),
        "MX": m * x,
        "MY": m * y,
        "MZ": m * z,
        "M": m,
    }


def natural_scale(link: Inertial) -> tuple[float, float]:
    """Of a link's mass [kg] and first moments [kg m]: the mass, and its product with the root of the mean
    square distance from the frame's origin.
    """
    spread = 0.5 * (link.inertia[0] + link.inertia[3] + link.inertia[5])
    square = sum(c * c for c in link.com) + (max(0.0, spread) / link.mass if link.mass > 0 else 0.0)
    return link.mass, float(link.mass * square**0.5)


def payload_standard(model: Model, payload: Sequence[float]) -> NDArray[np.float64]:
    """Standard parameters (s,) that a point mass adds. payload: mass [kg] and, if wanted, x, y, z [m].

    It is carried by the last link, in its frame. Raises InputError for a negative mass, or other numbers.
    """
    standard = np.zeros(len(model.standard))
    if not payload:
        return standard
    if len(payload) not in (1, 4):
        raise InputError(f"--payload: found {len(payload)} numbers, expected MASS or MASS,X,Y,Z")
    if not payload[0] >= 0:
        raise InputError(f"--payload: found a mass of {payload[0]:g} kg, expected 0 or more")
    m, x, y, z = (*payload, 0.0, 0.0, 0.0)[:4]
    last = len(model.arm.joints)
    index = {p.name: i for i, p in enumerate(model.standard)}
    for name, value in about_origin(Inertial(m, (x, y, z), (0.0,) * 6)).items():
        standard[index[f"{name}{last}"]] = value
    return standard


def payload_base(model: Model, payload: Sequence[float]) -> NDArray[np.float64]:
    """Base parameters (p,) that a point mass adds."""
    return np.array(list(grouped(model, payload_standard(model, payload).tolist()).values()))


def factor_value(factor: float | sp.Expr, symbols: Mapping[str, float]) -> float:
    """A factor of the grouping with the values of its symbols."""
    if isinstance(factor, sp.Expr):
        factor = factor.subs({symbol: symbols[str(symbol)] for symbol in factor.free_symbols})
    return float(factor)
