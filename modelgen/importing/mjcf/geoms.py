"""Mass and inertia of MuJoCo's simple shapes, for bodies without <inertial>."""

from __future__ import annotations

import math

import numpy as np

from modelgen.importing.mjcf.settings import Compiler, along_z
from modelgen.importing.poses import pose
from modelgen.importing.robot import Body
from modelgen.importing.xml_text import Element
from modelgen.numeric import Array

DENSITY = 1000.0  # kg/m^3, MuJoCo's default
_SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3, "box": 3}


def geom_body(geom: Element, compiler: Compiler, frame: Array) -> Body | None:
    """What a geom weighs, in the frame that `frame` (4, 4) gives it; None for nothing.

    Raises InputError for shapes whose inertia needs more than their sizes: meshes, height fields.
    """
    given = geom.attributes
    if "mass" in given and geom.number("mass") == 0.0:
        return None
    if "mass" not in given and geom.number("density", DENSITY) == 0.0:
        return None
    kind = given.get("type", "sphere")
    if kind == "plane":
        return None
    if kind not in _SIZES or "mesh" in given or given.get("shellinertia") == "true":
        raise geom.error(
            f"a geom of type '{kind}' gives its body its inertia: only simple shapes are known; "
            "give the body an <inertial>"
        )
    size, place = _placed(geom, kind, compiler)
    volume, per_mass = _shape(kind, size)
    mass = geom.number("mass") if "mass" in given else volume * geom.number("density", DENSITY)
    turned = (frame @ place)[:3, :3]
    return Body(mass, (frame @ place)[:3, 3], turned @ np.diag(mass * per_mass) @ turned.T)


def _placed(geom: Element, kind: str, compiler: Compiler) -> tuple[list[float], Array]:
    """Half sizes [m] and pose of a shape, which may be given by its two ends."""
    sizes = [float(text) for text in geom.text("size").split()]
    if "fromto" in geom.attributes and kind != "sphere":
        ends = geom.vector("fromto", 6)
        start, end = ends[:3], ends[3:]
        length = float(np.linalg.norm(end - start))
        half = [length / 2] if kind in ("capsule", "cylinder") else [sizes[0], length / 2]
        return [sizes[0], *half], pose(along_z(end - start), (start + end) / 2)
    if len(sizes) < _SIZES[kind]:
        raise geom.error(f"<geom size>: found {len(sizes)} values, expected {_SIZES[kind]} for a {kind}")
    return sizes, compiler.pose(geom)


def _shape(kind: str, size: list[float]) -> tuple[float, Array]:
    """Volume [m^3], and principal moments by mass [m^2]."""
    if kind == "sphere":
        r = size[0]
        return 4 / 3 * math.pi * r**3, np.full(3, 0.4 * r * r)
    if kind in ("cylinder", "capsule"):
        r, h = size[0], 2 * size[1]
        volume, across, along = math.pi * r * r * h, (3 * r * r + h * h) / 12, r * r / 2
        if kind == "cylinder":
            return volume, np.array([across, across, along])
        # a cylinder and two halves of a ball
        ball = 4 / 3 * math.pi * r**3
        part = ball / (ball + volume)
        across = (1 - part) * across + part * (0.4 * r * r + h * (3 * r + 2 * h) / 8)
        return ball + volume, np.array([across, across, (1 - part) * along + part * 0.4 * r * r])
    a, b, c = (x * x for x in size[:3])
    sums = np.array([b + c, a + c, a + b])
    if kind == "box":
        return 8 * math.prod(size[:3]), sums / 3
    return 4 / 3 * math.pi * math.prod(size[:3]), sums / 5
