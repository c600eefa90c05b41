"""The matrix of `make blind`, and the page it writes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hidden import blind, blind_report
from hidden.arms import DESIGNS
from hidden.cases import RECORDS, Bench
from hidden.drawing import draw
from hidden.effects import CATALOGUE, OUTSIDE
from hidden.tallies import wilson


def test_the_matrix_holds_enough_of_everything() -> None:
    items = blind.matrix()
    assert len({item.key for item in items}) == len(items)

    def count(group: str, strength: float | None = None) -> int:
        return sum(item.group == group and strength in (None, item.strength) for item in items)

    assert count("null") == 200
    assert all(count("single", strength) >= 60 for strength in (1.05, 1.10, 1.30))
    assert count("outside", 1.3) >= 60
    assert count("pair") == 30
    assert {item.effects[0] for item in items if item.group == "single"} == set(CATALOGUE)
    # A run that is stopped after a tenth has seen every group.
    assert {item.group for item in items[: len(items) // 10]} == {item.group for item in items}


def test_pairs_are_of_two_effects() -> None:
    pairs = [item.effects for item in blind.matrix() if item.group == "pair"]
    assert all(len(set(pair)) == 2 for pair in pairs)
    assert len(set(pairs)) == len(pairs)


def test_a_drawn_case_has_its_strength_and_is_drawn_again_the_same() -> None:
    first, again = (draw(77, ("spring",), 1.1, ("direct2", "levered2")) for _ in range(2))
    assert first == again
    assert first.arm in DESIGNS
    assert first.hidden[0].magnitude is not None


def test_more_training_records_are_of_the_same_arm_with_the_same_effect() -> None:
    few, many = (draw(77, ("spring",), 1.1, ("direct2", "levered2"), train=count) for count in (2, 5))
    assert few.hidden == many.hidden
    assert [RECORDS[k] for k in few.records] == ["train_a", "train_b", "test", "check"]
    assert [RECORDS[k] for k in many.training] == ["train_a", "train_b", "train_c", "train_d", "train_e"]
    by = {0: few.hidden[0].magnitude or 0.0}
    one, other = Bench(few), Bench(many)
    for k in few.records:
        np.testing.assert_array_equal(one.record(k, by).current, other.record(k, by).current)
    # and of motions of their own
    currents = [other.record(k, by).current for k in many.training]
    assert all(np.abs(a - b).max() > 0.01 for k, a in enumerate(currents) for b in currents[:k])


@pytest.mark.parametrize(
    ("hits", "total", "low", "high"),
    [(0, 200, 0.0, 0.0188), (57, 60, 0.8630, 0.9829), (5, 10, 0.2366, 0.7634), (0, 0, 0.0, 1.0)],
)
def test_wilson_intervals(hits: int, total: int, low: float, high: float) -> None:
    assert wilson(hits, total) == pytest.approx((low, high), abs=2e-4)


def line(group: str, effects: list[str], result: str, number: int, **more: Any) -> dict[str, Any]:
    named = [[effects[0], 1]] if effects and result == "found" and group != "outside" else []
    return {
        "key": f"{group}/{'+'.join(effects)}/{number}",
        "seed": 5,
        "commit": "0123456789ab",
        "group": group,
        "train": 2,
        "effects": effects,
        "strength": 1.3,
        "result": result,
        "by_class": result,
        "verdict": "nothing_missing" if not effects else "named",
        "named": named,
        "in_set": result == "found",
        "size": 1.0,
        "shown": 30.0,
        "recovered": 0.95 if named else None,
        "seconds": 3.0,
        "case": {"arm": "direct2"},
        **more,
    }


def test_the_page_counts_what_the_lines_say(tmp_path: Path) -> None:
    lines = [line("null", [], "found", k) for k in range(10)]
    lines += [line("single", ["spring"], "found" if k else "missed", k) for k in range(4)]
    lines += [line("outside", [OUTSIDE[0]], "found", 0)]
    lines += [
        {
            "key": "x",
            "seed": 5,
            "commit": "0123456789ab",
            "group": "single",
            "train": 2,
            "effects": ["spring"],
            "strength": 1.3,
            "failed": "exit 1\nboom",
        }
    ]
    lines += [line("single", ["spring"], "found", k, train=4) for k in range(2)]
    for folder in ("one", "two"):
        blind_report.write(lines, tmp_path / folder, 40)
    page = (tmp_path / "one" / "diagnosis.md").read_text()
    assert "Seed 5, commit 0123456789ab. 2 training records: 16 of 40 cases, 15 answered, 1 failed" in page
    assert "\n4 training records: 2 of 40 cases, 2 answered, 0 failed, 0 undrawn.\n" in page
    assert "| question | 2 training records | 4 training records |" in page
    assert "| nothing hidden: something named | 0 of 10: 0.0 % (0.0 to 27.8) | no case |" in page
    assert "| one effect, s = 1.3: cause and joint, no extra | 3 of 4: 75.0 % (30.1 to 95.4) | 2 of 2" in page
    assert "| `spring` | 3 | 1 | 0 | – |" in page
    assert "- `x`, 2 training records: boom" in page
    for name in ("diagnosis.md", "diagnosis_power.svg", "diagnosis_confusion.svg"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_a_run_is_taken_up_again_but_for_its_failures(tmp_path: Path) -> None:
    path = tmp_path / "5.jsonl"
    assert blind.kept(path) == {}
    texts = ["a", 2, "result"], ["b", 2, "failed"], ["b", 4, "failed"], ["b", 2, "result"]
    path.write_text("".join(json.dumps({"key": k, "train": n, word: "x"}) + "\n" for k, n, word in texts))
    found = blind.kept(path)
    assert list(found) == [("a", 2), ("b", 2), ("b", 4)]
    assert ["failed" in item for item in found.values()] == [False, False, True]


def test_a_page_of_no_cases_and_of_unlike_columns(tmp_path: Path) -> None:
    blind_report.write([], tmp_path, 40)
    assert "## By effect" not in (tmp_path / "diagnosis.md").read_text()
    weak = line("single", ["spring"], "found", 1, train=4) | {"strength": 1.05}
    blind_report.write([line("single", ["spring"], "found", 0), weak], tmp_path, 40)
    page = (tmp_path / "diagnosis.md").read_text()
    assert "| one effect, s = 1.05: cause and joint, no extra | no case | 1 of 1" in page
    assert page.index("s = 1.05: cause") < page.index("s = 1.3: cause") < page.index("seconds for")
