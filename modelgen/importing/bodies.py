"""Rigid bodies: moved to other frames, joined, and looked at: could matter be spread that way?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.importing.robot import Body
from modelgen.numeric import Array

# Relative to the sum of the principal moments: published figures are rounded.
ROUNDING = 1e-6


def body_of(mass: float, place: Array, six: Sequence[float]) -> Body:
    """From ixx, ixy, ixz, iyy, iyz, izz about the centre of mass, in the axes of `place` (4, 4)."""
    xx, xy, xz, yy, yz, zz = six
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    turn = place[:3, :3]
    return Body(mass, place[:3, 3].copy(), turn @ tensor @ turn.T)


def moved_body(body: Body, transform: Array) -> Body:
    """The body in the frame that `transform` (4, 4) takes its own to."""
    turn = transform[:3, :3]
    return Body(body.mass, turn @ body.com + transform[:3, 3], turn @ body.inertia @ turn.T)


def together(bodies: Sequence[Body]) -> Body:
    """Several bodies of one frame as one (Huygens, Steiner)."""
    mass = sum(body.mass for body in bodies)
    if mass == 0.0:
        return Body(0.0, np.zeros(3), sum((body.inertia for body in bodies), np.zeros((3, 3))))
    com = sum((body.mass * body.com for body in bodies), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for body in bodies:
        away = body.com - com
        inertia += body.inertia + body.mass * (away @ away * np.eye(3) - np.outer(away, away))
    return Body(mass, com, inertia)


def doubt(body: Body) -> str:
    """What is impossible about the body, "" where nothing is (Traversaro et al., 2016)."""
    low, middle, high = (float(moment) for moment in np.linalg.eigvalsh(body.inertia))
    slack = ROUNDING * (abs(low) + abs(middle) + abs(high))
    if body.mass == 0 and slack > 0:
        return "it has an inertia without a mass"
    if low < -slack:
        return f"a principal moment is {low:.6g} kg m^2, expected none below 0"
    if low + middle < high - slack:
        return f"its largest principal moment, {high:.6g} kg m^2, exceeds the others' sum, {low + middle:.6g}"
    return ""
