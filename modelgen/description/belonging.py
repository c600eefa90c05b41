"""Where a key belongs that is in another place: found in the JSON Schema of the file."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from modelgen.description.document import Steps

_Schema = dict[str, Any]


def belongs(document: type[BaseModel], key: object, place: Steps) -> str:
    """Where the file has a key that was found in a place: "to the type levered", of those that may be there;
    else "at the top level" or "in joints.limits", nearest the top; "" where nowhere.

    Lists and names that a file chooses are passed over.
    """
    found = list(_having(document, key))
    types = [_type(model) for steps, model in found if _same(steps, place)]
    if any(types):
        return f"to the type {' or '.join(filter(None, types))}"
    if not found:
        return ""
    steps, _ = found[0]
    return f"in {'.'.join(steps)}" if steps else "at the top level"


def _having(document: type[BaseModel], key: object) -> Iterator[tuple[tuple[str, ...], _Schema]]:
    """Places and models of a file that have the key, those nearest its top first."""
    schema = document.model_json_schema(by_alias=True)
    models: dict[str, _Schema] = schema.get("$defs", {})
    seen: set[str] = set()
    places: deque[tuple[tuple[str, ...], _Schema]] = deque([((), schema)])
    while places:
        steps, here = places.popleft()
        properties: dict[str, _Schema] = here.get("properties", {})
        if key in properties:
            yield steps, here
        for step, inner in properties.items():
            for name in _models(inner):
                if name not in seen:
                    seen.add(name)
                    places.append(((*steps, step), models[name]))


def _same(steps: tuple[str, ...], place: Steps) -> bool:
    """Whether a place of the file is what the schema has at these steps."""
    rest = iter(place)
    return bool(steps and place) and steps[-1] == place[-1] and all(step in rest for step in steps)


def _type(model: _Schema) -> str:
    """The one `type` of a model, "" where it has none."""
    return str(model["properties"].get("type", {}).get("const", ""))


def _models(schema: Any) -> Iterator[str]:
    """The models that a value may be, or may hold."""
    if isinstance(schema, dict):
        if isinstance(schema.get("$ref"), str):
            yield schema["$ref"].rpartition("/")[2]
        for inner in schema.values():
            yield from _models(inner)
    elif isinstance(schema, list):
        for inner in schema:
            yield from _models(inner)
