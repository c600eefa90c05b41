"""The text of a log: its encoding, its lines, and the cells of a line."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import TextIO

from modelgen.dataset.reading.specs import unreadable
from modelgen.errors import InputError

HEAD = 1 << 16  # bytes that the encoding is taken from
LINES = 400  # of a file's beginning, that its shape is taken from
END = 65_536  # bytes at the end of a file that hold its last line
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_POINT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?")
_COMMA = re.compile(r"[+-]?(\d+(,\d+)?|,\d+)([eEdD][+-]?\d+)?")
_DATE = re.compile(r"\d{4}[-/]\d\d[-/]\d\d[T ]\d\d:\d\d.*", re.IGNORECASE)
_WORDS = ("nan", "inf", "+inf", "-inf", "infinity", "-infinity")


def encoding_of(path: Path, file: Path) -> str:
    """By the mark at the file's beginning or by what its bytes can be. Raises InputError."""
    try:
        with file.open("rb") as stream:
            head = stream.read(HEAD)
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from None
    for mark, name in _MARKS:
        if head.startswith(mark):
            return name
    zeros = head[:400].count(0)
    if zeros:
        # Digits and letters in UTF-16 have a zero beside every byte.
        if 2.5 * zeros >= len(head[:400]):
            return "utf-16-be" if head[0] == 0 else "utf-16-le"
        raise InputError(f"{path}: found bytes that are no UTF-8 text, expected a CSV log")
    try:
        codecs.getincrementaldecoder("utf-8")().decode(head)
    except UnicodeDecodeError:
        # Letters with accents, degree signs and the like alone: what other bytes mean nobody can say.
        if all(byte < 0x7F or byte >= 0xA0 for byte in head):
            return "latin-1"
        raise InputError(
            f"{path}: found bytes that are no UTF-8 text, expected a CSV log; "
            "`encoding: ...` in a mapping file (--mapping) names another encoding"
        ) from None
    return "utf-8"


@contextmanager
def lines_of(path: Path, encoding: str) -> Iterator[TextIO]:
    """The lines of a file. What cannot be decoded becomes a lone surrogate, which no number holds."""
    errors = "surrogateescape" if encoding.startswith("utf-8") else "replace"
    with path.open(encoding=encoding, errors=errors, newline=None) as stream:
        yield stream


def head_of(path: Path, file: Path, encoding: str, skip: int) -> list[tuple[int, str]]:
    """Numbers and texts of the first lines after `skip` that are neither empty nor begin with #."""
    try:
        with lines_of(file, encoding) as stream:
            numbered = ((n, line.rstrip("\r\n")) for n, line in enumerate(islice(stream, 4 * LINES), 1))
            kept = (x for x in numbered if x[0] > skip and x[1].strip() and not x[1].startswith("#"))
            return list(islice(kept, LINES))
    except (LookupError, UnicodeError):
        raise InputError(f"{path}: cannot be read in the encoding {encoding}") from None


def last_line(file: Path, encoding: str) -> str:
    """Text of the last whole line; empty where an end of that size has none, or the file no such end."""
    size = file.stat().st_size
    if encoding.startswith("utf-16") or not file.is_file():
        return ""
    with file.open("rb") as stream:
        stream.seek(max(0, size - END))
        lines = stream.read().decode(encoding, errors="replace").split("\n")
    return next((x.rstrip("\r") for x in reversed(lines[1:-1]) if x.strip()), "")


def comment_before(file: Path, encoding: str, line: int) -> str:
    """Text of the last line that begins with # before a line, without that sign; empty where none does."""
    with lines_of(file, encoding) as stream:
        found = [text.strip(" #\r\n") for text in islice(stream, line - 1) if text.startswith("#")]
    return found[-1] if found else ""


def cells_of(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line, without quotes and blanks around them."""
    if delimiter is None:
        return line.replace('"', " ").split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    try:
        row = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:
        row = line.split(delimiter)
    return [cell.strip() for cell in row]


def number(cell: str, decimal: str = ".") -> float | None:
    """The number that a cell is; None for anything else."""
    form = _COMMA if decimal == "," else _POINT
    if form.fullmatch(cell):
        return float(cell.replace(",", ".").replace("d", "e").replace("D", "e"))
    return float(cell) if cell.lower() in _WORDS else None


def moment(cell: str) -> datetime | None:
    """The date and time of day that a cell is (ISO 8601), in UTC where it names no zone; None for others.

    Digits of a second beyond the sixth are cut off.
    """
    if not _DATE.fullmatch(cell):
        return None
    try:
        found = datetime.fromisoformat(cell.replace("/", "-"))
    except ValueError:
        return None
    return found if found.tzinfo else found.replace(tzinfo=UTC)
