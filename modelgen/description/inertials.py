"""Nominal inertials of links, and whether a body can have them."""

from __future__ import annotations

import numpy as np

from modelgen.description.context import Context
from modelgen.description.document import Steps
from modelgen.description.objects import Inertial
from modelgen.description.schema import LinkModel

# Published figures are rounded; relative to the trace of the inertia.
TOLERANCE = 1e-6


def read_inertial(context: Context, model: LinkModel, steps: Steps) -> Inertial:
    """Mass [kg], centre of mass [m], inertia about it [kg m^2]. Raises InputError if no body has them.

    The principal moments of a body are not negative, and none exceeds the sum of the other two
    (Traversaro et al., 2016); a body without mass has no inertia. With `as_given` nothing but the mass is
    checked.
    """
    mass = context.number(model.mass, "plain", [*steps, "mass"])
    com = context.numbers(model.com, "length", [*steps, "com"])
    inertia = context.numbers(model.inertia, "plain", [*steps, "inertia"])
    at = [*steps, "inertia"]
    if mass < 0.0:
        raise context.error(f"found {mass:g} kg, expected a mass that is not negative", [*steps, "mass"])
    if model.as_given:
        return Inertial(mass, (com[0], com[1], com[2]), _six(inertia))
    if mass == 0.0 and any(inertia):
        raise context.error("found an inertia without mass, expected zeros for a link of mass 0", at)
    scale = max(map(abs, inertia), default=0.0)
    if scale > 0.0:
        ixx, ixy, ixz, iyy, iyz, izz = (value / scale for value in inertia)
        moments = np.linalg.eigvalsh(np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]))
        small, middle, large = (float(moment) for moment in moments)
        shown = ", ".join(f"{moment * scale:.4g}" for moment in (small, middle, large))
        slack = TOLERANCE * (abs(small) + abs(middle) + abs(large))
        if small < -slack:
            raise context.error(
                f"no body has this inertia: its principal moments are {shown} kg m^2, expected none negative "
                "(order ixx, ixy, ixz, iyy, iyz, izz, about the centre of mass)",
                at,
            )
        if small + middle < large - slack:
            raise context.error(
                f"no body has this inertia: its principal moments are {shown} kg m^2, the largest exceeds "
                "the sum of the others (order ixx, ixy, ixz, iyy, iyz, izz, about the centre of mass)",
                at,
            )
    return Inertial(mass, (com[0], com[1], com[2]), _six(inertia))


def _six(v: tuple[float, ...]) -> tuple[float, float, float, float, float, float]:
    return v[0], v[1], v[2], v[3], v[4], v[5]
