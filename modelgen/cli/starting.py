"""modelgen init: the first description."""

from __future__ import annotations

from pathlib import Path

import typer

from modelgen.description import starter
from modelgen.errors import InputError


def run(name: str, out: Path) -> None:
    """Write a starter file. Raises InputError for a bad name or file."""
    text = starter(name)
    try:
        with out.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise InputError(f"{out} exists and is left as it is; choose another file with --out") from None
    except OSError as error:
        raise InputError(f"cannot write {out}: {error.strerror}") from None
    shown = "" if out == Path("arms.yaml") else f" {out}"
    typer.echo(f"wrote {out}; next: modelgen generate{shown}", err=True)
