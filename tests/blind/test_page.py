"""The page of the blind benchmark is that of the kept answers, and its table of checks counts them again."""

from __future__ import annotations

import re
from typing import Any

import pytest
from blind import ablation, page


def found(effect: str, joint: int, **passed: bool | None) -> dict[str, Any]:
    checks = [{"name": k, "passed": v, "decides": k != "stable"} for k, v in passed.items()]
    return {"effect": effect, "joint": joint, "aliases": [], "checks": checks}


def case(
    effect: str | None, causes: list[dict[str, Any]], suspects: list[dict[str, Any]]
) -> ablation.Answered:
    said = {"truth": {"effect": effect, "joints": [1]}, "kind": effect or "nothing"}
    return said, {"diagnosis": {"verdict": "named", "causes": causes, "suspects": suspects}}


CASES = [
    case("spring", [found("spring", 1, form=True, gain=True, stable=False)], []),
    case("spring", [], [found("spring", 1, form=False, gain=True, stable=True)]),
    case(None, [], [found("spring", 2, form=False, gain=False, stable=True)]),
]


@pytest.mark.parametrize(
    ("row", "exact", "named"),
    [
        ("as they are", 1, 0),
        ("without `form`", 2, 0),  # the third fails another one too
        ("without `gain`", 1, 0),
        ("without any", 2, 1),
        ("`stable` decides too", 0, 0),
    ],
)
def test_a_check_is_worth_what_it_alone_decides(row: str, exact: int, named: int) -> None:
    (counts,) = [cells for text, *cells in ablation.ablated(CASES) if text == row]
    assert counts == [f"{exact} of 2", "0 of 2", f"{named} of 1"]


def test_the_page_is_that_of_the_kept_answers() -> None:
    assert page.PAGE.read_text(encoding="utf-8") == page.page()


def test_the_answer_in_words_is_the_sum_of_the_sets_that_are_shown() -> None:
    """Counted from the page's own table by family and records, without the judge."""
    text = page.PAGE.read_text(encoding="utf-8")
    words, short, long = (
        part.split("</details>")[0] for part in re.split(r"^\| (?:hidden|family) .*", text, flags=re.M)[:3]
    )
    sums: dict[tuple[str, str], list[int]] = {}
    for line in long.splitlines()[2:]:
        if cells := [cell.strip() for cell in line.strip("|").split("|")][2:7]:
            counts = sums.setdefault((cells[0], cells[1]), [0, 0, 0])
            for k, cell in enumerate(cells[2:]):
                counts[k] += int(cell.split()[0])
    for (hidden, size), (arms, exact, false) in sums.items():
        shown = rf"{exact} of {arms} \(.* \| {false} of {arms} \("
        assert re.search(rf"^\| {hidden} \| {size} \| {shown}", short, re.M)
    said = [tuple(map(int, found)) for found in re.findall(r"(\d+)\s+of\s+(\d+)\s+arms", words)]
    nothing, one, outside = (sums[k] for k in (("nothing", "-"), ("one effect", "1.30"), ("outside", "1.30")))
    assert said == [
        (nothing[2], nothing[0]),
        (one[1], one[0]),
        (one[2], one[0]),
        (outside[2], outside[0]),
    ]


def test_what_is_kept_gives_the_same_counts(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "RUNS", tmp_path)
    monkeypatch.setattr(
        page,
        "answers",
        lambda folder: [({**s, "family": "x", "seed": 0, "size": None, "setting": "y"}, a) for s, a in CASES],
    )
    page.keep("set", "a set", tmp_path)
    found = page.kept("set")
    assert (found.text, found.number) == ("a set", 1)
    assert ablation.ablated(found.cases) == ablation.ablated(CASES)
    page.keep("another", "a set", tmp_path)
    page.keep("set", "the same once more", tmp_path)
    assert {name: one.number for name, one in page.sets().items()} == {"set": 1, "another": 2}
