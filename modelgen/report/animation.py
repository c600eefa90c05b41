"""A motion for the eye: one HTML file that needs nothing beside it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.backends import NumpyFunction
from modelgen.description.objects import Arm
from modelgen.numeric import Array
from modelgen.resources import templates_folder
from modelgen.simulation.plant import Plant

_FRAMES_PER_SECOND = 30
_MOST = 1800  # frames


def animation(plant: Plant, t: Array, q: Array) -> str:
    """HTML with a drawing of the arm that plays, pauses, steps and turns.

    t: (S,) [s], q: (S, n) [rad, m]. Thirty pictures a second, at most 1,800 in all.
    """
    count = min(_MOST, max(2, round(float(t[-1] - t[0]) * _FRAMES_PER_SECOND) + 1))
    at = np.linspace(t[0], t[-1], count)
    shown = np.stack([np.interp(at, t, q[:, k]) for k in range(plant.n)], axis=1)
    points = places(plant, shown)
    reach = float(np.abs(points).max()) or 1.0
    digits = 4 - int(np.floor(np.log10(reach)))
    data: dict[str, Any] = {
        "t": np.round(at, 4).tolist(),
        "points": np.round(points, digits).tolist(),
        "lines": lines(plant.arm),
        "up": _up(plant.arm),
    }
    environment = Environment(
        loader=FileSystemLoader(templates_folder()), undefined=StrictUndefined, autoescape=True
    )
    template = environment.get_template("report/animation.html.j2")
    return template.render(arm=plant.arm.name, data=Markup(json.dumps(data, separators=(",", ":")))) + "\n"


def places(plant: Plant, q: Array) -> Array:
    """Points of the drawing (F, 1 + 2 J, 3) [m] in the world: base, then origin and tip of each link."""
    function = NumpyFunction(next(f for f in plant.model.functions if f.name == "forward_kinematics"))
    found = function(q)
    poses = np.stack(found if isinstance(found, tuple) else [found], axis=1)
    poses = poses.reshape(len(q), -1, 4, 4)[:, : len(plant.arm.joints)]  # tools come after the links
    result = np.zeros((len(q), 1 + 2 * poses.shape[1], 3))
    if plant.arm.base is not None:
        result[:, 0] = plant.arm.base.translation
    tips = _tips(plant.arm, float(np.linalg.norm(poses[:, :, :3, 3], axis=-1).max()))
    for i in range(poses.shape[1]):
        result[:, 1 + 2 * i] = poses[:, i, :3, 3]
        result[:, 2 + 2 * i] = poses[:, i, :3, 3] + poses[:, i, :3, :3] @ tips[i]
    return result


def lines(arm: Arm) -> list[list[int]]:
    """Pairs of points to be joined, the joint first: antecedent to link, and a last link to its tip."""
    carried = {joint.antecedent for joint in arm.joints}
    found = []
    for i, joint in enumerate(arm.joints):
        before = joint.antecedent
        found.append([0 if before is None else 1 + 2 * before, 1 + 2 * i])
        if i not in carried:
            found.append([1 + 2 * i, 2 + 2 * i])
    return found


def _tips(arm: Arm, reach: float) -> list[Array]:
    """Tips of links in their frames: twice as far as the centre of mass; a short line where it is unknown."""
    stub = np.array([0.15 * (reach or 1.0), 0.0, 0.0])
    return [stub if link is None or not any(link.com) else 2.0 * np.array(link.com) for link in arm.links]


def _up(arm: Arm) -> list[float]:
    """The direction against gravity; z without gravity."""
    g = -np.array(arm.gravity, dtype=float)
    if arm.base is not None:
        g = np.array(arm.base.rotation) @ g
    size = float(np.linalg.norm(g))
    return (g / size).tolist() if size else [0.0, 0.0, 1.0]
