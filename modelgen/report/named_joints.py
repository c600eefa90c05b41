"""The arm of a diagnosis, with the joints at which something was named."""

from __future__ import annotations

from markupsafe import Markup

from modelgen.diagnosis.result import Diagnosis
from modelgen.report.arm_drawing import arm_drawing


def named_joints(d: Diagnosis) -> Markup:
    """The drawing, with causes and suspects at their joints; empty where nothing is named at a joint."""
    said: dict[str, list[str]] = {}
    for causes, words in ((d.causes, "{}"), (d.suspects, "{}?")):
        for cause in causes:
            if cause.joint_name is not None:
                said.setdefault(cause.joint_name, []).append(words.format(cause.effect))
    if not said:
        return Markup()
    marks = {name: ", ".join(texts) for name, texts in said.items()}
    return arm_drawing(d.arm, marks)
