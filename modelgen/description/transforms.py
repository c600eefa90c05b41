"""Fixed transforms of the description: where the base stands, where tools are on their links."""

from __future__ import annotations

import math

import numpy as np

from modelgen.description.context import Context
from modelgen.description.document import Steps
from modelgen.description.objects import Tool, Transform
from modelgen.description.schema import ArmModel, TransformModel
from modelgen.errors import suggest

# A matrix given with fewer digits than that is no rotation.
ORTHOGONAL = 1e-6
_EXACT = 1e-12  # sines and cosines this close to 0 or 1 are meant to be 0 or 1


def read_base(context: Context, model: ArmModel) -> Transform | None:
    """World <- base frame, None where the arm does not give it. Raises InputError."""
    return None if model.base is None else read_transform(context, model.base, ["base"])


def read_tools(context: Context, model: ArmModel, names: list[str]) -> tuple[Tool, ...]:
    """The tools of the arm; `names` are those of its joints. Raises InputError."""
    tools: list[Tool] = []
    for name, tool in model.tools.items():
        at: list[str | int] = ["tools", name]
        if name in names:
            raise context.error("a joint is called the same, names must differ", at, key=True)
        if tool.link not in names:
            hint = suggest(tool.link, names)
            raise context.error(f"found '{tool.link}', which is no joint of this arm{hint}", [*at, "link"])
        tools.append(Tool(name, names.index(tool.link), read_transform(context, tool, at)))
    return tuple(tools)


def read_transform(context: Context, model: TransformModel, steps: Steps) -> Transform:
    """A transform by xyz and rpy, or by a matrix. Raises InputError."""
    if model.matrix is not None:
        if model.model_fields_set & {"xyz", "rpy"}:
            raise context.error("found xyz or rpy beside a matrix, expected one or the other", steps)
        return _matrix(context, model.matrix, [*steps, "matrix"])
    place = context.numbers(model.xyz, "length", [*steps, "xyz"])
    roll, pitch, yaw = context.numbers(model.rpy, "angle", [*steps, "rpy"])
    turn = _turn(2, yaw) @ _turn(1, pitch) @ _turn(0, roll)
    return _transform(turn, place)


def _matrix(context: Context, rows: list[list[float | str]], steps: Steps) -> Transform:
    values = np.array([context.numbers(row, "plain", [*steps, i]) for i, row in enumerate(rows)])
    turn = values[:3, :3]
    if not np.array_equal(values[3], [0.0, 0.0, 0.0, 1.0]):
        raise context.error("its last row is not 0, 0, 0, 1", [*steps, 3])
    if np.abs(turn.T @ turn - np.eye(3)).max() > ORTHOGONAL or np.linalg.det(turn) < 0.0:
        raise context.error("its first three rows and columns are no rotation", steps)
    return _transform(turn, values[:3, 3].tolist())


def _turn(axis: int, angle: float) -> np.ndarray:
    c, s = _exact(math.cos(angle)), _exact(math.sin(angle))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def _exact(value: float) -> float:
    nearest = round(value)
    return float(nearest) if abs(value - nearest) < _EXACT else value


def _transform(turn: np.ndarray, place: tuple[float, ...] | list[float]) -> Transform:
    rows = [tuple(_exact(float(value)) for value in row) for row in turn]
    (a, b, c), (d, e, f), (g, h, i) = rows
    return Transform(((a, b, c), (d, e, f), (g, h, i)), (place[0], place[1], place[2]))
