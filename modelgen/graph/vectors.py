"""Small vectors and matrices of expressions; every component is an `Expr`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from modelgen.graph.graph import Expr, Number

Vector: TypeAlias = tuple[Expr, Expr, Expr]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]


def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def scaled(k: Expr | Number, v: Vector) -> Vector:
    """k v."""
    return (v[0] * k, v[1] * k, v[2] * k)


def transposed(m: Matrix) -> Matrix:
    """The matrix with rows and columns exchanged."""
    return (column(m, 0), column(m, 1), column(m, 2))


def dot(a: Sequence[Expr], b: Sequence[Expr]) -> Expr:
    """a . b."""
    total = a[0] * b[0]
    for x, y in zip(a[1:], b[1:], strict=True):
        total = total + x * y
    return total


def times(m: Matrix, v: Vector) -> Vector:
    """m v."""
    return (dot(m[0], v), dot(m[1], v), dot(m[2], v))


def column(m: Matrix, i: int) -> Vector:
    """Column i of m."""
    return (m[0][i], m[1][i], m[2][i])
