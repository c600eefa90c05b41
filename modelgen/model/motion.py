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

from modelgen.geometry import Frame, Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Matrix, Vector, add, cross, times


@dataclass(frozen=True)
class LinkMotion:
    """Motion of one link in its frame.

    A point r of the link accelerates by `acceleration` + U r, where U = [reference derivative]x
    + [reference]x [velocity]x, 3 x 3 [1/s^2], is kept as its symmetric part (products of the two
    velocities) and the axial vector of its antisymmetric part.
    """

    velocity: Vector  # [rad/s] of the motion itself
    reference: Vector  # [rad/s] of the reference motion; the same object without one
    axial: Vector  # [rad/s^2]; without a reference motion the angular acceleration
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
    def field(self) -> Matrix:
        """U."""
        (xx, yy, zz), (yz, xz, xy) = self.products
        x, y, z = self.axial
        return (
            (-(yy + zz), xy - z, xz + y),
            (xy + z, -(xx + zz), yz - x),
            (xz - y, yz + x, -(xx + yy)),
        )

    @cached_property
    def stretch(self) -> Vector:
        """Differences of the diagonal of U: (U22 - U33, U33 - U11, U11 - U22)."""
        xx, yy, zz = self.products[0]
        return (yy - zz, zz - xx, xx - yy)


@dataclass(frozen=True)
class Rates:
    """Joint rates in the graph, one entry per coordinate; `reference` defaults to `dq`."""

    dq: Sequence[Expr]
    ddq: Sequence[Expr]
    reference: Sequence[Expr] | None = None


@dataclass(frozen=True)
class Own:
    """Rates of one frame against its antecedent: as of `Rates`; `reference` None where none runs along."""

    dq: Expr
    ddq: Expr
    reference: Expr | None = None


def of_links(frames: Frames, rates: Rates) -> Rates:
    """Rates of the links where they stay behind their drives; accelerations stay the drives'."""
    if not frames.lag_rates:
        return rates

    def less(values: Sequence[Expr]) -> list[Expr]:
        lags = frames.lag_rates
        return [x - lags[n] if n in lags else x for n, x in enumerate(values)]

    reference = None if rates.reference is None else less(rates.reference)
    return Rates(less(rates.dq), rates.ddq, reference)


def origin_velocities(frames: Frames, rates: Rates, spins: Sequence[Vector]) -> list[Vector]:
    """Velocity of every frame's origin in its axes [m/s]; spins: angular velocities of the links."""
    zero = frames.graph.zero
    moving = of_links(frames, rates)
    found: dict[int, Vector] = {}
    for i in frames.order:
        frame, before = frames[i], frames[i].antecedent
        v: Vector = (zero, zero, zero)
        with frames.noted(i, "velocity of its origin"):
            if before is not None:
                v = frame.to_link(add(found[before], cross(spins[before], frame.origin)))
            if frame.coordinate is not None and frame.prismatic:
                v = (v[0], v[1], v[2] + moving.dq[frame.coordinate])
        found[i] = v
    return [found[i] for i in range(len(frames.frames))]


def base_motion(frames: Frames) -> LinkMotion:
    """The base at rest, accelerated against gravity."""
    graph = frames.graph
    x, y, z = (frames.scalars(component) for component in frames.arm.gravity)
    zero: Vector = (graph.zero, graph.zero, graph.zero)
    return LinkMotion(zero, zero, zero, (-x, -y, -z), (x, y, z))


def link_motions(frames: Frames, rates: Rates) -> list[LinkMotion]:
    """The motion of every link, indexed as `arm.joints`."""
    rates = of_links(frames, rates)
    motions: dict[int | None, LinkMotion] = {None: base_motion(frames)}
    for i in frames.order:
        frame = frames[i]
        with frames.noted(i, "motion"):
            motions[i] = moved(frame, motions[frame.antecedent], _own(rates, frame.coordinate))
    return [motions[i] for i in range(len(frames.frames))]


def _own(rates: Rates, n: int | None) -> Own | None:
    if n is None:
        return None
    return Own(rates.dq[n], rates.ddq[n], None if rates.reference is None else rates.reference[n])


def moved(frame: Frame, parent: LinkMotion, own: Own | None) -> LinkMotion:
    """The motion in a frame that moves against its antecedent, or stands still there."""
    velocity = frame.to_link(parent.velocity)
    reference = velocity if parent.reference is parent.velocity else frame.to_link(parent.reference)
    axial = frame.to_link(parent.axial)
    acceleration = frame.to_link(add(parent.acceleration, times(parent.field, frame.origin)))
    gravity = frame.to_link(parent.gravity)
    if own is None:
        return LinkMotion(velocity, reference, axial, acceleration, gravity)
    dq, ddq = own.dq, own.ddq
    dr = dq if own.reference is None else own.reference
    # derivative of the axis' direction, times the rates
    x = velocity[1] * dr + reference[1] * dq
    y = -(velocity[0] * dr + reference[0] * dq)
    if frame.prismatic:
        acceleration = (acceleration[0] + x, acceleration[1] + y, acceleration[2] + ddq)
        return LinkMotion(velocity, reference, axial, acceleration, gravity)
    along = _axis_in_antecedent(frame)
    spun = (velocity[0], velocity[1], velocity[2] + dq)
    spun_reference = spun if own.reference is None else (reference[0], reference[1], reference[2] + dr)
    turned = (axial[0] + x * 0.5, axial[1] + y * 0.5, axial[2] + ddq)
    if along is not None:
        # Points of the axis belong to both links: U z is the antecedent's. That spares the terms
        # of the joint's own rate, where z is an axis of the antecedent's frame.
        u13, u23, _ = frame.to_link(times(parent.field, along))
        yz, xz, _ = LinkMotion(spun, spun_reference, turned, acceleration, gravity).products[1]
        turned = (yz - u23, u13 - xz, turned[2])
    return LinkMotion(spun, spun_reference, turned, acceleration, gravity)


def _axis_in_antecedent(frame: Frame) -> Vector | None:
    """The joint's axis in the antecedent's frame where it is one of that frame's axes."""
    zero = frame.r * 0.0
    one = zero + 1.0
    axis = frame.to_antecedent_fixed((zero, zero, one))
    return axis if all(x.value in (0.0, 1.0, -1.0) for x in axis) else None
