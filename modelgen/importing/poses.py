"""Poses as homogeneous 4 x 4 matrices, and rotations from what the formats write."""

from __future__ import annotations

import math

import numpy as np

from modelgen.numeric import Array

_NEAR = 1e-15
_LEVEL = 1e-12  # cosine of pitch below which roll and yaw are one turn


def rotation(axis: int, angle: float) -> Array:
    """Rotation (3, 3) about x, y or z (0, 1, 2); exact at multiples of a right angle."""
    c, s = math.cos(angle), math.sin(angle)
    c, s = (0.0 if abs(v) < _NEAR else v for v in (c, s))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def from_rpy(rpy: Array) -> Array:
    """Rotation (3, 3) Rz(yaw) Ry(pitch) Rx(roll) [rad]: about fixed axes, x first."""
    turned: Array = rotation(2, rpy[2]) @ rotation(1, rpy[1]) @ rotation(0, rpy[0])
    return turned


def to_rpy(turn: Array) -> Array:
    """The angles of `from_rpy`, with pitch within a right angle, and no roll at that."""
    upright = math.hypot(turn[2, 1], turn[2, 2])
    roll = math.atan2(turn[2, 1], turn[2, 2]) if upright > _LEVEL else 0.0
    # the two others from what is left, so that an uncertain roll does no harm
    rest = turn @ rotation(0, roll).T
    return np.array([roll, math.atan2(-rest[2, 0], rest[2, 2]), math.atan2(-rest[0, 1], rest[1, 1])])


def from_axis_angle(axis: Array, angle: float) -> Array:
    """Rotation (3, 3) by `angle` [rad] about the direction `axis` (Rodrigues)."""
    k = cross_matrix(axis / np.linalg.norm(axis))
    turned: Array = np.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * (k @ k)
    return turned


def from_quaternion(q: Array) -> Array:
    """Rotation (3, 3) of the quaternion w, x, y, z, which need not have the norm 1."""
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def cross_matrix(v: Array) -> Array:
    """The matrix (3, 3) with which v x w is a product."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def pose(turn: Array, place: Array) -> Array:
    """Homogeneous (4, 4) of a rotation and a place [m]."""
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = turn, place
    return result


def inverse(transform: Array) -> Array:
    """Of a homogeneous matrix."""
    turn = transform[:3, :3].T
    return pose(turn, -turn @ transform[:3, 3])


def moved(kind: str, axis: Array, anchor: Array, amount: float) -> Array:
    """Motion (4, 4) of a joint by `amount` [rad, m], in the axes in which `axis` and `anchor` are given."""
    if kind == "prismatic":
        return pose(np.eye(3), amount * axis)
    turn = from_axis_angle(axis, amount)
    return pose(turn, anchor - turn @ anchor)


def to_quaternion(turn: Array) -> Array:
    """w, x, y, z (4,) of a rotation (3, 3), w not negative (Shepperd, 1978)."""
    trace = float(np.trace(turn))
    squares = np.array([trace, turn[0, 0], turn[1, 1], turn[2, 2]])
    k = int(np.argmax(squares))
    if k == 0:
        q = np.array(
            [1 + trace, *(turn[(i + 2) % 3, (i + 1) % 3] - turn[(i + 1) % 3, (i + 2) % 3] for i in range(3))]
        )
    else:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        q = np.zeros(4)
        q[0] = turn[m, j] - turn[j, m]
        q[1 + i] = 1 + turn[i, i] - turn[j, j] - turn[m, m]
        q[1 + j] = turn[j, i] + turn[i, j]
        q[1 + m] = turn[m, i] + turn[i, m]
    q = q / np.linalg.norm(q)
    return np.asarray(-q if q[0] < 0 else q)
