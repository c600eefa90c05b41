"""Motions that move no inertia: they have no acceleration, and a simulation cannot begin there."""

from __future__ import annotations

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.simulation.plant import Plant

# Least share of the joints' own inertias that a motion must move.
VANISHED = 1e-9
# Share of the largest joint in a motion from which on a joint is said to take part in it.
TAKES_PART = 0.1


def check_inertia(plant: Plant, q: Array) -> None:
    """Raises InputError where joints at q (n,) can move together without moving any inertia.

    The mass matrix is in units of its own diagonal, so that the arm's size does not matter.
    """
    matrix = _mass_matrix(plant, q)
    own = np.diag(matrix)
    if not np.isfinite(matrix).all() or (own <= 0.0).any():
        still = [name for name, value in zip(plant.names, own, strict=True) if not value > 0.0]
        raise InputError(_said(plant, still or plant.names), plant.arm.where)
    scale = np.sqrt(own)
    values, motions = np.linalg.eigh(matrix / np.outer(scale, scale))
    if values[0] > VANISHED:
        return
    motion = np.abs(motions[:, 0])
    together = [n for n, share in zip(plant.names, motion, strict=True) if share > TAKES_PART * motion.max()]
    raise InputError(_said(plant, together), plant.arm.where)


def _mass_matrix(plant: Plant, q: Array) -> Array:
    """Mass matrix (n, n), drives included [kg m^2, kg m, kg]."""
    name = "mass_matrix_standard" if plant.slip.standard else "mass_matrix"
    function = plant.model.function(name)
    given = {"q": q, "parameters": plant.parameters}
    given |= {a.name: np.zeros(a.size) for a in function.arguments if a.name not in given}
    return np.asarray(NumpyFunction(function)(**given), dtype=float).reshape(plant.n, plant.n)


def _said(plant: Plant, joints: list[str]) -> str:
    """What is wrong at the start, and what may be the matter."""
    light = [
        joint.name
        for joint, link in zip(plant.arm.joints, plant.arm.links, strict=True)
        if link is not None and not link.mass and not any(link.inertia)
    ]
    if len(joints) == 1:
        what = f"joint {joints[0]} moves no inertia"
    else:
        what = (
            f"joints {', '.join(joints[:-1])} and {joints[-1]} can move together without moving any inertia"
        )
    if light:
        many = len(light) > 1
        links = f"links {', '.join(light)} have" if many else f"link {light[0]} has"
        whose = "them one, or their drives" if many else "it one, or its drive"
        hint = f"{links} no mass; give {whose} an inertia"
    else:
        hint = "give their links or drives inertia"
    return f"{plant.arm.name}: at the start {what}: {hint}, or start elsewhere"
