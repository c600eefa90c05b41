"""Inertial parameters of a body seen from another frame, over any arithmetic.

The same formulas serve numbers, SymPy expressions (for grouping in print) and graph expressions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

# places of the tensor's elements among XX, XY, XZ, YY, YZ, ZZ
_PLACE = ((0, 1, 2), (1, 3, 4), (2, 4, 5))
_UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


def carried_inertia(rotation: Sequence[Sequence[Any]], origin: Sequence[Any], p: Sequence[Any]) -> list[Any]:
    """The ten parameters `p` of frame j in its antecedent's frame.

    rotation: 3 x 3, axes of frame j in the antecedent's frame; origin: of frame j there [m].
    Steiner's theorem with first moments instead of the centre of mass.
    """
    turned = [[sum(rotation[a][i] * p[_PLACE[i][j]] for i in range(3)) for j in range(3)] for a in range(3)]
    moments = [sum(rotation[a][i] * p[6 + i] for i in range(3)) for a in range(3)]
    mass = p[9]
    along = sum(origin[a] * (2 * moments[a] + mass * origin[a]) for a in range(3))
    tensor = []
    for a, b in _UPPER:
        element = sum(turned[a][j] * rotation[b][j] for j in range(3))
        element = element - origin[a] * moments[b] - moments[a] * origin[b] - mass * origin[a] * origin[b]
        tensor.append(element + along if a == b else element)
    return [*tensor, *(moments[a] + mass * origin[a] for a in range(3)), mass]


def carried_volume(rotation: Sequence[Sequence[Any]], origin: Sequence[Any], p: Sequence[Any]) -> list[Any]:
    """The four volume parameters VX, VY, VZ, V of frame j in its antecedent's frame."""
    moments = [sum(rotation[a][i] * p[i] for i in range(3)) for a in range(3)]
    return [*(moments[a] + p[3] * origin[a] for a in range(3)), p[3]]


def invariant_directions(kind: str) -> list[tuple[int, list[int]]]:
    """Parameter changes of a link that its joint's motion does not show to the other links.

    For each: the parameter that is eliminated by it, and the change as a vector of ten. A revolute
    joint hides a turn of the link about z (a mass on the axis, its place on it, a thin rod along
    it), a prismatic joint hides where the link is, a fixed joint everything (Gautier and Khalil 1990).
    """
    unit = [[int(i == k) for i in range(10)] for k in range(10)]
    if kind == "revolute":
        rod = [1, 0, 0, 1, 0, 0, 0, 0, 0, 0]
        return [(3, rod), (8, unit[8]), (9, unit[9])]
    if kind == "prismatic":
        return [(k, unit[k]) for k in range(6)]
    return [(k, unit[k]) for k in range(10)]


def invariant_volume_directions(kind: str) -> list[tuple[int, list[int]]]:
    """Directions of the four volume parameters that change no force."""
    unit = [[int(i == k) for i in range(4)] for k in range(4)]
    hidden = {"revolute": (2, 3), "prismatic": (0, 1, 2)}.get(kind, (0, 1, 2, 3))
    return [(k, unit[k]) for k in hidden]
