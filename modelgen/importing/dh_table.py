"""Tables of standard Denavit-Hartenberg parameters, as CSV.

T(i-1 -> i) = Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha) (Denavit and Hartenberg 1955; Siciliano,
Sciavicco, Villani and Oriolo 2009, section 2.8.2): joint i turns about z of frame i-1, or slides along it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modelgen.description.expressions import ExpressionError, evaluate
from modelgen.description.plausible import MOST
from modelgen.errors import InputError, Location
from modelgen.importing.dh_cells import Cell, Column, columns_of, rows_of, without_variable
from modelgen.importing.poses import inverse, pose, rotation
from modelgen.importing.robot import Robot, SourceJoint, SourceLink
from modelgen.importing.rounded import Rounding
from modelgen.numeric import Array

_TYPES = {
    **dict.fromkeys(("revolute", "r", "rotary", "rotational"), "revolute"),
    **dict.fromkeys(("prismatic", "p", "linear", "slide"), "prismatic"),
    **dict.fromkeys(("fixed", "f"), "fixed"),
}
_KINDS = {"a": "length", "d": "length", "alpha": "angle", "theta": "angle"}
_Z = np.array([0.0, 0.0, 1.0])


def read_dh_table(path: Path, text: str, rounding: Rounding) -> Robot:
    """The chain of a table: a row per joint, columns a, alpha, d, theta in any order.

    Raises InputError, with line and column, at the first mistake.
    """
    header, *lines = rows_of(str(path), text)
    columns = columns_of(header)
    if not lines:
        where = Location(str(path), header[0].where.line, 1)
        raise InputError("the table has a header and no rows, expected a row per joint", where)
    rows = [_Row(cells, columns, rounding) for cells in lines]
    marked = any(row.variable for row in rows)
    joints: list[SourceJoint] = []
    for k, row in enumerate(rows):
        joint = row.joint(k, marked)
        if any(other.name == joint.name for other in joints):
            raise row.error("name", f"two joints are called '{joint.name}'")
        joints.append(joint)
    names = [f"frame{k}" for k in range(len(joints) + 1)]
    return Robot(
        name=path.stem,
        form="standard DH table",
        root=names[0],
        links={name: SourceLink(name) for name in names},
        joints=tuple(joints),
        remarks=(
            "read in the standard convention, where joint i turns about z of frame i-1; a table of the "
            "modified one goes into arms.yaml as it stands (alpha, d: a, theta, r: d)",
        ),
        inertials=False,
    )


@dataclass
class _Row:
    cells: Sequence[Cell]
    columns: dict[str, Column]
    rounding: Rounding

    def __post_init__(self) -> None:
        """The coordinate's own place in the row: "d", "theta" or "" where it is not marked."""
        marked = [name for name in ("d", "theta") if without_variable(self.cell(name)) is not None]
        if len(marked) > 1:
            raise self.error("d", "found a variable in d and in theta, expected one coordinate per joint")
        self.variable = marked[0] if marked else ""

    def cell(self, name: str) -> Cell:
        """The cell of a column that is there."""
        return self.cells[self.columns[name].index]

    def error(self, name: str, message: str) -> InputError:
        """The InputError at a cell, at the row's begin where there is no such column."""
        cell = self.cell(name) if name in self.columns else self.cells[0]
        return InputError(message, cell.where)

    def joint(self, k: int, marked: bool) -> SourceJoint:
        """Joint k + 1. marked: whether any row of the table says which of its figures is the coordinate."""
        kind = self._kind(marked)
        a, alpha, d, theta = (self._figure(name) for name in ("a", "alpha", "d", "theta"))
        first = pose(rotation(2, theta), np.array([0.0, 0.0, d]))
        frame: Array = first @ pose(rotation(0, alpha), np.array([a, 0.0, 0.0]))
        back = inverse(frame)
        return SourceJoint(
            name=self._name(k),
            kind=kind,
            parent=f"frame{k}",
            child=f"frame{k + 1}",
            pose=frame,
            axis=back[:3, :3] @ _Z,
            anchor=back[:3, 3],
            position=self._range(kind),
            velocity=self._most("velocity", kind),
            effort=self._most("effort", kind),
            line=self.cells[0].where.line,
        )

    def _kind(self, marked: bool) -> str:
        by_mark = {"d": "prismatic", "theta": "revolute", "": "fixed" if marked else "revolute"}[
            self.variable
        ]
        if "type" not in self.columns or not self.cell("type").text:
            return by_mark
        word = self.cell("type").text.lower()
        if word not in _TYPES:
            raise self.error("type", f"found the type '{word[:40]}', expected revolute, prismatic or fixed")
        kind = _TYPES[word]
        if self.variable and kind != by_mark:
            raise self.error("type", f"found {kind}, but the row has its variable in {self.variable}")
        return kind

    def _name(self, k: int) -> str:
        text = self.cell("name").text if "name" in self.columns else ""
        return f"j{text}" if text.isdecimal() else text or f"j{k + 1}"

    def _figure(self, name: str) -> float:
        cell = self.cell(name)
        if name == self.variable:
            cell = without_variable(cell) or cell
        return self._value(name, cell, _KINDS[name])

    def _range(self, kind: str) -> tuple[float, float] | None:
        ends = [self._optional(name, kind) for name in ("lower", "upper")]
        if kind == "fixed" or ends == [None, None]:
            return None
        low, high = ends
        if low is None or high is None or low >= high:
            raise self.error("lower", "expected lower and upper, the lower one first")
        return low, high

    def _most(self, name: str, kind: str) -> float | None:
        value = self._optional(name, "plain" if name == "effort" else kind)
        if value is not None and value <= 0:
            raise self.error(name, f"{name}: found {value:g}, expected a number above 0")
        return value

    def _optional(self, name: str, kind: str) -> float | None:
        if name not in self.columns or not self.cell(name).text:
            return None
        unit = {"prismatic": "length", "plain": "plain"}.get(kind, "angle")
        return self._value(name, self.cell(name), unit)

    def _value(self, name: str, cell: Cell, kind: str) -> float:
        if not cell.text:
            raise InputError(f"{name}: the cell is empty, expected a number", cell.where)
        unit = self.columns[name].unit
        try:
            value = evaluate(cell.text, kind).value
            if unit and unit != "rad" and _plain(cell.text):
                return evaluate(f"({cell.text}) {unit}", kind).value
        except ExpressionError as error:
            raise InputError(f"{name}: found '{cell.text[:40]}': {error}", cell.where) from None
        number = _number(cell.text)
        if number is None:
            return value
        if (
            not unit
            and kind in MOST
            and abs(value) > (2 * MOST[kind] if name in ("lower", "upper", "velocity") else MOST[kind])
        ):
            units = '"deg" or "rad"' if kind == "angle" else '"mm" or "m"'
            shown = "alpha [deg]" if kind == "angle" else "a [mm]"
            raise InputError(
                f"{name}: found {value:g}, too large for {'rad' if kind == 'angle' else 'm'}: write {units} "
                f"behind it, or into the header, as {shown}",
                cell.where,
            )
        return self.rounding.angle(cell.text, value) if kind == "angle" else value


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _plain(text: str) -> bool:
    """Whether a text has no unit of its own: one put behind it would then be the first."""
    try:
        evaluate(text, "plain")
    except ExpressionError:
        return False
    return True
