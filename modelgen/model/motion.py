"""How every link moves: the forward recursion of Newton and Euler.

All quantities of link j are in frame j, at its origin. Gravity enters as an acceleration of the
base. A second, "reference" velocity may run along (Slotine and Li 1987): the acceleration is then
the inertial derivative of the velocity field that the reference velocity alone would give, so that
the Coriolis matrix C implied by it keeps dM/dt - 2 C skew-symmetric.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Matrix, Vector, add, cross, times


@dataclass(frozen=True)
class LinkMotion:
    """Angular velocity and its derivative, acceleration of the origin, gravity; all in frame j.

    A point r of the link accelerates by `acceleration` + `field` r.
    """

    velocity: Vector  # [rad/s] of the motion itself
    reference: Vector  # [rad/s] of the reference motion; the same object without one
    derivative: Vector  # [rad/s^2] inertial derivative of `reference`
    acceleration: Vector  # [m/s^2] of the origin, less gravity
    gravity: Vector  # [m/s^2]

    @cached_property
    def products(self) -> tuple[Vector, Vector]:
        """Symmetric products of the two velocities: (xx, yy, zz) and (yz, xz, xy)."""
        w, v = self.velocity, self.reference
        squares = (w[0] * v[0], w[1] * v[1], w[2] * v[2])
        if w is v:
            return squares, (w[1] * w[2], w[0] * w[2], w[0] * w[1])
        mixed = [(w[i] * v[j] + w[j] * v[i]) * 0.5 for i, j in ((1, 2), (0, 2), (0, 1))]
        return squares, (mixed[0], mixed[1], mixed[2])

    @cached_property
    def axial(self) -> Vector:
        """Axial vector of the antisymmetric part of `field`."""
        d = self.derivative
        if self.velocity is self.reference:
            return d
        half = cross(self.velocity, self.reference)
        return (d[0] - half[0] * 0.5, d[1] - half[1] * 0.5, d[2] - half[2] * 0.5)

    @cached_property
    def field(self) -> Matrix:
        """U = [derivative]x + [reference]x [velocity]x, 3 x 3 [1/s^2]."""
        (xx, yy, zz), (yz, xz, xy) = self.products
        x, y, z = self.axial
        return (
            (-(yy + zz), xy - z, xz + y),
            (xy + z, -(xx + zz), yz - x),
            (xz - y, yz + x, -(xx + yy)),
        )

    @cached_property
    def stretch(self) -> Vector:
        """Differences of the diagonal of `field`: (U22 - U33, U33 - U11, U11 - U22)."""
        xx, yy, zz = self.products[0]
        return (yy - zz, zz - xx, xx - yy)


@dataclass(frozen=True)
class Rates:
    """Joint rates in the graph, one entry per coordinate; `reference` defaults to `dq`."""

    dq: Sequence[Expr]
    ddq: Sequence[Expr]
    reference: Sequence[Expr] | None = None


def link_motions(frames: Frames, rates: Rates, gravity: Sequence[float] | None = None) -> list[LinkMotion]:
    """The motion of every link, indexed as `arm.joints`.

    `gravity` [m/s^2] in the base frame replaces the arm's own.
    """
    graph = frames.graph
    g = [graph.const(x) for x in (frames.arm.gravity if gravity is None else gravity)]
    zero: Vector = (graph.zero, graph.zero, graph.zero)
    base = LinkMotion(zero, zero, zero, (-g[0], -g[1], -g[2]), (g[0], g[1], g[2]))
    motions: dict[int | None, LinkMotion] = {None: base}
    for i in frames.order:
        motions[i] = _link_motion(frames, i, motions[frames[i].antecedent], rates)
    return [motions[i] for i in range(len(frames.frames))]


def _link_motion(frames: Frames, i: int, parent: LinkMotion, rates: Rates) -> LinkMotion:
    frame = frames[i]
    single = rates.reference is None
    velocity = frame.to_link(parent.velocity)
    reference = velocity if single else frame.to_link(parent.reference)
    derivative = frame.to_link(parent.derivative)
    carried = add(parent.acceleration, times(parent.field, frame.origin))
    acceleration = frame.to_link(carried)
    gravity = frame.to_link(parent.gravity)
    n = frame.coordinate
    if n is not None:
        dq, ddq = rates.dq[n], rates.ddq[n]
        dr = dq if rates.reference is None else rates.reference[n]
        if frame.prismatic:
            x, y, z = acceleration
            w, v = velocity, reference
            acceleration = (x + w[1] * dr + v[1] * dq, y - w[0] * dr - v[0] * dq, z + ddq)
        else:
            x, y, z = derivative
            derivative = (x + velocity[1] * dr, y - velocity[0] * dr, z + ddq)
            velocity = (velocity[0], velocity[1], velocity[2] + dq)
            reference = velocity if single else (reference[0], reference[1], reference[2] + dr)
    return LinkMotion(velocity, reference, derivative, acceleration, gravity)
