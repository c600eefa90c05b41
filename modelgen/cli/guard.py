"""How a command ends: one line for bad input, nothing hidden for a mistake of ours."""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Callable
from typing import ParamSpec

import typer

from modelgen.errors import InputError

P = ParamSpec("P")

CHECK_FAILED = 1
BAD_INPUT = 2
INTERRUPTED = 130  # 128 + SIGINT, as shells have it
STOPPED = "interrupted; nothing is half-written"


def guarded(command: Callable[P, None]) -> Callable[P, None]:
    """The command with its errors turned into messages on stderr and exit codes.

    InputError gives its line and 2, Ctrl-C a line and 130, a reader of stdout that has gone 141. Every
    other exception is a mistake in modelgen and keeps its traceback.
    """

    @functools.wraps(command)
    def call(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            command(*args, **kwargs)
            sys.stdout.flush()
        except InputError as error:
            typer.echo(" ".join(str(error).split("\n")), err=True)
            raise typer.Exit(BAD_INPUT) from None
        except KeyboardInterrupt:
            typer.echo(STOPPED, err=True)
            raise typer.Exit(INTERRUPTED) from None
        except BrokenPipeError:
            # Python would complain once more when it flushes at its end.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(128 + 13) from None

    return call
