"""Tables, JSON and progress."""

from __future__ import annotations

import json
import os
import re
import sys
import threading
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from textwrap import wrap
from typing import Any, Literal

import typer
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.measure import Measurement
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    ProgressColumn,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.progress import Progress as Bar
from rich.table import Table as Grid

from modelgen.api.results import Shown, Table
from modelgen.progress import Progress, silent

_WIDTH = 120  # columns where stdout is no terminal
_NOTHING: tuple[str, float, float | None] = ("", 0.0, None)
_ENDLESS = 10_000  # columns, more than any table has
_EVERY = 20.0  # seconds between two lines on the progress
# A number, or nothing, and its unit, between whose words no line ends.
_NAMES = "deg|mrad|rad|kHz|Hz|µs|ms|min|mm|kg|mA|kN|s|m|A|N|V|J|W|K|turns?|samples?"
_UNIT = rf"(?:(?:{_NAMES})(?![\w-])(?:\^\d)?(?:/\w+(?:\^\d)?)?|%)"
_DEVIATION = r" ± \d[\d.e+-]*"
_QUANTITY = re.compile(
    rf"(?<=\d)(?:{_DEVIATION})?(?: {_UNIT})+|(?<=\d){_DEVIATION}|(?<!\S){_UNIT}(?: {_UNIT})+(?!\S)"
)
_FIXED = "\ue000"  # a space at which neither textwrap nor rich breaks, until the lines are made


def print_result(result: Shown, *, as_json: bool) -> None:
    """Lines and tables of a result on stdout, or its data."""
    if as_json:
        print_json(result.to_json())
        return
    for part in result.shown():
        if isinstance(part, Table):
            print_table(part)
        else:
            say(part)


def say_next(page: Path, steps: Iterable[tuple[str, str]]) -> None:
    """Where the page is, and what is to be done next: a sentence each, with its command."""
    say(f"report: {page}")
    for text, command in steps:
        say(text, command)


def say(text: str, command: str = "") -> None:
    """A sentence on stdout, wrapped where there is a width to keep to: that of COLUMNS or of a terminal.

    command: follows on it; where lines are wrapped it has a line of its own, which is copied as it is.
    """
    width = _width() if _asked() else Console().width if sys.stdout.isatty() else 0
    if not width:
        typer.echo(f"{text} {command}".rstrip())
        return
    kept = _together(text)
    lines = wrap(kept, width, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
    lines = [line.replace(_FIXED, " ") for line in lines]
    typer.echo("\n".join([*lines, *([f"  {command}"] if command else [])]))


def print_table(table: Table) -> None:
    """A table on stdout, as wide as the terminal or COLUMNS; without its empty columns.

    Where its words would have to be broken, its rows stand below each other, a line for each column.
    """
    table = table.filled()
    table = replace(table, rows=[[_together(cell) for cell in row] for row in table.rows])
    console = Console(width=_width())
    least, most = zip(*(_extent(table, k) for k in range(len(table.columns))), strict=True)
    grid = _grid(table, least)
    beside = Measurement.get(console, console.options.update(max_width=_ENDLESS), grid).minimum - sum(least)
    widths = _shared(least, most, console.width - beside)
    if sum(widths) + beside > console.width:
        typer.echo(f"{_below(table, console.width)}\n".replace(_FIXED, " "))
        return
    grid = _grid(table, widths)
    with console.capture() as captured:
        if table.title:  # as wide as the terminal, however narrow its table is
            console.print(escape(table.title), style="bold", highlight=False)
        console.print(grid)
    lines = captured.get().replace(_FIXED, " ").rstrip("\n").split("\n")
    typer.echo("\n".join(line.rstrip() for line in lines))


def _together(text: str) -> str:
    """Text in which no line can end within a quantity, until `_FIXED` is a space again."""
    return _QUANTITY.sub(lambda found: found[0].replace(" ", _FIXED), text)


def _width() -> int | None:
    """Columns of the output: those of COLUMNS, else of the terminal (None), else 120."""
    if _asked():
        return _asked()
    return None if sys.stdout.isatty() else _WIDTH


def _asked() -> int:
    """Columns that COLUMNS asks for, 0 where it does not."""
    asked = os.environ.get("COLUMNS", "")
    return int(asked) if asked.isdecimal() else 0


def _below(table: Table, width: int) -> str:
    """A line or more for each filled cell, rows apart."""
    headings = [" ".join(heading.split()) for heading in table.columns]
    wide = max(map(len, headings))
    lines = wrap(table.title, width)
    for row in table.rows:
        lines.append("")
        for heading, cell in zip(headings, row, strict=True):
            if cell:
                head, more = f"  {heading:<{wide}}  ", " " * (wide + 4)
                lines += wrap(cell, width, initial_indent=head, subsequent_indent=more)
    return "\n".join(lines)


def _extent(table: Table, k: int) -> tuple[int, int]:
    """Columns that the longest word of the table's column number k takes, and its longest line. A name, which
    stays on one line, is a word.
    """
    heading = list(table.columns)[k]
    lines = [line for cell in (heading, *(row[k] for row in table.rows)) for line in cell.split("\n")]
    most = max(map(len, lines))
    words = (word for line in lines for word in line.split())
    return most if heading in table.names else max(map(len, words), default=1), most


def _shared(least: Sequence[int], most: Sequence[int], width: int) -> list[int]:
    """Widths between least and most whose sum is at most `width` where that can be: the widest give way."""
    bound = max(most)
    while bound > 0 and sum(min(b, max(a, bound)) for a, b in zip(least, most, strict=True)) > width:
        bound -= 1
    return [min(b, max(a, bound)) for a, b in zip(least, most, strict=True)]


def _grid(table: Table, widths: Sequence[int]) -> Grid:
    grid = Grid(box=box.SIMPLE_HEAD)
    for (heading, side), width in zip(table.columns.items(), widths, strict=True):
        justify: Literal["left", "right"] = "right" if side == "right" else "left"
        named = heading in table.names
        grid.add_column(heading, justify=justify, overflow="fold", no_wrap=named, width=width)
    for row in table.rows:
        # Text of the user is no markup.
        grid.add_row(*(cell.replace("[", "\\[") for cell in row))
    return grid


def print_json(data: Any) -> None:
    """Data on stdout, strict JSON."""
    typer.echo(json.dumps(data, indent=2, allow_nan=False))


@contextmanager
def progress_bar(*, counted: bool = True) -> Iterator[Progress]:
    """A bar on stderr where that is a terminal, else a line with the stage every 20 s.

    The environment's MODELGEN_PROGRESS sets other seconds, 0 for no lines. counted: shows how many of how
    many, else the share.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        with _progress_lines(_seconds(), counted) as lines:
            yield lines
        return
    how: ProgressColumn = MofNCompleteColumn() if counted else TaskProgressColumn()
    columns = TextColumn("{task.description}"), BarColumn(), how, TimeRemainingColumn()
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)

        def progress(text: str, done: float, total: float | None) -> None:
            bar.update(task, description=text, completed=done, total=total)

        yield progress


def _seconds() -> float:
    """Between two lines on the progress; 20 where MODELGEN_PROGRESS says nothing that can be read."""
    try:
        return max(0.0, float(os.environ.get("MODELGEN_PROGRESS", _EVERY)))
    except ValueError:
        return _EVERY


@contextmanager
def _progress_lines(every: float, counted: bool) -> Iterator[Progress]:
    """A line on stderr every so many seconds: the time since the begin, the stage, how much is done."""
    begin, stage, ended = time.monotonic(), [_NOTHING], threading.Event()
    if not every:
        yield silent
        return

    def progress(text: str, done: float, total: float | None) -> None:
        stage[0] = (text, done, total)

    def report() -> None:
        while not ended.wait(every):
            text, done, total = stage[0]
            of = f"{done:g} of {total:g}" if counted and total else ""
            share = f", {of or f'{100.0 * done / total:.0f} %'}" if total else ""
            typer.echo(f"{time.monotonic() - begin:.0f} s: {text or 'working'}{share}", err=True)

    lines = threading.Thread(target=report, daemon=True)
    lines.start()
    try:
        yield progress
    finally:
        ended.set()
        lines.join()
