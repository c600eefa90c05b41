"""Tables, JSON and progress."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal

import typer
from rich import box
from rich.console import Console
from rich.markup import escape
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
from modelgen.progress import Progress

_WIDTH = 120  # columns where stdout is no terminal


def print_result(result: Shown, *, as_json: bool) -> None:
    """Lines and tables of a result on stdout, or its data."""
    if as_json:
        print_json(result.to_json())
        return
    for part in result.shown():
        if isinstance(part, Table):
            print_table(part)
        else:
            typer.echo(part)


def print_table(table: Table) -> None:
    """A table on stdout."""
    grid = Grid(
        title=escape(table.title) or None, title_justify="left", box=box.SIMPLE_HEAD, title_style="bold"
    )
    for heading, side in table.columns.items():
        justify: Literal["left", "right"] = "right" if side == "right" else "left"
        grid.add_column(heading, justify=justify, overflow="fold", no_wrap=heading in table.names)
    for row in table.rows:
        # Text of the user is no markup.
        grid.add_row(*(cell.replace("[", "\\[") for cell in row))
    console = Console(width=None if sys.stdout.isatty() else _WIDTH)
    with console.capture() as captured:
        console.print(grid)
    typer.echo("\n".join(line.rstrip() for line in captured.get().rstrip("\n").split("\n")))


def print_json(data: Any) -> None:
    """Data on stdout, strict JSON."""
    typer.echo(json.dumps(data, indent=2, allow_nan=False))


@contextmanager
def progress_bar(*, counted: bool = True) -> Iterator[Progress]:
    """A bar on stderr where that is a terminal. counted: shows how many of how many, else the share."""
    console = Console(stderr=True)
    how: ProgressColumn = MofNCompleteColumn() if counted else TaskProgressColumn()
    columns = TextColumn("{task.description}"), BarColumn(), how, TimeRemainingColumn()
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("", total=None)

        def progress(text: str, done: float, total: float | None) -> None:
            bar.update(task, description=text, completed=done, total=total)

        yield progress
