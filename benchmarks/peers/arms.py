"""The arms that are measured: rigid links alone, with the same numbers for everyone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from modelgen.description import load
from modelgen.description.objects import Arm, Inertial
from modelgen.effects import known_effects
from modelgen.functions import Model, Options, build_model, nominal_base
from modelgen.resources import shipped_arms

Array = NDArray[np.float64]

# Bench arms with nominal bodies of their own; the others get the same body for every link.
BENCH = ("yaw3pitch", "ur10e_bench", "iiwa14_bench")
SHIPPED = ("scara", "rx90", "puma560", "ariane6", "wam7")
_BODY = Inertial(mass=2.0, com=(0.1, 0.05, -0.05), inertia=(0.1, 0.002, -0.001, 0.12, 0.003, 0.09))
_LINKS_ALONE = Options(without=frozenset({"drives", "effects"}))


@dataclass(frozen=True)
class Subject:
    """An arm with bodies, and the samples x 3 n states: q [rad or m], dq, then ddq or an effort."""

    arm: Arm
    states: Array

    @property
    def joints(self) -> int:
        """Number of coordinates."""
        return len(self.arm.coordinates)


def subject(name: str, samples: int = 200) -> Subject:
    """A shipped arm, a serial chain of moving joints. Raises ValueError for another kind."""
    arm = load(shipped_arms(), known_effects())[name]
    before = [joint.antecedent for joint in arm.joints]
    if len(arm.coordinates) != len(arm.joints) or before != [None, *range(len(before) - 1)]:
        raise ValueError(f"{name} is no serial chain of moving joints")
    links = tuple(link or _BODY for link in arm.links)
    rng = np.random.default_rng(7)
    n = len(arm.joints)
    spread = np.repeat([np.pi, 2.0, 3.0], n)
    return Subject(replace(arm, links=links), rng.uniform(-1.0, 1.0, (samples, 3 * n)) * spread)


def links_alone(arm: Arm) -> Model:
    """The model without drives and effects, parameters at run time and folded in."""
    model = build_model(arm, _LINKS_ALONE)
    return build_model(arm, replace(_LINKS_ALONE, identified=nominal_base(model)))


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
    result[j, j] = result[k, k] = cos(angle)
    result[j, k], result[k, j] = -sin(angle), sin(angle)
    result[axis, 3] = distance
    return result


def model_text(arm: Arm) -> str:
    """The arm as pinocchio_model.hpp reads it."""
    lines = [_line([len(arm.joints), *arm.gravity])]
    for i, (joint, link) in enumerate(zip(arm.joints, arm.links, strict=True)):
        assert link is not None
        place = placement(arm, i)[:3].ravel()
        kind = joint.type == "prismatic"
        lines.append(_line([i, int(kind), *place, link.mass, *link.com, *link.inertia]))
    return "\n".join(lines) + "\n"


def _line(numbers: list[float]) -> str:
    return " ".join(f"{number:.17g}" for number in numbers)
