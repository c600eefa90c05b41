"""Messages as numbers: the columns that a message of any type has, and how to take them out.

A field of numbers is a column `topic.field`; fields of fields are joined by dots; an element of a list is
`topic.field[2]`, or `topic.field[elbow]` where the message names its elements, as joint states do.
`stamp` is a header's time [s], `log_time` when the message was written [s] after the file's first.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

NAMES = ("name", "names", "joint_names")
MAX_ELEMENTS = 64  # of a list: longer ones are images and clouds
_ELEMENT = re.compile(r"(.*)\[([^\]]*)\]")


def columns_of(message: Any) -> Iterator[str]:
    """Names of a message's numbers, without its topic."""
    known = labels(message)
    for name, value in _fields(message):
        if _is_time(value) or _number(value) is not None:
            yield name
        elif isinstance(value, str | bytes):
            continue
        elif hasattr(value, "__len__") and not isinstance(value, dict):
            if 0 < len(value) <= MAX_ELEMENTS:
                named = known if len(known) == len(value) else None
                for k, element in enumerate(value):
                    if _number(element) is not None:
                        yield f"{name}[{named[k] if named else k}]"
                    elif not isinstance(element, str | bytes):
                        yield from (f"{name}[{k}].{inner}" for inner in columns_of(element))
        else:
            yield from (f"{name}.{inner}" for inner in columns_of(value))


def number_at(message: Any, column: str) -> float:
    """The number that a column names in a message; NaN where the message does not have it."""
    value, known = message, labels(message)
    for step in _steps(column):
        element = _ELEMENT.fullmatch(step)
        value = _get(value, element[1] if element else step)
        if element and value is not None:
            if element[2] in known:
                k = known.index(element[2])
            elif element[2].isdecimal() and not any(name.isdecimal() for name in known):
                k = int(element[2])
            else:
                k = len(value)
            value = value[k] if k < len(value) else None
        if value is None:
            return float("nan")
    if _is_time(value):
        fraction = _get(value, "nanosec")
        return float(_get(value, "sec")) + 1e-9 * float(_get(value, "nsec") if fraction is None else fraction)
    number = _number(value)
    return float("nan") if number is None else number


def _steps(column: str) -> list[str]:
    # A name in brackets may hold dots.
    return re.findall(r"[^.\[]+(?:\[[^\]]*\])?", column)


def _fields(message: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(message, dict):
        yield from ((str(key), value) for key, value in message.items())
    else:
        names = getattr(message, "__dataclass_fields__", {})
        yield from ((name, getattr(message, name)) for name in names if not name.startswith("_"))


def _get(message: Any, name: str) -> Any:
    return message.get(name) if isinstance(message, dict) else getattr(message, name, None)


def labels(message: Any) -> Sequence[str]:
    """The names of a message's elements, none where it does not name them. A name may be made of digits."""
    for name in NAMES:
        value = _get(message, name)
        if isinstance(value, list) and value and all(isinstance(v, str) for v in value):
            return value
    return []


def _is_time(value: Any) -> bool:
    names = {name for name, _ in _fields(value)}
    return names in ({"sec", "nanosec"}, {"sec", "nsec"})


def _number(value: Any) -> float | None:
    if isinstance(value, str | bytes) or value is None or hasattr(value, "__len__"):
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        return None
