"""The linkage of a drive as bars in a plane, for a drawing."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

Point = tuple[sp.Expr, sp.Expr]


@dataclass(frozen=True)
class Bar:
    """One bar of a drive's linkage, straight between two pins.

    The plane is across the joint's axis, which is at (0, 0). Its x stands still on the link before the joint;
    the description does not say in which direction, unless an effect does.

    name: what the description calls its length, or a word. carrier: "before" where it is a part of the link
    before the joint, "own" of the joint's own link, "between" where it swings. start, end: x and y of its
    pins [m] over q. telescopes: whether its length changes with q.
    """

    name: str
    carrier: str
    start: Point
    end: Point
    telescopes: bool = False


AXIS: Point = (sp.Integer(0), sp.Integer(0))
