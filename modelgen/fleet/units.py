"""A fleet's file to its units, patterns expanded."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from glob import escape, glob
from pathlib import Path

from pydantic import ValidationError

from modelgen.dataset.reading.specs import parse as parse_spec
from modelgen.description.document import Node, Steps, parse, read_text
from modelgen.description.expressions import ExpressionError, evaluate
from modelgen.description.messages import describe, first_mistake, mistake
from modelgen.errors import InputError
from modelgen.fleet.schema import PLACE, UNIT_NAME, Common, Document, PatternModel


@dataclass(frozen=True)
class Unit:
    """One arm with its records. base: the folder that all other paths are relative to; description: of the
    arm; train, test: FILE or FILE@t0:t1; arm: None for the only one of the description; cutoff [Hz], period
    [s]: None for what `diagnose` finds.
    """

    name: str
    base: str
    description: str
    arm: str | None
    train: tuple[str, ...]
    test: tuple[str, ...]
    mapping: str | None = None
    cutoff: float | None = None
    period: float | None = None

    def path(self, text: str) -> str:
        """A path or record of the unit as this process finds it."""
        return os.path.normpath(Path(self.base, text))


def load_fleet(path: Path) -> list[Unit]:
    """The units of a fleet's file: those listed, then those found by patterns, by name.

    Raises InputError with the place of the first mistake, and where a pattern finds nothing or two units
    have one name. Whether a unit's records can be read is not asked here.
    """
    if not path.exists():
        raise InputError(f"{path}: there is no such fleet file; docs/fleet.md shows one")
    root = parse(read_text(path), str(path))
    if not isinstance(root.value, dict):
        raise InputError(
            f"found {describe(root.plain())}, expected a mapping with `schema` and `units` or `patterns`",
            root.where,
        )
    if "convention" in root.value:
        raise InputError(
            "this is the description of an arm, expected a fleet file; see docs/fleet.md", root.where
        )
    try:
        document = Document.model_validate(root.plain())
    except ValidationError as error:
        raise first_mistake(root, error, Document) from None
    found: dict[str, Unit] = {}
    for unit, place in _units(document, root, str(path.parent.absolute())):
        if unit.name in found:
            raise mistake(root, place, f"a second unit has the name '{unit.name}'; names must differ")
        found[unit.name] = unit
    if not found:
        raise InputError("found no units, expected `units` or `patterns`", root.where)
    return list(found.values())


def _units(document: Document, root: Node, base: str) -> Iterator[tuple[Unit, Steps]]:
    place: list[str | int]
    for k, unit in enumerate(document.units):
        place = ["units", k]
        yield _unit(document, unit, root, place, base, unit.name, unit.train, unit.test), place
    for k, pattern in enumerate(document.patterns):
        place = ["patterns", k]
        for name, (train, test) in _expanded(pattern, root, place, base).items():
            yield _unit(document, pattern, root, place, base, name, train, test), place


def _unit(
    document: Document,
    own: Common,
    root: Node,
    place: list[str | int],
    base: str,
    name: str,
    train: list[str],
    test: list[str],
) -> Unit:
    def given(key: str) -> str | None:
        value = getattr(own, key) or getattr(document, key)
        return value if value is None else value.replace(PLACE, name)

    def number(key: str) -> float | None:
        at: list[str | int] = [*place, key] if getattr(own, key) is not None else [key]
        raw = getattr(own, key) if getattr(own, key) is not None else getattr(document, key)
        if raw is None:
            return None
        try:
            value = evaluate(raw, "plain").value
        except ExpressionError as error:
            raise mistake(root, at, f"found {describe(raw)}, expected a number: {error}") from None
        if value <= 0.0:
            raise mistake(root, at, f"found {describe(raw)}, expected a number above 0")
        return value

    description = given("arms")
    if description is None:
        raise mistake(
            root, place, "the key 'arms' is missing here and at the top: the description of the arm"
        )
    return Unit(
        name,
        base,
        description,
        given("arm"),
        tuple(train),
        tuple(test),
        given("mapping"),
        number("cutoff"),
        number("period"),
    )


def _expanded(
    pattern: PatternModel, root: Node, place: list[str | int], base: str
) -> dict[str, tuple[list[str], list[str]]]:
    """Training and test records by unit, sorted; a unit that lacks one of both is there all the same."""
    found: dict[str, tuple[list[str], list[str]]] = {}
    for role, key in enumerate(("train", "test")):
        for text in getattr(pattern, key):
            if PLACE not in text:
                raise mistake(
                    root,
                    [*place, key],
                    f"found '{text}', expected {PLACE} in it where the unit's name stands",
                )
            for name, record in _matches(text, base):
                if not re.fullmatch(UNIT_NAME, name):
                    raise mistake(
                        root,
                        [*place, key],
                        f"found the unit '{name}', expected a name: a letter or digit, then also . _ -",
                    )
                found.setdefault(name, ([], []))[role].append(record)
    if not found:
        raise mistake(root, place, f"no file matches {' or '.join([*pattern.train, *pattern.test])}")
    return dict(sorted(found.items()))


def _matches(text: str, base: str) -> list[tuple[str, str]]:
    """(unit, record) of every file that the pattern matches, sorted."""
    spec = parse_spec(text)
    file, part = str(spec.path), text[len(str(spec.path)) :] if "@" in text else ""
    expression = ""
    for piece in re.split(r"(\{unit\}|\*|\?)", file):
        if piece == PLACE:
            expression += "(?P=unit)" if "(?P<unit>" in expression else "(?P<unit>[^/]+?)"
        else:
            expression += {"*": "[^/]*", "?": "[^/]"}.get(piece, re.escape(piece))
    wild = "".join(
        "*" if piece == PLACE else piece if piece in "*?" else escape(piece)
        for piece in re.split(r"(\{unit\}|\*|\?)", file)
    )
    result = []
    for path in sorted(glob(wild, root_dir=base)):  # noqa: PTH207 - Path.glob takes no absolute pattern
        match = re.fullmatch(expression, path.replace(os.sep, "/"))
        if match:
            result.append((match["unit"], path + part))
    return result
