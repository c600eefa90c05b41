"""An arm as moving bodies: what every peer is given. Links behind fixed and locked joints are merged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, sin

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from modelgen.description.objects import Arm

Array = NDArray[np.float64]
# cos(pi / 2) is 0: a generator that folds constants must not be given 6e-17 to carry through.
_EXACT = 1e-15


@dataclass
class Body:
    """What one coordinate moves.

    `place`: its frame in that of body `parent` (None: the base) at coordinate zero, 4 x 4; it turns about z
    or slides along it. `tensor` [kg m^2] and `first` (mass times centre [kg m]) about the frame's origin.
    """

    parent: int | None
    prismatic: bool
    place: Array
    mass: float
    first: Array
    tensor: Array

    @property
    def com(self) -> Array:
        """Centre of mass [m]."""
        return self.first / self.mass

    @property
    def inertia(self) -> list[float]:
        """xx, xy, xz, yy, yz, zz about the centre of mass."""
        c = self.com
        t = self.tensor - self.mass * (c @ c * np.eye(3) - np.outer(c, c))
        return [float(t[j, k]) for j, k in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))]


def bodies(arm: Arm) -> list[Body]:
    """The moving bodies by coordinate; every link needs its inertials."""
    number = {joint: n for n, joint in enumerate(arm.coordinates)}
    carrier: dict[int | None, tuple[int | None, Array]] = {None: (None, np.eye(4))}
    found: dict[int, Body] = {}
    for i in arm.order:
        joint, link = arm.joints[i], arm.links[i]
        assert link is not None
        parent, offset = carrier[joint.antecedent]
        place = offset @ placement(arm, i)
        c, m = np.array(link.com), link.mass
        xx, xy, xz, yy, yz, zz = link.inertia
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        tensor = tensor + m * (c @ c * np.eye(3) - np.outer(c, c))
        if joint.moving:
            found[number[i]] = Body(parent, joint.type == "prismatic", place, m, m * c, tensor)
            carrier[i] = (number[i], np.eye(4))
            continue
        if joint.locked is not None:
            turning = joint.type == "revolute"
            place = place @ _turn(2, joint.locked if turning else 0.0, 0.0 if turning else joint.locked)
        carrier[i] = (parent, place)
        if parent is not None:
            _merge(found[parent], place, m, m * c, tensor)
    return [found[n] for n in range(len(found))]


def _merge(body: Body, place: Array, mass: float, first: Array, tensor: Array) -> None:
    """Add a link that is fixed at `place`."""
    turn, p = place[:3, :3], place[:3, 3]
    h = turn @ first
    body.mass += mass
    body.first = body.first + h + mass * p
    shift = 2 * (p @ h) * np.eye(3) - np.outer(p, h) - np.outer(h, p)
    body.tensor = body.tensor + turn @ tensor @ turn.T + shift + mass * (p @ p * np.eye(3) - np.outer(p, p))


def placement(arm: Arm, i: int) -> Array:
    """Frame i in its antecedent's at coordinate zero, 4 x 4 (Khalil and Kleinfinger 1986)."""
    joint = arm.joints[i]
    alpha, d, theta, r, gamma, b = (
        _number(x, arm.symbols) for x in (joint.alpha, joint.d, joint.theta, joint.r, joint.gamma, joint.b)
    )
    return _turn(2, gamma, b) @ _turn(0, alpha, d) @ _turn(2, theta, r)


def _number(value: object, symbols: Mapping[str, float]) -> float:
    """A number, or an expression with the values of its symbols."""
    if isinstance(value, sp.Expr):
        value = value.subs({symbol: symbols[str(symbol)] for symbol in value.free_symbols})
    return float(str(value))


def _turn(axis: int, angle: float, distance: float) -> Array:
    """Rotation about an axis of coordinates and translation along it."""
    j, k = (axis + 1) % 3, (axis + 2) % 3
    result = np.eye(4)
    c, s = (round(x) if abs(x - round(x)) < _EXACT else x for x in (cos(angle), sin(angle)))
    result[j, j] = result[k, k] = c
    result[j, k], result[k, j] = -s, s
    result[axis, 3] = distance
    return result
