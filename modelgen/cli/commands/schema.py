"""modelgen schema."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli.guard import guarded

# ruff: noqa: PLC0415 - the help is quick

OfMapping = Annotated[
    bool, typer.Option("--mapping", help="Of the files that say what the columns of a foreign log are.")
]
OfFleet = Annotated[bool, typer.Option("--fleet", help="Of the files that list the arms of a fleet.")]


@guarded
def schema(of_mapping: OfMapping = False, of_fleet: OfFleet = False) -> None:
    """Print a JSON Schema of the description, of a mapping file or of a fleet, for editors."""
    from modelgen.cli.output import print_json

    if of_fleet:
        from modelgen.fleet.schema import fleet_json_schema

        print_json(fleet_json_schema())
        return
    if of_mapping:
        from modelgen.dataset.mapping.schema import mapping_json_schema

        print_json(mapping_json_schema())
        return
    from modelgen.description import json_schema
    from modelgen.effects import effect_texts, known_effects

    print_json(json_schema(known_effects(), effect_texts()))
