"""Addresses of a matrix over many states whose columns are stored one after the other.

A row's element is a fixed distance from the column's first one. The distances stay in registers, a pointer
goes from column to column, and a store then takes no other instruction.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

from modelgen.backends.body import unset
from modelgen.backends.c.dialect import INDENT, arrays
from modelgen.functions.objects import Function

_REACH = 8  # rows that one pointer serves: more distances than that do not stay in registers
_LEAST = 2  # elements stored in a column, on average, from which on it pays


@dataclass
class ColumnWalk:
    """Where the pointers are while a function's statements are written.

    zeros: by column, rows of the elements that are always zero, until they are written.
    """

    arm: str
    array: str
    rows: int
    columns: int
    zeros: dict[int, list[int]]
    column: int = field(default=0, init=False)

    def split(self, index: int) -> tuple[int, int]:
        """Row and column of an element."""
        return divmod(index, self.columns)

    def begin(self) -> list[str]:
        """Declarations of the pointers and of the distances."""
        lines = [f"{INDENT}const size_t one = {self.arm}_lanes_distance(n);"]
        lines += [
            f"{INDENT}const size_t down_{r} = {self.arm}_lanes_distance({r * self.columns} * n);"
            for r in range(1, min(self.rows, _REACH))
        ]
        for first in range(0, self.rows, _REACH):
            offset = f" + {first * self.columns} * n" if first else ""
            lines.append(f"{INDENT}{self.arm}_real_t *row_{first} = {self.array}{offset};")
        return lines

    def place(self, row: int) -> str:
        """Address of an element of the column."""
        distance = row % _REACH
        return f"row_{row - distance}" + (f" + down_{distance}" if distance else "")

    def to(self, column: int) -> list[str]:
        """Statements that go to a column, and write its zeros where it is reached for the first time."""
        steps, self.column = column - self.column, column
        lines = []
        for first in range(0, self.rows, _REACH) if steps else ():
            by = f"+= {'' if steps == 1 else f'{steps} * '}one" if steps > 0 else f"-= {-steps} * one"
            lines.append(f"{INDENT}row_{first} {by};")
        for row in self.zeros.pop(column, ()):
            zero = f"{self.arm.upper()}_K(0.0)"
            lines.append(f"{INDENT}{self.arm}_lanes_store({self.place(row)}, {zero});")
        return lines


def column_walk(arm: str, function: Function) -> ColumnWalk | None:
    """A walk over the matrix of a function that gives one, column after column; None for other functions."""
    output = function.outputs[0]
    if len(function.outputs) > 1 or output.columns == 1:
        return None
    targets = [s.target for s in function.program.statements]
    columns = [t[1] % output.columns for t in targets if isinstance(t, tuple) and t[0] == output.name]
    changes = sum(a != b for a, b in pairwise(columns))
    if len(columns) < _LEAST * changes:
        return None
    zeros: dict[int, list[int]] = {}
    for index in unset(function)[output.name]:
        zeros.setdefault(index % output.columns, []).append(index // output.columns)
    (array,) = arrays(function)
    return ColumnWalk(arm, array, output.rows, output.columns, zeros)
