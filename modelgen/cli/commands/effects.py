"""modelgen effects: the catalogue in print."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Json

# ruff: noqa: PLC0415 - the help is quick

Pages = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="Write effects.md with a picture of each there.", show_default=False),
]


@guarded
def effects(as_json: Json = False, pages: Pages = None) -> None:
    """Print the catalogue of effects: names, parameters, units, bounds."""
    if pages is None:
        from modelgen.api.effects import EFFECTS
        from modelgen.cli.output import print_result

        print_result(EFFECTS, as_json=as_json)
        return
    from modelgen.report.catalogue import pages as made

    for name, text in made().items():
        path = pages / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    from modelgen.cli.output import say

    say(f"wrote {pages / 'effects.md'}")
