"""Bodies as pseudo-inertias: which could exist, and which the description gives."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.effects import applied_effects
from modelgen.functions import Model
from modelgen.functions.nominal import about_origin, base_matrix
from modelgen.numeric import Array

TEN = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
_BALL = (1.0, 0.1)  # kg, m: a link of which the description says nothing
_LEAST = 1e-6  # of its trace: a point or a rod has no volume, and logarithms need one


def pseudo_inertia(parameters: Sequence[float] | Array) -> Array:
    """4 x 4 of the parameters TEN: second moments of the mass, first moments, mass (Wensing, Kim and Slotine
    2018).
    """
    xx, xy, xz, yy, yz, zz, mx, my, mz, m = (float(v) for v in parameters)
    half = (xx + yy + zz) / 2
    return np.array(
        [
            [half - xx, -xy, -xz, mx],
            [-xy, half - yy, -yz, my],
            [-xz, -yz, half - zz, mz],
            [mx, my, mz, m],
        ]
    )


def ten(pseudo: Array) -> Array:
    """The parameters TEN (10,) of a pseudo-inertia."""
    second = pseudo[:3, :3]
    tensor = np.trace(second) * np.eye(3) - second
    return np.concatenate([tensor[np.triu_indices(3)], pseudo[:3, 3], pseudo[3:, 3]])


def prior_inertia(model: Model, link: int) -> Array:
    """Pseudo-inertia of the described link, else of a ball."""
    nominal = model.arm.links[link]
    if nominal is None:
        mass, radius = _BALL
        return np.diag([mass * radius**2 / 5] * 3 + [mass])
    values = about_origin(nominal)
    found = pseudo_inertia([values[name] for name in TEN])
    least = _LEAST * np.trace(found)
    return found + least * np.eye(4) if np.linalg.eigvalsh(found)[0] < least else found


def plain(model: Model, theta: Array) -> Array:
    """Standard parameters (s,) that give theta exactly, closest to the prior in the least squares sense."""
    grouping = base_matrix(model)
    start = np.zeros(len(model.standard))
    for i in range(len(model.arm.links)):
        start[10 * i : 10 * i + 10] = ten(prior_inertia(model, i))
    change, *_ = np.linalg.lstsq(grouping, theta - grouping @ start, rcond=None)
    return np.asarray(start + change)


def violations(model: Model, standard: Array) -> tuple[str, ...]:
    """Links with a negative mass or a pseudo-inertia that is not positive definite, and parameters of effects
    beyond their bounds, in words.
    """
    found = []
    for i, joint in enumerate(model.arm.joints):
        own = standard[10 * i : 10 * i + 10]
        if own[9] <= 0:
            found.append(f"{joint.name}: mass {own[9]:.3g} kg")
        elif np.linalg.eigvalsh(pseudo_inertia(own))[0] <= 0:
            found.append(f"{joint.name}: impossible inertia")
    return (*found, *_beyond(model, standard))


def _beyond(model: Model, standard: Array) -> list[str]:
    """Parameters of effects beyond their bounds, in words."""
    bounds = {symbol.name: p.bounds for e in applied_effects(model.arm) for p, symbol in e.parameters}
    values = zip(model.standard, standard.tolist(), strict=True)
    found = [(p, value, *bounds[p.name]) for p, value in values if p.name in bounds]
    return [f"{p.name}: {value:.3g} {p.unit}" for p, value, low, high in found if not low <= value <= high]
