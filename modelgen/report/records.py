"""The records of a page: a table of them, with when they begin where their stamps tell."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from itertools import compress

from modelgen.dataset.recorded import Recorded
from modelgen.report.page import Grid

BEGINS = "begins (UTC)"
_HEADS = (("record", "left"), ("use", "left"), ("samples", "right"), ("rate [Hz]", "right"), (BEGINS, "left"))
_NO_DATE = "record, undated"
_UNDATED = "Their stamps do not count from 1970, and do not say when they were made."


def records_table(records: Sequence[Recorded]) -> Grid:
    """A row for each record; without a column of dates, and a word on that, where none is known."""
    dated = any(x.begins is not None for x in records)
    shown = (True, any(x.use for x in records), True, True, dated)
    rows = [
        tuple(compress((x.name, x.use, str(x.samples), f"{x.rate:g}", instant(x.begins)), shown))
        for x in records
    ]
    heads = list(compress(_HEADS, shown))
    if dated:
        return Grid("Records", heads, rows, folds=True)
    return Grid(f"Records. {_UNDATED}", [(_NO_DATE, "left"), *heads[1:]], rows, folds=True)


def instant(begins: float | None) -> str:
    """ISO 8601 of seconds since 1970, UTC, to the second; empty where they are not known."""
    return "" if begins is None else f"{datetime.fromtimestamp(int(begins), UTC):%Y-%m-%dT%H:%M:%SZ}"


def first_instant(begins: Iterable[float | None]) -> str:
    """The earliest of several, as `instant`."""
    return instant(min((x for x in begins if x is not None), default=None))
