"""The commands. What a command needs is imported when it is called: the help is quick."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

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
from modelgen.cli.guard import BAD_INPUT, INTERRUPTED, STOPPED
from modelgen.version import __version__

Version = Annotated[bool, typer.Option("--version", help="Print the version and exit.", is_eager=True)]


_UsageError: Any = typer.BadParameter.__mro__[1]  # Typer gives it no name of its own


class _Group(TyperGroup):
    """The commands. A call that no command has is one line, as any bad input."""

    def main(self, *args: Any, **extra: Any) -> Any:
        """Call a command; ends the process unless `standalone_mode` is False."""
        alone = extra.pop("standalone_mode", True)
        extra["standalone_mode"] = False
        if not alone:
            return super().main(*args, **extra)
        try:
            status = super().main(*args, **extra)
        except _UsageError as error:
            typer.echo(_line(error), err=True)
            sys.exit(BAD_INPUT)
        except typer.Abort:
            typer.echo(STOPPED, err=True)
            sys.exit(INTERRUPTED)
        sys.exit(status if isinstance(status, int) else 0)


def _line(error: Any) -> str:
    said = " ".join(error.format_message().split())
    if error.ctx is None:
        return said
    usage = " ".join(error.ctx.get_usage().split())
    return f"{said}{'' if said[-1] in '.?' else '.'} {usage}; {error.ctx.command_path} --help says more"


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
    cls=_Group,
    help="From the YAML description of a robot arm to its dynamic model in C99, CasADi and NumPy.",
    epilog="Exit status: 0 done, 1 a check failed, or a unit of a fleet, 2 bad input, 130 interrupted, 141 "
    "the reader of stdout is gone. Messages go to stderr, data to stdout.",
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
