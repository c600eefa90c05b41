"""modelgen cmake-dir."""

from __future__ import annotations

import typer

from modelgen.cli.guard import guarded


@guarded
def cmake_dir() -> None:
    """Print the folder of ModelgenGenerate.cmake, which generates at build time."""
    from modelgen.resources import cmake_folder  # noqa: PLC0415 - the help is quick

    typer.echo(cmake_folder())
