"""An arm whose geometry is named: symbols in place of numbers, as run-time parameters of the code."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from modelgen.description.objects import Arm, Joint, Scalar, geometry_symbol


def with_geometry_symbols(arm: Arm) -> Arm:
    """The arm with joint offsets, and the figures of drives that can be inputs, as named symbols.

    Symbols are called theta_2 and, of a lever, l1_2, l2_2, length0_2, length1_2 and offset_2 for joint 2, and
    keep their present values; what is symbolic already stays.
    """
    symbols = dict(arm.symbols)

    def named(name: str, value: Scalar) -> Scalar:
        if isinstance(value, sp.Expr) or name in symbols:
            return value
        symbols[name] = value
        return geometry_symbol(name)

    def joint_with_symbols(number: int, joint: Joint) -> Joint:
        if not joint.moving:
            return joint
        if joint.type == "revolute" and joint.theta != 0:
            joint = replace(joint, theta=named(f"theta_{number}", joint.theta))
        return replace(joint, drive=joint.drive.with_runtime(lambda name, x: named(f"{name}_{number}", x)))

    joints = tuple(joint_with_symbols(number, joint) for number, joint in enumerate(arm.joints, 1))
    return replace(arm, joints=joints, symbols=symbols)
