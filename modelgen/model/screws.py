"""Partial velocities: what a unit speed of one joint does to a link (Kane and Levinson 1983)."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross

Screw = tuple[Vector, Vector]  # angular velocity, velocity of a point


class PartialVelocities:
    """Screws of every link, by coordinate; only the coordinates that move the link are listed.

    `scales` multiply the joints' speeds: a row of the regressor in another unit costs least so.
    """

    def __init__(self, frames: Frames, scales: Sequence[Expr] | None = None) -> None:
        self.frames = frames
        self.scales = scales
        graph = frames.graph
        self._zero: Vector = (graph.zero, graph.zero, graph.zero)
        self.of_link: list[dict[int, Screw]] = [{} for _ in frames.frames]
        for i in frames.order:
            frame = frames[i]
            with frames.noted(i, "velocities by those of the joints"):
                for n, (e, v) in self.carried(i, frame.origin).items():
                    self.of_link[i][n] = frame.to_link(e), frame.to_link(v)
            if frame.coordinate is not None:
                self.of_link[i][frame.coordinate] = self.own(i)

    def own(self, i: int) -> Screw:
        """The screw of the link's own joint at any point of its axis, in the link's frame."""
        frame = self.frames[i]
        unit = self.frames.graph.one
        if self.scales is not None and frame.coordinate is not None:
            unit = self.scales[frame.coordinate]
        along: Vector = (self._zero[0], self._zero[0], unit)
        return (self._zero, along) if frame.prismatic else (along, self._zero)

    def carried(self, i: int, point: Vector) -> dict[int, Screw]:
        """Screws of the joints before link i at `point`, in the axes of the antecedent's frame."""
        antecedent = self.frames[i].antecedent
        if antecedent is None:
            return {}
        return {n: (e, add(v, cross(e, point))) for n, (e, v) in self.of_link[antecedent].items()}
