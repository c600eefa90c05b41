"""Where a key belongs that is in another place: found in the JSON Schema of the file."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

_Schema = dict[str, Any]


def belongs(document: type[BaseModel], key: object) -> str:
    """Where the file has this key, nearest its top: "at the top level", "in joints.limits"; "" where nowhere.

    Lists and names that a file chooses are passed over.
    """
    schema = document.model_json_schema(by_alias=True)
    models: dict[str, _Schema] = schema.get("$defs", {})
    seen: set[str] = set()
    places: deque[tuple[tuple[str, ...], _Schema]] = deque([((), schema)])
    while places:
        steps, here = places.popleft()
        properties: dict[str, _Schema] = here.get("properties", {})
        if key in properties:
            return f"in {'.'.join(steps)}" if steps else "at the top level"
        for step, inner in properties.items():
            for name in _models(inner):
                if name not in seen:
                    seen.add(name)
                    places.append(((*steps, step), models[name]))
    return ""


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
