"""The shape of a table in a text file: where its header is, and what stands between its cells.

It follows from the first lines. What is certain is used with a remark; what could be meant in two ways is
refused, with the key of a mapping file that decides.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from modelgen.dataset.objects import Layout
from modelgen.dataset.reading.text import (
    cells_of,
    comment_before,
    encoding_of,
    head_of,
    last_line,
    moment,
    number,
)
from modelgen.dataset.reading.turns import blank_in_many
from modelgen.errors import InputError, Location

DELIMITERS: tuple[str | None, ...] = (",", ";", "\t", "|", None)  # None: blanks
_WORDS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars", None: "blanks"}
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")
_NAME = re.compile(r"[A-Za-z_]\w*(\s*[\[(<].*[\])>])?")  # with its unit
_UNITS = frozenset(
    re.split(
        ",",
        "s,ms,us,µs,μs,ns,min,sec,seconds,second,rad,mrad,deg,°,degree,degrees,radian,radians,grad,rev,turns,"
        "m,mm,cm,um,µm,a,ma,ka,amp,amps,ampere,amperes,n m,nm,n.m,n·m,n*m,n mm,mnm,kn m,knm,n,newton,kn,mn,"
        "v,mv,kv,volt,volts,w,kw,hz,rpm,1/min,min-1,rad/s,deg/s,°/s,mm/s,m/s,rad/s^2,rad/s²,rad/s2,m/s^2,m/s²,"
        "m/s2,°c,c,degc,k,bar,pa,kpa,mpa,%,-,1,counts,count,inc,ticks,lsb,unit",
    )
)


@dataclass(frozen=True)
class Shape:
    """encoding: of the text. delimiter: between cells, None for blanks. decimal: sign. names: of the columns.

    header: number of the last line before the samples. quoted: whether cells have quotes. trailing:
    whether every row ends with a delimiter. sparse: columns that are blank in rows, by
    number; seldom: those of them that are in many, rows of several sources in turn. units: by column, where a
    row of the file says them. dates: of the first sample, by the number of its column, where
    columns hold dates.
    """

    encoding: str
    delimiter: str | None
    decimal: str
    names: tuple[str, ...]
    header: int
    trailing: bool
    sparse: frozenset[int]
    seldom: frozenset[int]
    units: dict[str, str]
    dates: dict[int, datetime]
    remarks: tuple[str, ...]


def shape_of(path: Path, file: Path, layout: Layout) -> Shape:
    """The shape of the table in a file, which is called `path` in messages.

    Raises InputError where it has none, or more than one is possible.
    """
    encoding = layout.encoding or encoding_of(path, file)
    remarks = []
    if encoding not in ("utf-8", "utf-8-sig") and layout.encoding is None:
        remarks.append(f"the text is {encoding.upper()}")
    head = head_of(path, file, encoding, layout.skip_lines)
    delimiter = layout.delimiter
    if head and (said := re.fullmatch(r'"?sep=(.)"?', head[0][1].strip(), re.IGNORECASE)):
        delimiter = said[1] if delimiter is None else delimiter
        head = head[1:]
    if not head:
        raise InputError(
            f"{path}: the log is empty, expected a header such as t,q1,i1 and one line per sample"
        )
    if delimiter is None:
        found = _delimiter([text for _, text in head], layout.decimal)
    else:
        found = None if delimiter == " " else delimiter
    rows = [(n, cells_of(text, found)) for n, text in head]
    body = [cells for _, cells in rows[len(rows) // 2 :]] or [rows[-1][1]]
    decimal = layout.decimal or _decimal(path, rows, found)
    width = Counter(map(len, body)).most_common(1)[0][0]
    numeric = _numeric(body, width, decimal)
    first = next(
        (k for k, (_, row) in enumerate(rows) if _is_sample(row, width, numeric, decimal)), len(rows)
    )
    commented = None if first or layout.columns else _commented(file, encoding, rows[0][0], width)
    if commented is not None:
        layout = replace(layout, columns=commented)
        remarks.append(f"the names of the columns are those of a comment: {', '.join(commented)}")
    names, header, unit_row = _names(path, rows, first, width, layout, numeric, decimal)
    trailing = width == len(names) + 1 and all(not row[-1] for row in body if len(row) == width)
    if width != len(names) and not trailing and first < len(rows):
        raise _other_width(path, rows[first:], names, layout, found)
    names, more = _named(names)
    remarks += more
    if decimal == ",":
        remarks.append(f"cells are separated by {_WORDS.get(found, repr(found))}, decimal sign is the comma")
    if header > 0 and (skipped := [n for n, _ in head if n < header]):
        remarks.append(f"{len(skipped)} lines before the header are passed over")
    units = {}
    if unit_row is not None:
        units = {name: unit for name, unit in zip(names, unit_row, strict=False) if unit}
        remarks.append(f"line {rows[first - 1][0]} holds units: {', '.join(units.values())}")
    last = rows[first - 1][0] if first else layout.skip_lines
    blank = [sum(not row[k] for row in body if len(row) == width) for k in range(min(width, len(names)))]
    seldom = frozenset(k for k, count in enumerate(blank) if blank_in_many(count, len(body)))
    begin = rows[first][1][: len(names)] if first < len(rows) else []
    # A channel that begins later than the others, or ends sooner, is blank there.
    ends = [row for row in (begin, cells_of(last_line(file, encoding), found)) if len(row) >= len(names)]
    read = [row for _, row in rows[first:] if len(row) == width]
    sparse = seldom | {
        k
        for k in numeric
        if k < len(names)
        and any(any(row) and not row[k] for row in ends)
        and sum(bool(row[k]) for row in read) > 1
    }
    dates = {k: date for k, cell in enumerate(begin) if (date := moment(cell)) is not None}
    for k, date in dates.items():
        remarks.append(f"{names[k]} holds dates, in UTC where they name no zone: it counts from {date}")
    return Shape(
        encoding, found, decimal, names, last, trailing, sparse, seldom, units, dates, tuple(remarks)
    )


def _delimiter(lines: Sequence[str], decimal: str | None) -> str | None:
    """The delimiter that makes numbers of the most cells."""
    body = lines[len(lines) // 2 :]
    best, score = None, 0.0
    for delimiter in DELIMITERS:
        cells = [cells_of(line, delimiter) for line in body]
        width, often = Counter(map(len, cells)).most_common(1)[0]
        if width < 2 or 2 * often < len(body):
            continue
        signs = (decimal,) if decimal else (".", ",")
        filled = [cell for row in cells for cell in row if cell]
        most = max(sum(number(cell, sign) is not None for cell in filled) for sign in signs)
        share = most / max(len(filled), 1) * often / len(body)
        if share > score + 1e-9:
            best, score = delimiter, share
    if score:
        return best
    return next((d for d in (",", ";", "\t") if d in lines[0]), None)


def _decimal(path: Path, rows: Sequence[tuple[int, list[str]]], delimiter: str | None) -> str:
    """The decimal sign. Raises InputError where it may be either."""
    commas = [(n, cell) for n, row in rows for cell in row if "," in cell and number(cell, ",") is not None]
    thousands = [
        (n, cell) for n, row in rows for cell in row if cell.count(",") > 1 and _THOUSANDS.fullmatch(cell)
    ]
    points = [(n, cell) for n, row in rows for cell in row if "." in cell and number(cell) is not None]
    if not commas and not thousands:
        return "."
    n, cell = (thousands or commas)[0]
    where = Location(str(path), n, 1)
    expected = "`decimal: ','` or `decimal: '.'` in a mapping file (--mapping) decides"
    if points:
        raise InputError(
            f"found both {cell} and {points[0][1]}, expected one decimal sign; {expected}", where
        )
    if thousands or all(_THOUSANDS.fullmatch(cell) for _, cell in commas):
        raise InputError(f"found {cell}: a decimal comma, or thousands? {expected}", where)
    return ","


def _numeric(body: Sequence[list[str]], width: int, decimal: str) -> list[int]:
    """Columns that hold numbers, by number."""
    whole = [row for row in body if len(row) == width]

    def holds(k: int) -> bool:
        filled = [row[k] for row in whole if row[k]]
        return bool(filled) and 2 * sum(number(cell, decimal) is not None for cell in filled) > len(filled)

    return [k for k in range(width) if holds(k)]


def _is_sample(row: list[str], width: int, numeric: Sequence[int], decimal: str) -> bool:
    if len(row) != width or not numeric:
        return False
    filled = [row[k] for k in numeric if row[k]]
    return 2 * sum(number(cell, decimal) is not None for cell in filled) >= max(len(filled), 1)


def _commented(file: Path, encoding: str, line: int, width: int) -> tuple[str, ...] | None:
    """Names (width,) in the comment above the first sample, in `line`; None where it holds no such names."""
    comment = comment_before(file, encoding, line)
    for delimiter in DELIMITERS:
        cells = cells_of(comment, delimiter)
        if len(set(cells)) == len(cells) == width > 1 and all(map(_NAME.fullmatch, cells)):
            return tuple(cells)
    return None


def _names(
    path: Path,
    rows: Sequence[tuple[int, list[str]]],
    first: int,
    width: int,
    layout: Layout,
    numeric: Sequence[int],
    decimal: str,
) -> tuple[tuple[str, ...], int, list[str] | None]:
    """Names of the columns, the number of their line (0: none), and the row of units below it."""
    if layout.columns:
        return layout.columns, 0, None
    heads = rows[:first] or rows[:1]
    words = [k for k, (_, row) in enumerate(heads) if len(row) == width and _is_words(row, decimal)]
    if not words:
        n, row = heads[-1] if first else rows[0]
        if all(number(cell, decimal) is not None for cell in row):
            raise InputError(
                "found numbers in the first line, expected the names of the columns: t,q1,i1; without a "
                "header `columns: [t, q1, i1]` in a mapping file (--mapping) names them",
                Location(str(path), n, 1),
            )
        if first < len(rows):
            n, row = heads[0] if len(heads) == 1 or len(heads[0][1]) > 1 else heads[-1]
        return tuple(row), n, None
    last = words[-1]
    if len(words) > 1 and words[-2] == last - 1 and _are_units(heads[last][1]):
        return tuple(heads[last - 1][1]), heads[last - 1][0], heads[last][1]
    return tuple(heads[last][1]), heads[last][0], None


def _is_words(row: Sequence[str], decimal: str) -> bool:
    return any(row) and not all(number(cell, decimal) is not None for cell in row)


def _are_units(row: Sequence[str]) -> bool:
    filled = [cell for cell in row if cell]
    known = [cell for cell in filled if unit_word(cell).lower() in _UNITS]
    return 2 * len(known) > len(filled)


def unit_word(cell: str) -> str:
    """A unit without the brackets around it."""
    return cell.strip().strip("[]()<>").strip()


def other_unit(cell: str, expected: str) -> bool:
    """Whether a cell names a unit, and one other than that expected."""
    word = unit_word(cell).lower()
    plain = word.translate({ord(c): None for c in " ·.*"}).replace("²", "^2")
    same = {"s": {"s", "sec", "second", "seconds"}, "a": {"a", "amp", "amps", "ampere"}}
    same["rad"] = {"rad", "radian", "radians"}
    one = expected.lower().replace(" ", "")
    known = word in _UNITS - {"-", "1"}
    return known and plain not in same.get(one, {one})


def _named(names: tuple[str, ...]) -> tuple[tuple[str, ...], list[str]]:
    """The names, with one for every column that has none."""
    missing = [k for k, name in enumerate(names) if not name]
    remarks = [f"column {k + 1} has no name and is called column_{k + 1}" for k in missing]
    return tuple(name or f"column_{k + 1}" for k, name in enumerate(names)), remarks


def _other_width(
    path: Path,
    rows: Sequence[tuple[int, list[str]]],
    names: Sequence[str],
    layout: Layout,
    delimiter: str | None,
) -> InputError:
    n, row = next(((n, row) for n, row in rows if len(row) != len(names)), rows[0])
    what = "`columns:`" if layout.columns else "the header"
    return InputError(wrong_count(len(row), names, what, delimiter), Location(str(path), n, 1))


def wrong_count(count: int, names: Sequence[str], what: str, delimiter: str | None) -> str:
    """The message for a row with more or fewer cells than there are names."""
    between = _WORDS.get(delimiter, repr(delimiter))
    comma = "decimal commas between commas, " if delimiter == "," and count > len(names) else ""
    keys = (
        f"; {comma}a column without a name or another separator than {between}? "
        "`columns: [...]` or `delimiter: ...` in a mapping file (--mapping) decides"
    )
    listed = ", ".join(names[:30]) + (" ..." if len(names) > 30 else "")
    return f"found {count} cells, expected {len(names)}: {listed}{f' ({what})' if what else ''}{keys}"
