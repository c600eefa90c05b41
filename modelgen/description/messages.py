"""One line per mistake: where it is, what was found, what was expected, what comes nearest."""

from __future__ import annotations

import difflib
import re
from typing import Any

from pydantic import BaseModel, ValidationError

from modelgen.description.belonging import belongs
from modelgen.description.document import Node, Steps, one_line
from modelgen.description.schema import VERSION
from modelgen.errors import InputError, suggest
from modelgen.transmission import KINDS

_EXPECTED = {
    "string_type": "text (put quotes around it)",
    "list_type": "a list",
    "dict_type": "a mapping of keys to values",
    "model_type": "a mapping of keys to values",
    "model_attributes_type": "a mapping of keys to values",
    "number": "a number or an expression such as pi/2",
    "whole": "a whole number",
    "union_tag_not_found": "an effect's name, or a name with values: {coulomb_friction: {magnitude: 0.2}}",
}


def describe(value: Any) -> str:
    """A value of the document in a few words."""
    match value:
        case None:
            return "nothing"
        case bool():
            return "true" if value else "false"
        case str():
            return f"'{one_line(value)}'"
        case int() | float():
            return f"{value:g}"
        case list():
            return f"a list of {len(value)}"
        case dict():
            return "a mapping"
        case _:
            return type(value).__name__


def label(path: Steps) -> str:
    """The path as the messages show it: my_arm.joints.1.drive.type (indices count from 0)."""
    steps = path[1:] if len(path) > 1 and path[0] == "arms" else path
    return ".".join(one_line(str(step)) for step in steps)


def mistake(root: Node, path: Steps, message: str, key: bool = False) -> InputError:
    """The error for the value at `path`, or for its key."""
    prefix = label(path)
    return InputError(f"{prefix}: {message}" if prefix else message, root.locate(path, key))


def first_mistake(root: Node, error: ValidationError, document: type[BaseModel]) -> InputError:
    """The first structural mistake in reading order, of a file of this kind."""
    found = [_structural(root, dict(entry), document) for entry in error.errors(include_url=False)]
    return min(found, key=lambda item: item[0])[1]


def _structural(
    root: Node, entry: dict[str, Any], document: type[BaseModel]
) -> tuple[tuple[int, int], InputError]:
    kind, context, value = entry["type"], entry.get("ctx", {}), entry["input"]
    path = _path(root, entry["loc"])
    key = False
    if kind == "unknown_key":
        path, key = [*path, context["key"]], True
        message = f"found the unknown key {describe(context['key'])}"
        message += _instead(context["key"], context["options"], document, path[:-1])
    elif kind == "missing":
        message = f"the key '{entry['loc'][-1]}' is missing"
    elif kind == "union_tag_not_found" and "discriminator" in context and path[-1:] == ["drive"]:
        message = f"the key 'type' is missing, expected one of {', '.join(KINDS)}"
    elif kind == "union_tag_invalid":
        path = [*path, "type"]
        options = re.findall(r"'(\w+)'", context["expected_tags"])
        message = f"found {describe(context['tag'])}{_one_of(context['tag'], options)}"
    elif kind == "literal_error":
        options = re.findall(r"-?\w+", context["expected"].replace(" or ", " "))
        message = f"found {describe(value)}{_one_of(value, options)}"
    elif kind == "string_pattern_mismatch":
        key = entry["loc"][-1] == "[key]"
        expected = "a name: a letter, then letters, digits and _"
        expected += " and -" if "-" in context["pattern"].split("0-9")[-1] else ""
        if context["pattern"] == VERSION:
            expected = "a version: at most 64 letters, digits and . + _ -"
        message = f"found {describe(value)}, expected {expected} (ASCII)"
    elif kind in ("too_short", "too_long"):
        message = _length(value, context)
    elif kind == "string_too_short":
        message = "found an empty text, expected a name"
    elif kind in _EXPECTED:
        message = f"found {describe(value)}, expected {_EXPECTED[kind]}"
    else:
        message = f"found {describe(value)}: {entry['msg']}"
    result = mistake(root, path, message, key)
    at = result.where
    assert at is not None
    return (at.line, at.column), result


def _instead(key: Any, options: list[str], document: type[BaseModel], place: Steps) -> str:
    """A key of this place that is a slip away, or else the place of this one, or else the nearest key."""
    slip = isinstance(key, str) and difflib.get_close_matches(key, options, n=1, cutoff=0.8)
    where = "" if slip else belongs(document, key, place)
    return f"; it belongs {where}" if where else suggest(key, options)


def _one_of(value: Any, options: list[str]) -> str:
    expected = options[0] if len(options) == 1 else f"one of {', '.join(options)}"
    several = isinstance(value, str) and len(options) > 1
    near = difflib.get_close_matches(value, options, n=1) if several else []
    return f", expected {expected}" + (f", did you mean '{near[0]}'?" if near else "")


def _length(value: Any, context: dict[str, Any]) -> str:
    bound = context.get("min_length", context.get("max_length"))
    least = "at least " if bound == 1 and not value else ""
    things = "entry" if bound == 1 else "entries"
    return f"found {len(value) if value else 'no'} entries, expected {least}{bound} {things}"


def _path(root: Node, location: tuple[int | str, ...]) -> list[str | int]:
    """The part of pydantic's location that exists in the document: without its names of union members."""
    path: list[str | int] = []
    node: Node = root
    for step in location:
        child = node.child(step)
        if child is not None:
            path.append(step)
            node = child
    return path
