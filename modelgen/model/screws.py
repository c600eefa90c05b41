"""Partial velocities: what a unit speed of one joint does to a link (Kane and Levinson 1983)."""

from __future__ import annotations

from modelgen.geometry import Frames
from modelgen.graph.vectors import Vector, add, cross

Screw = tuple[Vector, Vector]  # angular velocity, velocity of a point


class PartialVelocities:
    """Screws of every link, by coordinate; only the coordinates that move the link are listed."""

    def __init__(self, frames: Frames) -> None:
        self.frames = frames
        graph = frames.graph
        self._zero: Vector = (graph.zero, graph.zero, graph.zero)
        self._z: Vector = (graph.zero, graph.zero, graph.one)
        self.of_link: list[dict[int, Screw]] = [{} for _ in frames.frames]
        for i in frames.order:
            frame = frames[i]
            for n, (e, v) in self.carried(i, frame.origin).items():
                self.of_link[i][n] = frame.to_link(e), frame.to_link(v)
            if frame.coordinate is not None:
                self.of_link[i][frame.coordinate] = self.own(i)

    def own(self, i: int) -> Screw:
        """The screw of the link's own joint at any point of its axis, in the link's frame."""
        return (self._zero, self._z) if self.frames[i].prismatic else (self._z, self._zero)

    def carried(self, i: int, point: Vector) -> dict[int, Screw]:
        """Screws of the joints before link i at `point`, in the axes of the antecedent's frame."""
        antecedent = self.frames[i].antecedent
        if antecedent is None:
            return {}
        return {n: (e, add(v, cross(e, point))) for n, (e, v) in self.of_link[antecedent].items()}
