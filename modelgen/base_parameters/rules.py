"""Grouping by rule: what a joint hides of its link passes to the link before it.

A revolute joint does not show where on its axis a mass sits, nor a thin rod along it; a prismatic
joint does not show where its link's inertia is; a fixed joint shows nothing (Gautier and Khalil 1990,
Khalil and Dombre 2002, chapter 9, here for chains and trees alike and with symbolic geometry). What
these rules leave is settled by the numeric oracle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import sympy as sp

from modelgen.description.objects import Arm, Joint, Scalar
from modelgen.geometry.scalars import snapped
from modelgen.model.transfer import (
    carried_inertia,
    carried_volume,
    invariant_directions,
    invariant_volume_directions,
)

# a combination of standard parameters: index -> factor
Combination: TypeAlias = dict[int, Scalar]
NOTHING = 1e-15  # what products of rounded sines and cosines leave where they cancel


def rotation(joint: Joint) -> list[list[Scalar]]:
    """Axes of frame j in its antecedent's frame, theta left out where the joint turns."""
    turning = joint.moving and joint.type == "revolute"
    theta: Scalar = 0.0 if turning else joint.theta
    if joint.locked is not None and joint.type == "revolute":
        theta = theta + joint.locked
    sg, cg = sin_cos(joint.gamma)
    sa, ca = sin_cos(joint.alpha)
    st, ct = sin_cos(theta)
    return [
        [cg * ct - sg * ca * st, -cg * st - sg * ca * ct, sg * sa],
        [sg * ct + cg * ca * st, -sg * st + cg * ca * ct, -cg * sa],
        [sa * st, sa * ct, ca],
    ]


def origin(joint: Joint, r: Scalar) -> list[Scalar]:
    """Origin of frame j in its antecedent's frame [m]."""
    sg, cg = sin_cos(joint.gamma)
    sa, ca = sin_cos(joint.alpha)
    return [cg * joint.d + sg * sa * r, sg * joint.d - cg * sa * r, ca * r + joint.b]


def sin_cos(angle: Scalar) -> tuple[Any, Any]:
    """Sine and cosine, exact at right angles."""
    if isinstance(angle, sp.Expr):
        return sp.sin(angle), sp.cos(angle)
    return snapped(math.sin(angle)), snapped(math.cos(angle))


def passed_on(arm: Arm, per_link: int) -> list[Combination]:
    """Every link parameter as a combination of those that the rules keep, by standard index.

    arm: its frames are those of the standard parameters. per_link: 10, or 14 in a fluid.
    A parameter that the rules keep stands for itself; one that has no effect has an empty combination.
    """
    result: list[Combination] = [{} for _ in range(per_link * len(arm.joints))]
    for i in arm.order:
        joint = arm.joints[i]
        kind = joint.type if joint.moving else "fixed"
        # a sliding joint moves its link along z: what it hides does not depend on where it stands
        r: Scalar = joint.r
        if joint.locked is not None and joint.type == "prismatic":
            r = r + joint.locked
        first = per_link * i
        axes, place = rotation(joint), origin(joint, r)
        for block, carried, directions in (
            (range(first, first + 10), carried_inertia, invariant_directions(kind)),
            (range(first + 10, first + per_link), carried_volume, invariant_volume_directions(kind)),
        ):
            for k in block:
                result[k] = {k: 1.0}
            for eliminated, direction in directions if len(block) else ():
                combination: Combination = {}
                for m, x in enumerate(direction):
                    if x and m != eliminated:
                        _add(combination, {block[m]: 1.0}, -float(x))
                if joint.antecedent is not None:
                    before = per_link * joint.antecedent + (block[0] - first)
                    for m, factor in enumerate(carried(axes, place, direction)):
                        _add(combination, result[before + m], factor)
                result[block[eliminated]] = combination
    return result


def _add(total: Combination, other: Combination, factor: Scalar) -> None:
    """total += factor other."""
    if factor == 0:
        return
    for k, value in other.items():
        total[k] = tidy(total.get(k, 0.0) + factor * value)
        if total[k] == 0 or (isinstance(total[k], float) and abs(total[k]) < NOTHING):
            del total[k]


def tidy(value: Scalar) -> Scalar:
    """A symbolic value expanded, a number as a float."""
    if isinstance(value, sp.Expr):
        value = sp.expand(value)
        return float(value) if value.is_number else value
    return float(value)


def slid(arm: Arm) -> Arm:
    """The arm with the frames of its last links moved along z to the foot of the common normal.

    How far a last link's frame sits along its own axis is a choice of drawing, not of dynamics. Its
    base parameters are those about the foot, which spares every function the offset r. What is given in the
    frame as it is drawn, the joint's `lift` takes there.
    """
    carrying = {joint.antecedent for joint in arm.joints}
    joints = tuple(
        replace(joint, r=0.0, lift=joint.lift + joint.r)
        if i not in carrying and joint.type == "revolute" and joint.moving
        else joint
        for i, joint in enumerate(arm.joints)
    )
    return replace(arm, joints=joints)


def about_foot(arm: Arm, per_link: int) -> list[Combination]:
    """Every link parameter of `arm` as a combination of those of `slid(arm)`."""
    unit: Sequence[Sequence[int]] = [[int(a == b) for b in range(3)] for a in range(3)]
    moved = slid(arm)
    result: list[Combination] = []
    for i, (joint, other) in enumerate(zip(arm.joints, moved.joints, strict=True)):
        first = per_link * i
        if joint is other or joint.r == 0:
            result += [{first + k: 1.0} for k in range(per_link)]
            continue
        place = [0.0, 0.0, joint.r]
        for offset, size, carried in ((0, 10, carried_inertia), (10, per_link - 10, carried_volume)):
            for k in range(size):
                direction = [int(m == k) for m in range(size)]
                combination: Combination = {}
                for m, factor in enumerate(carried(unit, place, direction)):
                    _add(combination, {first + offset + m: 1.0}, factor)
                result.append(combination)
    return result


def composed(outer: Sequence[Combination], inner: Sequence[Combination]) -> list[Combination]:
    """`outer` written in what `inner` writes its parameters in."""
    result = []
    for combination in outer:
        total: Combination = {}
        for k, factor in combination.items():
            _add(total, inner[k], factor)
        result.append(total)
    return result
