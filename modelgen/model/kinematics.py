"""Poses of links and tools and their Jacobians, in the world: the base frame of most arms."""

from __future__ import annotations

from modelgen.description.objects import Transform
from modelgen.geometry import Frames
from modelgen.graph import Expr, Graph
from modelgen.graph.vectors import Matrix, Vector, add, column, cross, times

Pose = tuple[Matrix, Vector]


def link_poses(frames: Frames) -> list[Pose]:
    """Rotation world <- link and origin [m] of every link, in the world."""
    graph = frames.graph
    one, zero = graph.one, graph.zero
    identity: Matrix = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
    base = (identity, (zero, zero, zero)) if frames.arm.base is None else constant(graph, frames.arm.base)
    poses: dict[int | None, Pose] = {None: base}
    for i in frames.order:
        frame = frames[i]
        rotation, origin = poses[frame.antecedent]
        # a row of R_parent R is the row of R_parent, a vector of the antecedent, turned to the link
        with frames.noted(i, "pose"):
            turned = (frame.to_link(rotation[0]), frame.to_link(rotation[1]), frame.to_link(rotation[2]))
            poses[i] = turned, add(origin, times(rotation, frame.origin))
    return [poses[i] for i in range(len(frames.frames))]


def constant(graph: Graph, given: Transform) -> Pose:
    """A transform of the description in the graph."""

    def vector(values: tuple[float, float, float]) -> Vector:
        return graph.const(values[0]), graph.const(values[1]), graph.const(values[2])

    a, b, c = given.rotation
    return (vector(a), vector(b), vector(c)), vector(given.translation)


def tool_poses(frames: Frames) -> list[Pose]:
    """Poses of every tool of the arm."""
    links = link_poses(frames) if frames.arm.tools else []
    poses = []
    for tool in frames.arm.tools:
        rotation, origin = links[tool.link]
        turn, place = constant(frames.graph, tool.transform)
        columns = [times(rotation, column(turn, k)) for k in range(3)]
        x, y, z = ((columns[0][k], columns[1][k], columns[2][k]) for k in range(3))
        poses.append(((x, y, z), add(origin, times(rotation, place))))
    return poses


def transform(pose: Pose) -> list[Expr]:
    """A pose as a homogeneous 4 x 4 matrix, row-major."""
    rotation, origin = pose
    graph = origin[0].graph
    rows = [[*rotation[k], origin[k]] for k in range(3)]
    return [e for row in rows for e in row] + [graph.zero, graph.zero, graph.zero, graph.one]


def jacobian(frames: Frames, link: int, target: Vector | None = None) -> list[list[Expr]]:
    """6 x n: velocity of the link's origin over its angular velocity, world axes, per joint speed.

    target: another place [m] on the link instead of its origin, in the world.
    """
    poses = link_poses(frames)
    target = poses[link][1] if target is None else target
    zero = frames.graph.zero
    rows = [[zero] * len(frames.coordinates) for _ in range(6)]
    for i in frames.path(link):
        frame = frames[i]
        n = frame.coordinate
        if n is None:
            continue
        rotation, origin = poses[i]
        axis = column(rotation, 2)
        if frame.prismatic:
            parts: tuple[Expr, ...] = (*axis, zero, zero, zero)
        else:
            away = (target[0] - origin[0], target[1] - origin[1], target[2] - origin[2])
            parts = (*cross(axis, away), *axis)
        for k, part in enumerate(parts):
            rows[k][n] = part
    return rows
