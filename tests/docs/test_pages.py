"""What the pages for engineers say of the repository is true: files, folders, links, targets of make."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ("docs/architecture.md", "docs/glossary.md", "docs/diagnosis_method.md", "CONTRIBUTING.md")
PLACE = re.compile(r"`((?:modelgen|tests|docs|templates|benchmarks|examples|generated)/[\w./-]*|\.ci/\w+)`")


def page(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", PAGES)
def test_places_that_a_page_names_are_there(name: str) -> None:
    named = PLACE.findall(page(name))
    assert named or name == "docs/diagnosis_method.md"
    missing = [place for place in named if not (ROOT / place).exists()]
    assert not missing


def test_files_that_stand_beside_others_are_there() -> None:
    """`pool.py` alone, in a line that has named its folder."""
    for line in page("docs/architecture.md").splitlines():
        alone = re.findall(r"`(\w+\.py)`", line)
        if alone:
            found = {path.name for path in (ROOT / "modelgen").rglob("*.py")}
            assert set(alone) <= found, line


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md"])
def test_targets_of_make_are_there(name: str) -> None:
    text = page(name)
    asked = set(re.findall(r"`make ([\w-]+)", text)) | set(re.findall(r"^make ([\w-]+)", text, re.MULTILINE))
    there = set(re.findall(r"^([\w-]+):(?!=)", page("Makefile"), re.MULTILINE))
    assert asked
    assert asked <= there


@pytest.mark.parametrize("title", ["The way of one record", "The way of one candidate"])
def test_a_way_is_told_in_ten_lines(title: str) -> None:
    """Steps whose files are named; a cut that needs more is the wrong one."""
    section = re.split(r"^## ", page("docs/architecture.md"), flags=re.MULTILINE)
    (told,) = [part for part in section if part.startswith(f"{title}\n")]
    steps = re.findall(r"^\d+\. ", told, re.MULTILINE)
    assert 5 <= len(steps) <= 10
    assert len(PLACE.findall(told)) >= 8


def test_terms_of_the_glossary_stand_once_and_in_order() -> None:
    terms = re.findall(r"^\*\*(.+?)\*\*", page("docs/glossary.md"), re.MULTILINE)
    assert len(terms) > 40
    by_letter = [term.lower().rstrip(".") for term in terms]
    assert by_letter == sorted(set(by_letter))
