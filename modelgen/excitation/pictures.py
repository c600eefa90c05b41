"""Pictures of an excitation trajectory."""

from __future__ import annotations

import numpy as np

from modelgen.dataset import drives_of
from modelgen.excitation.run import Excitation
from modelgen.figures import COLOURS, figure, svg

_ROWS = (
    ("q", "joint coordinate [{q}]", "q"),
    ("dq", "joint speed [{q}/s]", "q"),
    ("qm", "motor coordinate [{m}]", "m"),
    ("dqm", "motor speed [{m}/s]", "m"),
)


def picture(e: Excitation) -> str:
    """SVG: position and speed on both sides of the drives over one period, a row of panels per joint."""
    n = len(e.problem.middle)
    made, axes = figure(n, len(_ROWS), (3.0 * len(_ROWS), 1.8 * n + 0.4))
    drives = drives_of(e.arm)
    for k, i in enumerate(e.arm.coordinates):
        joint = e.arm.joints[i]
        angle = joint.type != "prismatic"
        units = {"q": "deg" if angle else "m", "m": drives[k].unit if drives[k].driven else "deg"}
        for column, (name, text, side) in enumerate(_ROWS):
            y = e.signals[name][:, k]
            if units[side] == "deg":
                y = np.degrees(y)
            axis = axes[k, column]
            axis.plot(e.t, y, color=COLOURS[k % len(COLOURS)])
            axis.set_ylabel(text.format(q=units["q"], m=units["m"]))
            axis.set_title(joint.name if not column else "")
            axis.set_xlabel("t [s]" if k == n - 1 else "")
    made.suptitle(f"{e.arm.name}, condition number {e.condition:.3g}")
    return svg(made)
