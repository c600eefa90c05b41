"""Where the links are, straight from the definition of the parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from modelgen.description import Arm, Scalar

Matrix = NDArray[np.float64]


def number(arm: Arm, value: Scalar) -> float:
    """A number, or an expression in the arm's symbols at their values."""
    if isinstance(value, sp.Expr):
        return float(value.subs({symbol: arm.symbols[symbol.name] for symbol in value.free_symbols}))
    return float(value)


def rotation_x(angle: float) -> Matrix:
    """Homogeneous rotation about x."""
    s, c = math.sin(angle), math.cos(angle)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])


def rotation_z(angle: float) -> Matrix:
    """Homogeneous rotation about z."""
    s, c = math.sin(angle), math.cos(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def translation(x: float, z: float) -> Matrix:
    """Homogeneous translation."""
    result = np.eye(4)
    result[0, 3], result[2, 3] = x, z
    return result


def placement(arm: Arm, i: int, coordinate: float = 0.0) -> Matrix:
    """Frame i in its antecedent's for a joint coordinate [rad or m]."""
    joint = arm.joints[i]
    alpha, d, r, theta, gamma, b = (
        number(arm, x) for x in (joint.alpha, joint.d, joint.r, joint.theta, joint.gamma, joint.b)
    )
    theta += coordinate if joint.type == "revolute" else 0.0
    r += coordinate if joint.type == "prismatic" else 0.0
    foot = rotation_z(gamma) @ translation(0, b) @ rotation_x(alpha) @ translation(d, 0)
    return foot @ rotation_z(theta) @ translation(0, r)


def moving(arm: Arm) -> list[int]:
    """Joints that have a coordinate, in order."""
    return [i for i, joint in enumerate(arm.joints) if joint.type != "fixed" and joint.locked is None]


def parents_first(arm: Arm) -> list[int]:
    """Every joint followed by all that it carries, branch after branch."""

    def branch(i: int | None) -> list[int]:
        carried = [k for k, joint in enumerate(arm.joints) if joint.antecedent == i]
        return [k for start in carried for k in (start, *branch(start))]

    return branch(None)


def poses(arm: Arm, q: Sequence[float]) -> list[Matrix]:
    """Every link's frame in the base."""
    coordinate = {i: joint.locked or 0.0 for i, joint in enumerate(arm.joints)}
    coordinate.update(zip(moving(arm), q, strict=True))
    result: dict[int, Matrix] = {}
    for i in parents_first(arm):
        before = arm.joints[i].antecedent
        local = placement(arm, i, coordinate[i])
        result[i] = local if before is None else result[before] @ local
    return [result[i] for i in range(len(arm.joints))]
