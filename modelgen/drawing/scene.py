"""What the drawing of an arm is made of, as plain data: frames, limits, drives, inertias, tools.

Figures are as the description gives them, so that the data are the same on any machine; all that follows from
them is computed in the page.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from modelgen.description.context import show
from modelgen.description.objects import Arm, Inertial, Joint, Transform
from modelgen.drawing.programs import program
from modelgen.effects import described, pivot_direction
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.symbolic import Range, number
from modelgen.transmission import Drive, of_joint

DIGITS = 12  # of ends that are computed; the last ones are another machine's
PLACES = 5  # [rad, m] of a motion
_SLACK = 1e-9  # [rad, m] beyond a limit, that comes of writing it with fewer digits
_FIGURES = ("gamma", "b", "alpha", "d", "theta", "r")


def scene(arm: Arm, q: Sequence[float] | None = None) -> dict[str, Any]:
    """The arm as data for the page, drawn at the coordinates `q` (n,) [rad, m].

    q: by default `start`. Raises InputError where it is not within the joints' limits.
    """
    arm = described(arm)
    shown = start(arm) if q is None else [float(x) for x in q]
    _check(arm, shown)
    return _data(arm, shown)


def moving_scene(arm: Arm, t: Array, q: Array) -> dict[str, Any]:
    """The arm as data for the page, with a motion: q (F, n) [rad, m] at equal times t (F,) [s]."""
    data = _data(described(arm), [float(x) for x in q[0]])
    motion = {"t": np.round(t, 4).tolist(), "q": np.round(q, PLACES).tolist()}
    return data | {"motion": motion}


def _data(arm: Arm, shown: Sequence[float]) -> dict[str, Any]:
    number_of = {i: n for n, i in enumerate(arm.coordinates)}
    return {
        "name": arm.name,
        "source": arm.source,
        "notes": list(arm.notes),
        "gravity": list(arm.gravity),
        "base": None if arm.base is None else _rows(arm.base),
        "order": list(arm.order),
        "joints": [
            _joint(arm, joint, number_of.get(i, -1), arm.links[i]) for i, joint in enumerate(arm.joints)
        ],
        "tools": [
            {"name": tool.name, "link": tool.link, "transform": _rows(tool.transform)} for tool in arm.tools
        ],
        "q": list(shown),
        "motion": None,
    }


def start(arm: Arm) -> list[float]:
    """Coordinates (n,) [rad, m] that an arm is drawn at: zero, or the middle of a range without zero."""
    found = []
    for i in arm.coordinates:
        low, high = joint_range(arm, arm.joints[i]) or (0.0, 0.0)
        found.append(0.0 if low <= 0.0 <= high else _rounded((low + high) / 2))
    return found


def joint_range(arm: Arm, joint: Joint) -> Range | None:
    """Lowest and highest coordinate [rad, m]: the limits, else what the drive reaches; None without end."""
    if joint.limits.position is not None:
        return joint.limits.position
    return of_joint(arm, joint).joint_range()


def _check(arm: Arm, q: Sequence[float]) -> None:
    for value, i in zip(q, arm.coordinates, strict=True):
        joint = arm.joints[i]
        low, high = joint_range(arm, joint) or (value, value)
        if not low - _SLACK <= value <= high + _SLACK:
            kind = "length" if joint.type == "prismatic" else "angle"
            found, least, most = (show(x, kind) for x in (value, low, high))
            raise InputError(
                f"--q: found {found} for joint {joint.name}, "
                f"expected a value within its range {least} to {most}"
            )


def _joint(arm: Arm, joint: Joint, coordinate: int, link: Inertial | None) -> dict[str, Any]:
    limits = joint.limits
    ends = joint_range(arm, joint) if joint.moving else None
    return {
        "name": joint.name,
        "mark": "",
        "type": joint.type,
        "antecedent": -1 if joint.antecedent is None else joint.antecedent,
        "coordinate": coordinate,
        "locked": joint.locked,
        **{name: number(getattr(joint, name), arm.symbols) for name in _FIGURES},
        # what the description calls a figure
        "expressions": {
            name: str(value) for name in _FIGURES if isinstance(value := getattr(joint, name), sp.Expr)
        },
        "range": None if ends is None else [_rounded(end) for end in ends],
        "limits": {
            name: value
            for name in ("velocity", "acceleration", "effort")
            if (value := getattr(limits, name)) is not None
        },
        "drive": _drive(arm, joint),
        "link": None if link is None else _link(link),
    }


def _drive(arm: Arm, joint: Joint) -> dict[str, Any]:
    transmission = of_joint(arm, joint)
    drive: Drive = joint.drive.numeric(arm.symbols)
    ends = transmission.motor_range() if drive.driven else None
    return {
        "title": drive.title,
        "driven": drive.driven,
        "unit": "" if drive.unit == "unit" else drive.unit,
        "motor": program([transmission.motor()], transmission.q, arm.symbols),
        "range": None if ends is None else [_rounded(end) for end in ends],
        "bars": [
            {
                "name": bar.name,
                "carrier": bar.carrier,
                "telescopes": bar.telescopes,
                "pins": program([*bar.start, *bar.end], transmission.q, arm.symbols),
            }
            for bar in drive.linkage(transmission.q)
        ],
        "direction": pivot_direction(joint),
    }


def _link(link: Inertial) -> dict[str, Any]:
    return {"mass": link.mass, "com": list(link.com), "inertia": list(link.inertia)}


def _rows(transform: Transform) -> list[float]:
    """3 x 4, row by row."""
    rows = zip(transform.rotation, transform.translation, strict=True)
    return [value for row, along in rows for value in (*row, along)]


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
