"""The drawing of an arm as a part of a report."""

from __future__ import annotations

from collections.abc import Mapping

from markupsafe import Markup

from modelgen.description import Arm
from modelgen.drawing import framed, page

_HEIGHT = 560  # pixels


def arm_drawing(arm: Arm, marks: Mapping[str, str] | None = None) -> Markup:
    """The arm to turn and move. marks: texts by the names of the joints at which they stand."""
    return framed(page(arm, marks=dict(marks or {})), f"the arm {arm.name}", _HEIGHT)
