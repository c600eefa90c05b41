"""YAML text to a tree of plain values in which every key and value knows its line and column.

Built on ruamel.yaml's event stream: duplicate keys, tags, self-references and anchors that multiply
the document are refused before anything is expanded, and scalars follow the YAML 1.2 core schema.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeAlias

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
    StreamEndEvent,
)

from modelgen.errors import InputError, Location

MAX_CHARACTERS = 1_000_000
MAX_DEPTH = 24
MAX_NODES = 100_000
KEPT = 8  # texts

Steps: TypeAlias = Sequence[str | int]

_INT = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_WORDS: Mapping[str, float | bool | None] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
}


@dataclass(frozen=True)
class Node:
    """One value of the document: a scalar, a list of nodes or a mapping of nodes, and where it is.

    `keys` gives the places of a mapping's keys; `size` and `height` count the nodes below, aliases expanded.
    """

    value: bool | int | float | str | list[Node] | dict[str, Node] | None
    where: Location
    keys: Mapping[str, Location] = field(default_factory=dict)
    size: int = 1
    height: int = 1

    def plain(self) -> Any:
        """The value as plain Python objects."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        return self.value

    def child(self, step: str | int) -> Node | None:
        """Return the value under a key or an index, None where it is absent."""
        if isinstance(self.value, dict) and isinstance(step, str):
            return self.value.get(step)
        if isinstance(self.value, list) and isinstance(step, int) and step < len(self.value):
            return self.value[step]
        return None

    def locate(self, path: Steps, key: bool = False) -> Location:
        """Place of the value at `path`, or of its key; of the nearest enclosing one where it is missing."""
        node, where = self, self.where
        for step in path:
            key_place = node.keys.get(step) if isinstance(step, str) else None
            child = node.child(step)
            if child is None:
                break
            where = key_place if key and key_place is not None else child.where
            node = child
        return where


def one_line(text: str, length: int = 40) -> str:
    """Text of the document as a message may repeat it: printable, on one line, cut to `length`."""
    line = " ".join("".join(c if c.isprintable() or c.isspace() else "?" for c in text).split())
    return line if len(line) <= length else line[: length - 3] + "..."


def read_text(path: Path) -> str:
    """Text of a UTF-8 file, with or without byte-order mark. Raises InputError where it cannot be read."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file; `modelgen init NAME` writes a first one") from None
    except IsADirectoryError:
        raise InputError(f"{path}: found a folder, expected a YAML file") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path}: cannot be read: {reason}") from None
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        column = error.start - (data.rfind(b"\n", 0, error.start) + 1) + 1
        where = Location(str(path), line, column)
        raise InputError(f"found the byte 0x{data[error.start]:02x}, expected UTF-8 text", where) from None


@lru_cache(maxsize=KEPT)
def parse(text: str, file: str) -> Node:
    """The tree of one YAML document; a text that is read again in a process is not parsed again, and
    nobody changes a tree. Raises InputError with the place of the first mistake.
    """
    start = Location(file, 1, 1)
    if len(text) > MAX_CHARACTERS:
        raise InputError(f"found {len(text)} characters, at most {MAX_CHARACTERS} are read", start)
    events = _events(text, file)
    next(events)  # stream start
    if not isinstance(next(events), DocumentStartEvent):
        raise InputError("the file is empty, expected `schema: 1`, `convention:` and `arms:`", start)
    node = _Tree(events, file).node(next(events), 1)
    next(events)  # document end
    after = next(events)
    if not isinstance(after, StreamEndEvent):
        raise InputError("found a second YAML document, expected one", _place(after, file))
    return node


def _events(text: str, file: str) -> Iterator[Event]:
    stream = YAML(typ="safe", pure=True).parse(text)
    while True:
        # The parser is foreign code run on any text: whatever it raises means that the text is no YAML.
        try:
            event = next(stream)
        except StopIteration:
            return
        except MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            where = Location(file, mark.line + 1, mark.column + 1) if mark else Location(file, 1, 1)
            reason = one_line(str(error.problem or error.context or "syntax error"), 120)
            raise InputError(f"this is no valid YAML: {reason}", where) from None
        except Exception as error:
            reason = one_line(str(error), 120) or type(error).__name__
            raise InputError(f"this is no valid YAML: {reason}", Location(file, 1, 1)) from None
        yield event


def _place(event: Event, file: str) -> Location:
    mark = event.start_mark
    return Location(file, mark.line + 1, mark.column + 1)


class _Tree:
    """Builds nodes from events, with bounds on depth and on the number of nodes after expansion."""

    def __init__(self, events: Iterator[Event], file: str) -> None:
        self.events = events
        self.file = file
        self.anchors: dict[str, Node | None] = {}  # None while the anchored value is being read

    def node(self, event: Event, depth: int) -> Node:
        where = _place(event, self.file)
        if isinstance(event, AliasEvent):
            return self._alias(event, depth, where)
        if depth > MAX_DEPTH:
            raise InputError(f"the document is nested deeper than {MAX_DEPTH} levels", where)
        if getattr(event, "tag", None) is not None:
            raise InputError("found a YAML tag, expected a plain value (tags are not used here)", where)
        anchor = getattr(event, "anchor", None)
        if anchor is not None:
            self.anchors[anchor] = None
        if isinstance(event, MappingStartEvent):
            node = self._mapping(depth, where)
        elif isinstance(event, SequenceStartEvent):
            node = self._sequence(depth, where)
        else:
            assert isinstance(event, ScalarEvent)
            node = Node(_scalar(event), where)
        if node.size > MAX_NODES:
            raise InputError(f"the document has more than {MAX_NODES} values, aliases expanded", where)
        if anchor is not None:
            self.anchors[anchor] = node
        return node

    def _alias(self, event: AliasEvent, depth: int, where: Location) -> Node:
        name = one_line(str(event.anchor))
        if event.anchor not in self.anchors:
            raise InputError(f"found the alias *{name}, expected its anchor before it", where)
        target = self.anchors[event.anchor]
        if target is None:
            raise InputError(f"the alias *{name} stands inside its own anchor", where)
        if depth + target.height > MAX_DEPTH + 1:
            raise InputError(f"the document is nested deeper than {MAX_DEPTH} levels", where)
        return target

    def _sequence(self, depth: int, where: Location) -> Node:
        items: list[Node] = []
        while not isinstance(event := next(self.events), SequenceEndEvent):
            items.append(self.node(event, depth + 1))
        return Node(items, where, {}, *_extent(items))

    def _mapping(self, depth: int, where: Location) -> Node:
        values: dict[str, Node] = {}
        keys: dict[str, Location] = {}
        while not isinstance(event := next(self.events), MappingEndEvent):
            place = _place(event, self.file)
            if not isinstance(event, ScalarEvent) or getattr(event, "tag", None) is not None:
                raise InputError("found a key that is no plain text, expected a name", place)
            key = str(event.value)
            if key == "<<" and event.style is None:
                raise InputError("merge keys (<<) are not part of YAML 1.2; write the keys out", place)
            if key in keys:
                first = keys[key].line
                raise InputError(f"the key '{one_line(key)}' is given twice, first on line {first}", place)
            keys[key] = place
            values[key] = self.node(next(self.events), depth + 1)
        return Node(values, where, keys, *_extent(values.values()))


def _extent(nodes: Any) -> tuple[int, int]:
    items = list(nodes)
    return 1 + sum(node.size for node in items), 1 + max((node.height for node in items), default=0)


def _scalar(event: ScalarEvent) -> bool | int | float | str | None:
    """The YAML 1.2 core schema; quoted and block scalars are text. Octal and hexadecimal stay text."""
    text = str(event.value)
    if event.style is not None:
        return text
    if text in _WORDS:
        return _WORDS[text]
    if len(text) <= 15 and _INT.fullmatch(text):
        return int(text)
    if len(text) <= 400 and _FLOAT.fullmatch(text):
        return float(text)
    return text
