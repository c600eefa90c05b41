"""YAML as the description reads it: YAML 1.2, every mistake with its place."""

from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from modelgen.description import load
from modelgen.description.document import parse
from modelgen.errors import InputError, Location


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-1.5", -1.5),
        ("1e-3", 0.001),
        ("+.5E2", 50.0),
        (".inf", float("inf")),
        ("~", None),
        ("true", True),
        ("yes", "yes"),
        ("1_000", "1_000"),
        ("12:30:00", "12:30:00"),
        ("2001-01-01", "2001-01-01"),
        ("'1'", "1"),
        ("pi/2", "pi/2"),
        ("9" * 400, float("inf")),
    ],
)
def test_scalars_follow_the_core_schema(text: str, value: Any) -> None:
    found = parse(text, "f").plain()
    assert found == value
    assert type(found) is type(value)


def test_the_tree_is_the_one_that_ruamel_reads(checkout: Path) -> None:
    text = (checkout / "arms.yaml").read_text(encoding="utf-8")
    assert parse(text, "arms.yaml").plain() == YAML(typ="safe", pure=True).load(text)


def test_every_value_knows_its_place() -> None:
    root = parse("a:\n  - b: 1\n    c: [2, 3]\n", "f")
    assert root.locate(["a", 0, "c", 1]) == Location("f", 3, 12)
    assert root.locate(["a", 0, "c"], key=True) == Location("f", 3, 5)
    assert root.locate(["a", 0, "missing"]) == Location("f", 2, 5)
    assert str(root.locate(["a", 0, "b"])) == "f:2:8"


def test_an_alias_stands_for_the_whole_value() -> None:
    assert parse("a: &x {b: [1, 2]}\nc: *x\n", "f").plain() == {"a": {"b": [1, 2]}, "c": {"b": [1, 2]}}


BOMB = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
    f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 10)
)
TOWER = "a0: &a0 [1]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}]\n" for i in range(1, 40))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "f:1:1: the file is empty"),
        ("# nothing but a comment\n", "f:1:1: the file is empty"),
        ("a: 1\nb: 2\na: 3\n", "f:3:1: the key 'a' is given twice, first on line 1"),
        ("a: {b: 1, c: 2,\n  'b': 3}", "f:2:3: the key 'b' is given twice, first on line 1"),
        ("a:\n  - b\n c: 1\n", "f:3:2: this is no valid YAML"),
        ("a: [1, 2", "this is no valid YAML"),
        ("a: 'x", "this is no valid YAML"),
        ("a: \x07", "this is no valid YAML"),
        ("a: *x", "f:1:4: found the alias *x, expected its anchor before it"),
        ("a: &x [1, *x]", "f:1:11: the alias *x stands inside its own anchor"),
        ("a: &x {b: *x}", "f:1:11: the alias *x stands inside its own anchor"),
        ("a: !!python/object:os.system x", "f:1:4: found a YAML tag"),
        ("a: !!str 5", "f:1:4: found a YAML tag"),
        ("a: {<<: 1}", "f:1:5: merge keys (<<) are not part of YAML 1.2"),
        ("? [1, 2]\n: 3", "found a key that is no plain text"),
        ("---\na: 1\n---\nb: 2\n", "f:3:1: found a second YAML document"),
        ("[" * 5000, "nested deeper than 24 levels"),
        ("- " * 5000, "nested deeper than 24 levels"),
        ("? " * 5000, "found a key that is no plain text"),
        (BOMB, "f:5:5: the document has more than 100000 values, aliases expanded"),
        (TOWER, "nested deeper than 24 levels"),
        ("x" * 1_000_001, "f:1:1: found 1000001 characters, at most 1000000 are read"),
    ],
)
def test_what_is_no_plain_document_is_refused_with_its_place(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        parse(text, "f").plain()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file; `modelgen init NAME`"):
        load(tmp_path / "arms.yaml")


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="found a folder, expected a YAML file"):
        load(tmp_path)


def test_a_path_that_no_system_knows() -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load("arms\0.yaml")


def test_text_is_utf_8(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes(b"schema: 1\nsource: \xe9t\xe9\n")
    with pytest.raises(InputError) as caught:
        load(path)
    assert str(caught.value) == f"{path}:2:9: found the byte 0xe9, expected UTF-8 text"


def test_a_byte_order_mark_does_no_harm(tmp_path: Path, checkout: Path) -> None:
    path = tmp_path / "arms.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + (checkout / "arms.yaml").read_bytes())
    assert load(path) == load(checkout / "arms.yaml")
