"""An effect is known by its class alone: no name of the catalogue stands outside modelgen/effects."""

import ast

import pytest

from architecture.house import files
from modelgen.effects import CATALOGUE


def names_in(source: str) -> list[tuple[int, str]]:
    """Line and text of every string that is the name of an effect."""
    return [
        (node.lineno, node.value)
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in CATALOGUE
    ]


def test_no_effect_is_named_outside_its_package() -> None:
    found = [
        f"{module}:{line}: {name}"
        for module, path in files().items()
        if not module.startswith("modelgen.effects")
        for line, name in names_in(path.read_text(encoding="utf-8"))
    ]
    assert not found, "what another part must know of an effect is an attribute of its class:\n" + "\n".join(
        found
    )


@pytest.mark.parametrize(
    "source", ['if c.effect == "spring":\n    pass', 'X = {"backlash": 1}', 'f(("time_delay",))']
)
def test_a_name_is_seen(source: str) -> None:
    assert len(names_in(source)) == 1
    assert not names_in('"""As a spring has it."""')
