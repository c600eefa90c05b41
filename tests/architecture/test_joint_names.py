"""Joints by their names in what a user reads: no text is put together of "joint" and a number."""

import ast
import re
from collections.abc import Iterator

from architecture.house import files

BEFORE = re.compile(r"\bjoints? $")
NUMBER = re.compile(r"\+ 1\b|^(?:joint|n|j|k)$|\.joint$|\bnumber\b|\bjoint\b\W*\]$")
# Where a number is what the user gave, and no joint has it.
GIVEN = ("modelgen.diagnosis.candidates.requested", "modelgen.calibration.lever", "modelgen.dataset.")


def numbered(source: str) -> Iterator[str]:
    """Pieces of f-strings that say "joint" before a number."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.JoinedStr):
            continue
        for text, value in zip(node.values, node.values[1:], strict=False):
            said = isinstance(text, ast.Constant) and BEFORE.search(str(text.value))
            if said and isinstance(value, ast.FormattedValue):
                expression = ast.unparse(value.value)
                if NUMBER.search(expression):
                    yield expression


def test_joints_are_called_by_their_names() -> None:
    found = [
        f"{name}: joint {{{expression}}}"
        for name, path in files().items()
        if not name.startswith(GIVEN)
        for expression in numbered(path.read_text(encoding="utf-8"))
    ]
    assert not found, "\n".join(found)


def test_a_number_is_seen() -> None:
    assert list(numbered('f"a force at joint {j + 1} that"')) == ["j + 1"]
    assert list(numbered('f"{effect} at joint {c.joint}"')) == ["c.joint"]
    assert not list(numbered('f"joint {joint.name} has no drive"'))
