"""The commands. What a command needs is imported when it is called: the help is quick."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from modelgen.cli.collection import collect_no_more, collect_rarely
from modelgen.cli.commands import (
    calibrate,
    cmake_dir,
    diagnose,
    draw,
    effects,
    excite,
    export,
    fleet,
    generate,
    identify,
    import_,
    init,
    inspect,
    refine,
    schema,
    show,
    simulate,
)
from modelgen.version import __version__

Version = Annotated[bool, typer.Option("--version", help="Print the version and exit.", is_eager=True)]


class _Command(TyperCommand):
    """A command in whose help brackets are text: those of units would be read as markup and left out."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        with _escaped(self.params):
            super().format_help(ctx, formatter)


@contextmanager
def _escaped(params: list[Any]) -> Iterator[None]:
    """Parameters whose help is escaped until the end."""
    texts = [(p, p.help) for p in params if getattr(p, "help", None)]
    for p, text in texts:
        p.help = re.sub(r"\[(?=[a-z])", r"\[", text)
    try:
        yield
    finally:
        for p, text in texts:
            p.help = text


app = typer.Typer(
    name="modelgen",
    help="From the YAML description of a robot arm to its dynamic model in C99, CasADi and NumPy.",
    epilog="Exit status: 0 done, 1 a check failed, 2 bad input, 130 interrupted, 141 the reader of stdout is "
    "gone. Messages go to stderr, data to stdout.",
    add_completion=False,
    # A traceback that Python prints itself can be copied into a report.
    pretty_exceptions_enable=False,
)


@app.callback(invoke_without_command=True)
def _common(context: typer.Context, version: Version = False) -> None:
    if version:
        typer.echo(f"modelgen {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit


for _command in (
    generate,
    show,
    draw,
    inspect,
    identify,
    diagnose,
    simulate,
    refine,
    fleet,
    excite,
    calibrate,
    effects,
    schema,
    init,
    import_,
    export,
    cmake_dir,
):
    app.command(_command.__name__.strip("_").replace("_", "-"), cls=_Command)(_command)


def main() -> None:
    """Entry of the command `modelgen`. Ends the process with its exit status."""
    collect_rarely()
    try:
        app(prog_name="modelgen")
    finally:
        collect_no_more()
