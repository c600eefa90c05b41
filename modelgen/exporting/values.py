"""Values of what is exported: a body for every link, a number for every parameter of an effect."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from modelgen.description.objects import Arm, Inertial
from modelgen.effects import applied_effects
from modelgen.errors import InputError
from modelgen.exporting.completion import completed
from modelgen.functions import Model
from modelgen.functions.nominal import about_origin
from modelgen.functions.parameters_file import base_vector
from modelgen.identification.bodies import TEN
from modelgen.importing.bodies import body_of
from modelgen.importing.poses import pose
from modelgen.importing.robot import Body
from modelgen.numeric import Array


@dataclass(frozen=True)
class Values:
    """bodies: by joint, in the link's frame. effects: linear parameters by symbol.

    off: names of base parameters whose values no bodies have, each with its relative error, the worst first.
    """

    bodies: tuple[Body, ...]
    effects: Mapping[str, float]
    off: Mapping[str, float] = field(default_factory=dict)


def nominal(arm: Arm) -> Values:
    """Those of the description; what an effect has no value for is left out. Raises InputError for a link."""
    missing = [arm.joints[i].name for i, link in enumerate(arm.links) if link is None]
    if missing:
        raise InputError(
            f"{arm.name}: link {missing[0]} has no mass, centre of mass and inertia; expected `links` in the "
            "description, or --parameters of modelgen identify",
            arm.where,
        )
    known = {
        symbol.name: effect.nominal[parameter.name]
        for effect in applied_effects(arm)
        for parameter, symbol in effect.parameters
        if parameter.name in effect.nominal
    }
    return Values(tuple(_described(link) for link in arm.links if link is not None), known)


def _described(link: Inertial) -> Body:
    return body_of(link.mass, pose(np.eye(3), np.array(link.com)), link.inertia)


def identified(model: Model, parameters: Mapping[str, float]) -> Values:
    """Bodies that could exist and give these base parameters, as near to the description's as can be.

    Where no such bodies do, those nearest to them. Raises InputError for parameters that are not the arm's,
    and for an arm in a fluid.
    """
    if model.arm.fluid_density:
        raise InputError(
            f"{model.arm.name}: --parameters of an arm in a fluid hold its buoyancy; expected none"
        )
    exact, off = completed(model, base_vector(model, parameters))
    worst = [int(k) for k in np.argsort(-np.abs(off)) if off[k]]
    count = 10 * len(model.arm.links)
    bodies = tuple(_body(exact[k : k + 10]) for k in range(0, count, 10))
    names = [p.name for p in model.standard[count:]]
    effects = dict(zip(names, map(float, exact[count:]), strict=True))
    return Values(bodies, effects, {model.grouping.base[k].name: abs(float(off[k])) for k in worst})


def _body(ten: Array) -> Body:
    """From the parameters about the frame's origin to a body (Huygens, Steiner)."""
    p = dict(zip(TEN, map(float, ten), strict=True))
    com = np.array([p["MX"], p["MY"], p["MZ"]]) / p["M"]
    about = np.array([[p["XX"], p["XY"], p["XZ"]], [p["XY"], p["YY"], p["YZ"]], [p["XZ"], p["YZ"], p["ZZ"]]])
    return Body(p["M"], com, about - p["M"] * (com @ com * np.eye(3) - np.outer(com, com)))


def standard_of(values: Values) -> dict[str, float]:
    """Standard parameters by name."""
    known = dict(values.effects)
    for i, body in enumerate(values.bodies, 1):
        six = body.inertia[np.triu_indices(3)].tolist()
        ten = about_origin(Inertial(body.mass, tuple(body.com.tolist()), tuple(six)))
        known |= {f"{name}{i}": value for name, value in ten.items()}
    return known
