"""The way in: a YAML file or its text to the arms it describes."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from modelgen.description.build import build
from modelgen.description.document import parse, read_text
from modelgen.description.messages import describe, first_mistake
from modelgen.description.objects import Arm
from modelgen.description.schema import Document
from modelgen.errors import InputError


def load(path: Path | str, known_effects: Mapping[str, Collection[str]] | None = None) -> dict[str, Arm]:
    """The arms of a file, by name, in its order. Raises InputError at the first mistake.

    `known_effects` maps the names of the effects to the names of their parameters; any other name is then
    an error.
    """
    return loads(read_text(Path(path)), str(path), known_effects)


def loads(
    text: str, file: str = "arms.yaml", known_effects: Mapping[str, Collection[str]] | None = None
) -> dict[str, Arm]:
    """The arms described by YAML text; `file` is the name that messages show. Otherwise as `load`."""
    root = parse(text, file)
    if not isinstance(root.value, dict):
        raise InputError(
            f"found {describe(root.plain())}, expected a mapping with `schema`, `convention` and `arms`",
            root.where,
        )
    try:
        document = Document.model_validate(root.plain())
    except ValidationError as error:
        raise first_mistake(root, error, Document) from None
    arms = build(document, root, known_effects)
    return {name: replace(arm, document=text) for name, arm in arms.items()}
