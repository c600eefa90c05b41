"""The page of the blind benchmark is that of the kept answers, and its table of checks counts them again."""

from __future__ import annotations

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
