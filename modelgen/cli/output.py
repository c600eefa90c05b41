"""Tables and JSON on stdout."""

from __future__ import annotations

import json
import sys
from collections.abc import Collection
from typing import Any, Literal

import typer
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

_WIDTH = 120  # columns where stdout is no terminal


def print_table(
    title: str, columns: dict[str, str], rows: list[list[str]], names: Collection[str] = ()
) -> None:
    """A table on stdout; `columns` maps the headings to "left" or "right". names: headings of columns whose
    words are not broken.
    """
    table = Table(title=escape(title) or None, title_justify="left", box=box.SIMPLE_HEAD, title_style="bold")
    for heading, side in columns.items():
        justify: Literal["left", "right"] = "right" if side == "right" else "left"
        table.add_column(heading, justify=justify, overflow="fold", no_wrap=heading in names)
    for row in rows:
        # Text of the user is no markup.
        table.add_row(*(cell.replace("[", "\\[") for cell in row))
    console = Console(width=None if sys.stdout.isatty() else _WIDTH)
    with console.capture() as captured:
        console.print(table)
    typer.echo("\n".join(line.rstrip() for line in captured.get().rstrip("\n").split("\n")))


def print_json(data: Any) -> None:
    """Data on stdout, strict JSON."""
    typer.echo(json.dumps(data, indent=2, allow_nan=False))
