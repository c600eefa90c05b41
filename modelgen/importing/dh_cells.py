"""The cells of a table of Denavit-Hartenberg parameters: header, units, marks of the variable."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.description.expressions import UNITS
from modelgen.errors import InputError, Location

NEEDED = ("a", "alpha", "d", "theta")
OPTIONAL = ("name", "type", "lower", "upper", "velocity", "effort")
_OTHERS = {  # other words for columns
    **dict.fromkeys(("joint", "link", "i", "no", "nr", "#"), "name"),
    **dict.fromkeys(("min", "qmin", "q_min"), "lower"),
    **dict.fromkeys(("max", "qmax", "q_max"), "upper"),
    **dict.fromkeys(("speed", "vmax"), "velocity"),
    **dict.fromkeys(("torque", "force"), "effort"),
}
_SIGNS = str.maketrans({"α": "alpha", "θ": "theta", "ϑ": "theta", "π": "pi", "°": " deg", "−": "-", "–": "-"})
_UNIT = re.compile(r"(.*?)\s*[\[(/]\s*([A-Za-z]+)(?:/s)?\s*[\])]?")
_VARIABLE = re.compile(r"(?<![A-Za-z0-9_.])(?:(?:q|theta|th|d)_?\{?[0-9]*\}?\*?|\*)(?![A-Za-z0-9_.(])")
_DECIMAL = re.compile(r"(?<=[0-9]),(?=[0-9])")
_QUOTES = "\"'` "


@dataclass(frozen=True)
class Cell:
    """Text of a cell, and where it stands."""

    text: str
    where: Location


@dataclass(frozen=True)
class Column:
    """Place of a column in a row, and the unit that its heading gives, "" for none."""

    index: int
    unit: str


def rows_of(file: str, text: str) -> list[list[Cell]]:
    """Rows that are neither empty nor comments, all as long as the first. Raises InputError."""
    rows: list[list[Cell]] = []
    mark = ","
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.removeprefix("\ufeff")
        if not line.strip(f",;\t{_QUOTES}") or (line.lstrip().startswith("#") and rows):
            continue
        if not rows:
            if line.lstrip().startswith("#") and "alpha" not in line.translate(_SIGNS).lower():
                continue
            mark = max(",;\t", key=line.count)
        column, cells = 1, []
        for part in line.split(mark):
            lead = len(part) - len(part.lstrip(_QUOTES))
            word = part.strip(_QUOTES).translate(_SIGNS).strip()
            if mark != ",":  # as spreadsheets save where decimals have a comma
                word = _DECIMAL.sub(".", word)
            cells.append(Cell(word, Location(file, number, column + lead)))
            column += len(part) + 1
        if rows and len(cells) != len(rows[0]):
            raise InputError(
                f"found {len(cells)} cells, expected {len(rows[0])} as in the header",
                Location(file, number, 1),
            )
        rows.append(cells)
    if not rows:
        raise InputError(f"{file}: the table is empty, expected a header with a, alpha, d, theta")
    return rows


def columns_of(header: Sequence[Cell]) -> dict[str, Column]:
    """The columns by name. Raises InputError for one that is unknown, there twice, or missing."""
    found: dict[str, Column] = {}
    for index, cell in enumerate(header):
        word = cell.text.lower().lstrip("# ")
        unit = ""
        if (match := _UNIT.fullmatch(word)) and match[2] in UNITS:
            word, unit = match[1], match[2]
        if re.search(r"i\s*-\s*1", word):
            raise InputError(
                f"found the column '{cell.text}': a and alpha of i-1 are those of the modified convention, "
                "which arms.yaml takes as they stand (alpha, d: a, theta, r: d); expected the standard one",
                cell.where,
            )
        plain = re.sub(r"(?<=[a-z])_?\{?i\}?$", "", word) if word != "i" else word
        name = _OTHERS.get(plain, plain)
        if name not in (*NEEDED, *OPTIONAL):
            raise InputError(
                f"found the column '{cell.text}', expected {', '.join(NEEDED)} and, where known, "
                f"{', '.join(OPTIONAL)}",
                cell.where,
            )
        if name in found:
            raise InputError(f"the column {name} is there twice", cell.where)
        found[name] = Column(index, unit)
    missing = [name for name in NEEDED if name not in found]
    if missing:
        where = Location(header[0].where.file, header[0].where.line, 1)
        raise InputError(f"found no column {', '.join(missing)}; expected a, alpha, d, theta", where)
    return found


def without_variable(cell: Cell) -> Cell | None:
    """The cell with the joint's variable (q1, theta_1, d3*, *) removed, None where it has none.

    Raises InputError where it is not simply added.
    """
    match = _VARIABLE.search(cell.text)
    if match is None:
        return None
    before, after = cell.text[: match.start()].rstrip(), cell.text[match.end() :].lstrip()
    if before[-1:] in ("-", "*", "/") or after[:1] in ("*", "/") or _VARIABLE.search(after):
        raise InputError(
            f"found '{cell.text[:40]}': the joint's variable can only be added, as in q1 + 90 deg", cell.where
        )
    text = f"{before} 0 {after}".strip() if before or after else "0"
    return Cell(text, cell.where)
