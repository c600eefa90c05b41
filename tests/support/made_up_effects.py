"""An effect of each kind that the catalogue lacks: the classes of docs/howto/effect.md."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from modelgen.effects import CATALOGUE
from modelgen.effects.base import Definition

PAGE = Path(__file__).resolve().parents[2] / "docs" / "howto" / "effect.md"
CLASS = re.compile(r"<!-- append: (modelgen/effects/laws/\w+)\.py -->\n```python\n(.*?)```", re.DOTALL)


def made_up() -> dict[str, type[Definition]]:
    """The page's classes by name, each made among the names of the module that it is appended to."""
    found: dict[str, type[Definition]] = {}
    for file, text in CLASS.findall(PAGE.read_text(encoding="utf-8")):
        names = dict(vars(import_module(file.replace("/", "."))))
        before = set(names)
        exec(text, names)  # noqa: S102  the page is ours
        for name in names.keys() - before:
            thing = names[name]
            if isinstance(thing, type) and issubclass(thing, Definition):
                found[thing.name] = thing
    return found


@contextmanager
def in_the_catalogue() -> Iterator[dict[str, type[Definition]]]:
    """The made-up effects, known to every command for as long as this lasts."""
    added = made_up()
    assert not added.keys() & CATALOGUE.keys()
    CATALOGUE.update(added)
    try:
        yield added
    finally:
        for name in added:
            del CATALOGUE[name]
