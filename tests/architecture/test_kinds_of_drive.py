"""A kind of drive is known by its class alone: no other part asks which kind it has before it."""

import ast
from collections.abc import Iterator

import pytest

from architecture.house import files
from modelgen.transmission import KINDS, Drive

FREE = ("modelgen.transmission", "modelgen.description")  # where kinds are defined, and read from YAML
CLASSES = {kind.__name__ for kind in KINDS.values()} | {Drive.__name__}
NAMES = set(KINDS) - {"none"}  # the word "none" is used of other things too


def asked(source: str) -> Iterator[str]:
    """Lines that tell kinds apart: by isinstance, by a pattern, by `type` or by a name."""
    for node in ast.walk(ast.parse(source)):
        suspects: list[ast.AST] = []
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("isinstance", "issubclass"):
            suspects = list(node.args[1:])
        elif isinstance(node, ast.MatchClass):
            suspects = [node.cls]
        elif isinstance(node, ast.Compare):
            suspects = [node.left, *node.comparators]
        elif isinstance(node, ast.MatchValue):
            suspects = [node.value]
        for suspect in suspects:
            for part in ast.walk(suspect):
                word = (
                    part.id
                    if isinstance(part, ast.Name)
                    else part.attr
                    if isinstance(part, ast.Attribute)
                    else part.value
                    if isinstance(part, ast.Constant)
                    else None
                )
                if word in CLASSES or (isinstance(part, ast.Constant) and word in NAMES):
                    yield f"{node.lineno if hasattr(node, 'lineno') else 0}: {ast.unparse(node)}"


def test_no_part_asks_which_kind_of_drive_it_has() -> None:
    found = [
        f"{module}:{line}"
        for module, path in files().items()
        if not module.startswith(FREE)
        for line in asked(path.read_text(encoding="utf-8"))
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "source",
    [
        "isinstance(joint.drive, LeveredDrive)",
        "isinstance(drive, DirectDrive | description.LeveredDrive)",
        "issubclass(kind, (int, SliderCrank))",
        "type(drive) is NoDrive",
        "drive.name == 'levered'",
        "type(drive).__name__ in ('LeveredDrive', 'x')",
        "match drive:\n    case DirectDrive(ratio=r):\n        pass",
        "match drive.name:\n    case 'slider_crank':\n        pass",
    ],
)
def test_a_question_for_the_kind_is_seen(source: str) -> None:
    assert list(asked(source))


@pytest.mark.parametrize("source", ["joint.drive.driven", "DirectDrive(2.0, 0.1)", "options == 'none'"])
def test_what_every_drive_answers_is_free(source: str) -> None:
    assert not list(asked(source))
