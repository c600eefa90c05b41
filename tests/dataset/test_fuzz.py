"""Whatever stands in a log or a mapping: a record, or one line that says what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
from dataset_support import AXIS, AXIS_LOG, AXIS_MAPPING, DRIVEN, columns, times, write_csv
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from modelgen.dataset import read
from modelgen.dataset.mapping.formula import FormulaError, formula
from modelgen.errors import InputError

QUIET = settings(max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture])
PIECES = [
    "",
    "[",
    "]",
    "{}",
    ": ",
    "-1",
    "1e400",
    "nan",
    "null",
    "&a ",
    "*a",
    "\n",
    "\t",
    "'",
    '"',
    "é",
    "0",
    "pi",
    "!x ",
]


def attempt(file: str, mapping: Path | None = None) -> None:
    message = "a record"
    try:
        record = read(file, AXIS if mapping else DRIVEN, mapping)
        assert record.q.shape == (len(record.t), record.n)
    except InputError as error:
        message = str(error)
    assert message
    assert "\n" not in message


@QUIET
@given(place=st.integers(0, len(AXIS_MAPPING)), length=st.integers(0, 12), piece=st.sampled_from(PIECES))
def test_an_edited_mapping(place: int, length: int, piece: str, tmp_path: Path) -> None:
    log = tmp_path / "a.csv"
    if not log.exists():
        write_csv(log, {name: column[:60] for name, column in AXIS_LOG.items()})
    mapping = tmp_path / "mapping.yaml"
    mapping.write_text(AXIS_MAPPING[:place] + piece + AXIS_MAPPING[place + length :], encoding="utf-8")
    attempt(str(log), mapping)


@QUIET
@given(place=st.integers(0, 4000), length=st.integers(0, 30), piece=st.binary(max_size=12))
def test_an_edited_log(place: int, length: int, piece: bytes, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    if not (whole := tmp_path / "whole.csv").exists():
        write_csv(whole, columns(times(1.0, 60.0)))
    text = whole.read_bytes()
    path.write_bytes(text[:place] + piece + text[place + length :])
    attempt(str(path))


@QUIET
@given(text=st.text(alphabet="ab1.+-*/() ,_xe\"'[]=:pi", max_size=40))
def test_any_text_as_a_formula(text: str) -> None:
    try:
        formula(text, ("a", "b"))
    except FormulaError:
        return


@pytest.mark.parametrize(
    "text", ["@", "@:", "a.csv@", "@1:2", "a.csv@1:2:3", "a.csv@1", "a\0b.csv", "x" * 300]
)
def test_any_text_as_a_specification(text: str, tmp_path: Path) -> None:
    with pytest.raises(InputError):
        read(str(tmp_path / text), AXIS)
