"""The command line in this process; one of its own would load everything anew, most of what a call costs."""

from __future__ import annotations

from contextlib import chdir
from dataclasses import dataclass
from pathlib import Path

from typer.testing import CliRunner

from modelgen.cli.app import app


@dataclass(frozen=True)
class Done:
    """How a command ended, with the attributes of subprocess.CompletedProcess."""

    returncode: int
    stdout: str
    stderr: str


def called(*arguments: str | Path, cwd: Path | None = None) -> Done:
    """A command called in the folder `cwd`, without a terminal. A mistake of modelgen keeps its traceback."""
    variables: dict[str, str | None] = {"FORCE_COLOR": None}
    with chdir(cwd or Path.cwd()):
        result = CliRunner().invoke(app, [str(a) for a in arguments], env=variables, prog_name="modelgen")
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return Done(result.exit_code, result.stdout, result.stderr)
