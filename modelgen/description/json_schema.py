"""The JSON Schema of arms.yaml, for editors: what they check, complete and show on hover."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from modelgen.description.schema import Document

_NUMBER: dict[str, Any] = {"type": ["number", "string"]}


def json_schema(
    known_effects: Mapping[str, Collection[str]] | None = None, texts: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of arms.yaml.

    `known_effects` maps the names of the effects to the names of their parameters; with it, misspelt effects
    are marked as well. `texts` says what is shown of them, by the names "spring" and "spring.stiffness".
    """
    schema = Document.model_json_schema(by_alias=True)
    head: dict[str, Any] = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "modelgen arms",
    }
    if known_effects is not None:
        entry = _entry(known_effects, texts or {})
        effects = schema["$defs"]["JointModel"]["properties"]["effects"]
        for option in effects["anyOf"]:
            if option.get("type") == "array":
                option["items"] = entry
        schema["$defs"]["ArmModel"]["properties"]["effects"]["items"] = entry
    _close(schema)
    return head | {key: value for key, value in schema.items() if key != "title"}


def _entry(known_effects: Mapping[str, Collection[str]], texts: Mapping[str, str]) -> dict[str, Any]:
    """An entry of `effects`: a name, or a name with values."""

    def said(name: str) -> dict[str, str]:
        return {"description": texts[name]} if name in texts else {}

    values = {
        effect: {
            "type": "object",
            **said(effect),
            "properties": {name: _NUMBER | said(f"{effect}.{name}") for name in sorted(parameters)},
            "additionalProperties": False,
        }
        for effect, parameters in sorted(known_effects.items())
    }
    return {
        "anyOf": [
            {"oneOf": [{"const": name, **said(name)} for name in sorted(known_effects)]},
            {
                "type": "object",
                "properties": values,
                "additionalProperties": False,
                "minProperties": 1,
                "maxProperties": 1,
            },
        ]
    }


def _close(schema: Any) -> None:
    """Forbid other names where names follow a pattern; pydantic leaves that open."""
    if isinstance(schema, dict):
        if "patternProperties" in schema:
            schema["additionalProperties"] = False
        for value in schema.values():
            _close(value)
    elif isinstance(schema, list):
        for value in schema:
            _close(value)
