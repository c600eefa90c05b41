"""Addresses of a matrix over many states whose columns are stored one after the other.

A pointer goes from column to column, by two where the rows are few. What lies a fixed distance behind it is
stored without another instruction: the distances stay in registers.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

from modelgen.backends.body import unset
from modelgen.backends.c.dialect import INDENT, arrays
from modelgen.functions.objects import Function

_REACH = 8  # rows that one pointer serves: more distances than that do not stay in registers
_PAIRED = 7  # rows up to which it serves two columns
_FOURFOLD = 4  # of what a register holds an address of x86 and Arm takes a multiple
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

    @property
    def together(self) -> int:
        """Columns that a pointer serves where it stands."""
        return 2 if self.rows <= _PAIRED else 1

    @property
    def wide(self) -> bool:
        """Whether the addresses of results are so many that those of inputs leave their registers to them."""
        return self.columns > self.rows

    def split(self, index: int) -> tuple[int, int]:
        """Row and column of an element."""
        return divmod(index, self.columns)

    def begin(self) -> list[str]:
        """Declarations of the pointers and of the distances."""
        distances = {
            self._name(r, c): r * self.columns + c
            for c in range(self.together)
            for r in range(min(self.rows, _REACH))
            if (r or c) and self._multiple(r, c) == 1
        }
        lines = [
            f"{INDENT}const size_t {name} = {self.arm}_lanes_distance({n} * n * sizeof({self.arm}_real_t));"
            for name, n in {**distances, "step": self.together}.items()
        ]
        for first in range(0, self.rows, _REACH):
            offset = f" + {first * self.columns} * n" if first else ""
            lines.append(f"{INDENT}{self.arm}_real_t *row_{first} = {self.array}{offset};")
        return lines

    def place(self, row: int, column: int) -> str:
        """Address of an element of a column to which `to` went."""
        r, c = row % _REACH, column % self.together
        if not r and not c:
            return f"row_{row}"
        times = self._multiple(r, c)
        distance = f"{times} * {self._name(r // times, c)}" if times > 1 else self._name(r, c)
        return f"{self.arm}_lanes_at(row_{row - r}, {distance})"

    def to(self, column: int) -> list[str]:
        """Statements that go to a column, and write its zeros where it is reached for the first time."""
        steps, self.column = column // self.together - self.column // self.together, column
        lines = []
        for first in range(0, self.rows, _REACH) if steps else ():
            pointer, columns = f"row_{first}", abs(steps) * self.together
            far = f"{pointer} {'+' if steps > 0 else '-'}= {columns} * n"
            next_one = f"{pointer} = {self.arm}_lanes_at({pointer}, step)"
            lines.append(f"{INDENT}{next_one if steps == 1 else far};")
        for row in self.zeros.pop(column, ()):
            zero = f"{self.arm.upper()}_K(0.0)"
            lines.append(f"{INDENT}{self.arm}_lanes_store({self.place(row, column)}, {zero});")
        return lines

    def _multiple(self, r: int, c: int) -> int:
        """How many times the distance that a register holds is one of the column where the pointer stands."""
        return _FOURFOLD if r == _FOURFOLD and not c else 1

    @staticmethod
    def _name(r: int, c: int) -> str:
        return f"down_{r}" + ("_next" if c else "")


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
