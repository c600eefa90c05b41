"""The regressor of the rigid bodies: effort per unit of each standard parameter.

Each link's 6 x 10 map from parameters to wrench is dotted with the screws of the joints before it
(Kane's form). Where this is done is free, and worth a choice for each link: at the frame's origin or
at the foot of the common normal (where the joints of a wrist meet, say), with the force part in the
link's own axes or in those of a frame before it; and columns that a joint hides from the joints before
it follow from the antecedent's by constants. `modelgen.functions` tries the plans and keeps the
cheapest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, column, dot, times
from modelgen.model.motion import LinkMotion
from modelgen.model.screws import PartialVelocities
from modelgen.model.transfer import carried_inertia, invariant_directions

Column: TypeAlias = dict[int, Expr]  # by coordinate; missing where the link is not moved by it
Table: TypeAlias = list[list[Column]]  # [link][parameter]


@dataclass(frozen=True)
class Plan:
    """How one link's columns are computed.

    slid: at the foot of the common normal, then moved along z. back: number of frames to turn the
    forces back before they meet the velocities. derived: parameters (3 YY, 8 MZ, 9 M; for a prismatic
    or fixed joint others) copied from the antecedent's columns.
    """

    slid: bool = False
    back: int = 0
    derived: frozenset[int] = frozenset()


class Regressor:
    """Columns of the regressor, link by link, under any plan; all in one graph.

    `scales` multiply the rows.
    """

    def __init__(
        self,
        frames: Frames,
        motions: Sequence[LinkMotion],
        base: LinkMotion,
        scales: Sequence[Expr] | None = None,
    ) -> None:
        self.frames = frames
        self.motions = motions
        self.base = base
        self.graph = frames.graph
        self.velocities = PartialVelocities(frames, scales)
        self._direct: dict[tuple[int, bool, int], list[Column]] = {}
        self._eliminated: dict[tuple[int, int], tuple[list[tuple[int, Expr]], list[int]]] = {}
        self.children: list[list[int]] = [[] for _ in frames.frames]
        for frame in frames.frames:
            if frame.antecedent is not None:
                self.children[frame.antecedent].append(frame.index)

    # -- what may be chosen ---------------------------------------------------------------

    def kind(self, i: int) -> str:
        """The joint of link i: "revolute", "prismatic" or "fixed"."""
        frame = self.frames[i]
        return "fixed" if frame.coordinate is None else "prismatic" if frame.prismatic else "revolute"

    def plans(self, i: int) -> list[tuple[bool, int]]:
        """The places (slid, back) that make sense for link i."""
        frame = self.frames[i]
        places = []
        for slid in (False, True) if not frame.r.is_zero and not frame.prismatic else (False,):
            places.append((slid, 0))
            point = frame.foot if slid else frame.origin
            current, back = i, 1
            while self.frames[current].antecedent is not None and back <= 3:
                places.append((slid, back))
                if any(not x.is_zero for x in point):
                    break
                current = self.frames[current].antecedent or 0
                point = self.frames[current].origin
                back += 1
        return places

    def derivable(self, i: int) -> list[int]:
        """Parameters of link i whose columns may follow from the antecedent's."""
        return [eliminated for eliminated, _ in invariant_directions(self.kind(i))]

    # -- columns --------------------------------------------------------------------------

    def columns(self, plans: Sequence[Plan]) -> Table:
        """All columns under one plan for each link."""
        table: Table = [[] for _ in self.frames.frames]
        for i in self.frames.order:
            table[i] = self._link(i, plans[i], table)
        return table

    def changed(self, table: Table, plans: Sequence[Plan], i: int) -> tuple[Table, list[int]]:
        """The table with a new plan for link i, and the links whose columns differ from `table`'s."""
        result = list(table)
        result[i] = self._link(i, plans[i], result)
        links = [i]
        for link in links:
            for child in self.children[link]:
                if plans[child].derived:
                    columns = self._link(child, plans[child], result)
                    if not _same(columns, result[child]):
                        result[child] = columns
                        links.append(child)
        return result, links

    def _link(self, i: int, plan: Plan, table: Table) -> list[Column]:
        columns = list(self.direct(i, plan.slid, plan.back))
        for k in sorted(plan.derived):
            columns[k] = self._derived(i, k, columns, table)
        return columns

    def _derived(self, i: int, k: int, own: Sequence[Column], table: Table) -> Column:
        """Column k of link i from the antecedent's columns and the link's other ones."""
        before = self.frames[i].antecedent
        carried, others = self._hidden(i, k)
        column: Column = {}
        for n in self.velocities.of_link[i]:
            total = self.graph.zero
            if before is not None and n in self.velocities.of_link[before]:
                for m, factor in carried:
                    total = total + factor * table[before][m][n]
            for m in others:
                total = total - own[m][n]
            column[n] = total
        return column

    def _hidden(self, i: int, k: int) -> tuple[list[tuple[int, Expr]], list[int]]:
        """Factors that eliminate parameter k: on the antecedent's columns, and on the link's other ones."""
        if (i, k) not in self._eliminated:
            direction = dict(invariant_directions(self.kind(i)))[k]
            p = [self.graph.const(x) for x in direction]
            carried = carried_inertia(self._axes(i), self.frames[i].origin, p)
            factors = [(m, factor) for m, factor in enumerate(carried) if not factor.is_zero]
            self._eliminated[i, k] = factors, [m for m, x in enumerate(direction) if x and m != k]
        return self._eliminated[i, k]

    def _axes(self, i: int) -> list[list[Expr]]:
        """Rotation from frame i to its antecedent's, the joint's own turn left out where it moves."""
        frame, graph = self.frames[i], self.graph
        unit = [[graph.const(int(a == b)) for b in range(3)] for a in range(3)]
        turned = [frame.to_antecedent_fixed((row[0], row[1], row[2])) for row in unit]
        return [[turned[b][a] for b in range(3)] for a in range(3)]

    def direct(self, i: int, slid: bool, back: int) -> list[Column]:
        """The ten columns of link i from its own motion."""
        key = (i, slid, back)
        if key not in self._direct:
            with self.frames.noted(i, "columns"):
                self._direct[key] = self._build(i, slid, back)
        return self._direct[key]

    def _build(self, i: int, slid: bool, back: int) -> list[Column]:
        frame, motion, graph = self.frames[i], self.motions[i], self.graph
        acceleration = self._acceleration(i, frame.foot) if slid else motion.acceleration
        forces = [column(motion.field, f) for f in range(3)] + [acceleration]
        velocities = self._velocities(i, slid, back)
        current = i
        for _ in range(back):
            forces = [self.frames[current].to_antecedent(f) for f in forces]
            current = self.frames[current].antecedent or 0
        zero = graph.zero
        ax, ay, az = acceleration
        moments: list[Vector] = [(zero, -az, ay), (az, zero, -ax), (-ay, ax, zero)]
        columns: list[Column] = [{} for _ in range(10)]
        for n, (e, _) in self.velocities.of_link[i].items():
            values = _inertia_columns(motion, e)
            v = velocities[n]
            for f, m in zip(forces, moments, strict=False):
                values.append(dot(v, f) + dot(e, m))
            values.append(dot(v, forces[3]))
            if slid:
                values = _moved_along_z(values, frame.r)
            for k, value in enumerate(values):
                columns[k][n] = value
        return columns + self._volume_columns(i)

    def _volume_columns(self, i: int) -> list[Column]:
        """Columns of VX, VY, VZ and V: gravity on the displaced fluid, upwards."""
        density = self.frames.arm.fluid_density
        if not density:
            return []
        zero = self.graph.zero
        x, y, z = self.motions[i].gravity
        moments: list[Vector] = [(zero, -z, y), (z, zero, -x), (-y, x, zero)]
        columns: list[Column] = [{} for _ in range(4)]
        for n, (e, v) in self.velocities.of_link[i].items():
            for k, moment in enumerate(moments):
                columns[k][n] = dot(e, moment) * density
            columns[3][n] = dot(v, (x, y, z)) * density
        return columns

    def _acceleration(self, i: int, point: Vector) -> Vector:
        """Acceleration of a point fixed in the antecedent, in frame i [m/s^2]."""
        frame = self.frames[i]
        parent = self.base if frame.antecedent is None else self.motions[frame.antecedent]
        return frame.to_link(add(parent.acceleration, times(parent.field, point)))

    def _velocities(self, i: int, slid: bool, back: int) -> dict[int, Vector]:
        """Velocities of the link's point per unit speed, in the axes of the frame `back` before it."""
        frame = self.frames[i]
        own = frame.coordinate
        point = frame.foot if slid else frame.origin
        if back == 0 and not slid:
            return {n: v for n, (_, v) in self.velocities.of_link[i].items()}
        carried = {n: v for n, (_, v) in self.velocities.carried(i, point).items()}
        current = i
        for _ in range(back - 1):
            current = self.frames[current].antecedent or 0
            before = self.velocities.carried(current, self.frames[current].origin)
            # a joint on the way turns about an axis through the point, where its velocity is zero,
            # or slides, and then its velocity is turned like the forces
            passed = {n: v for n, v in carried.items() if n not in before}
            carried = {n: v for n, (_, v) in before.items()}
            carried |= {n: self.frames[current].to_antecedent(v) for n, v in passed.items()}
        if back == 0:
            carried = {n: frame.to_link(v) for n, v in carried.items()}
        if own is not None:
            v = self.velocities.own(i)[1]
            carried[own] = v if back == 0 else frame.to_antecedent(v)
        return carried


def _same(a: Sequence[Column], b: Sequence[Column]) -> bool:
    return all(
        x.keys() == y.keys() and all(x[n].key == y[n].key for n in x) for x, y in zip(a, b, strict=True)
    )


def _inertia_columns(motion: LinkMotion, e: Vector) -> list[Expr]:
    """Columns of XX ... ZZ dotted with the angular velocity e."""
    u, (ax, ay, az) = motion.field, motion.axial
    syz, sxz, sxy = motion.products[1]
    dx, dy, dz = motion.stretch
    x, y, z = e
    return [
        x * ax + (y * sxz - z * sxy),
        y * u[2][1] - x * u[2][0] + z * dz,
        x * u[1][0] - z * u[1][2] + y * dy,
        y * ay + (z * sxy - x * syz),
        z * u[0][2] - y * u[0][1] + x * dx,
        z * az + (x * syz - y * sxz),
    ]


def _moved_along_z(values: Sequence[Expr], r: Expr) -> list[Expr]:
    """Columns about a point r below the origin turned into columns about the origin."""
    xx, xy, xz, yy, yz, zz, mx, my, mz, m = values
    rod = xx + yy
    moments = [mx - r * xz, my - r * yz, mz + (r * 2.0) * rod]
    return [xx, xy, xz, yy, yz, zz, *moments, m + r * mz + (r * r) * rod]
