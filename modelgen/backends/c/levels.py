"""Gains and thresholds of the functions that watch an arm, as constants."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.backends.c.dialect import literal
from modelgen.backends.text import table
from modelgen.functions.objects import Model

ROUNDED = 6  # digits


def levels(model: Model) -> dict[str, object]:
    """Values of the template; empty where the model has none. Raises ValueError as `literal` does."""
    found, arm = model.levels, model.arm.name
    if found is None:
        return {}
    joints = [model.arm.joints[i] for i in model.arm.coordinates]
    efforts = ["N" if joint.type == "prismatic" else "N m" for joint in joints]

    def rows(values: Sequence[float], remarks: Sequence[str]) -> list[str]:
        listed = (literal(arm, _rounded(x)) for x in values)
        return table((f"{x},", f"/* {remark} */") for x, remark in zip(listed, remarks, strict=True))

    names = found.names
    return {
        "gain": rows(found.gain, [f"{joint.name} [1/s]" for joint in joints]),
        "threshold": rows(
            found.threshold, [f"{j.name} [{unit}]" for j, unit in zip(joints, efforts, strict=True)]
        ),
        "parameters": names,
        "count": len(names),
        "start": rows(found.start, names),
        "open": rows([x * x for x in found.std], names),
        "correlation": literal(arm, _rounded(found.correlation)),
        "memory": f"{found.memory:g}",
        "square": literal(arm, _rounded(found.level**2)),
    }


def _rounded(x: float) -> float:
    return float(f"{x:.{ROUNDED}g}") if abs(x) > 1e-30 else 0.0
