"""Where the links are and how they move with the joints, in base axes."""

from __future__ import annotations

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Matrix, Vector, add, column, cross, times


def link_poses(frames: Frames) -> list[tuple[Matrix, Vector]]:
    """Rotation base <- link and origin [m] of every link, in the base frame."""
    graph = frames.graph
    one, zero = graph.one, graph.zero
    identity: Matrix = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
    poses: dict[int | None, tuple[Matrix, Vector]] = {None: (identity, (zero, zero, zero))}
    for i in frames.order:
        frame = frames[i]
        rotation, origin = poses[frame.antecedent]
        # a row of R_parent R is the row of R_parent, a vector of the antecedent, turned to the link
        turned = (frame.to_link(rotation[0]), frame.to_link(rotation[1]), frame.to_link(rotation[2]))
        poses[i] = turned, add(origin, times(rotation, frame.origin))
    return [poses[i] for i in range(len(frames.frames))]


def transform(pose: tuple[Matrix, Vector]) -> list[Expr]:
    """A pose as a homogeneous 4 x 4 matrix, row-major."""
    rotation, origin = pose
    graph = origin[0].graph
    rows = [[*rotation[k], origin[k]] for k in range(3)]
    return [e for row in rows for e in row] + [graph.zero, graph.zero, graph.zero, graph.one]


def jacobian(frames: Frames, link: int) -> list[list[Expr]]:
    """6 x n: velocity of the link's origin over its angular velocity, base axes, per joint speed."""
    poses = link_poses(frames)
    target = poses[link][1]
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
