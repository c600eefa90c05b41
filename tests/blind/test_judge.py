"""The judge counts what the truth says, and the runner goes on where it was interrupted."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from blind import judge, runner
from blind.case import Case, Truth
from blind.cases import Entry, chosen, families, first_seed


def answer(*causes: tuple[str, int | None], verdict: str = "named", **more: Any) -> dict[str, Any]:
    named = [{"effect": e, "joint": j, "aliases": []} for e, j in causes]
    error = {"before": [2.0, 1.0], "after": [1.0, 1.0]}
    return {"diagnosis": {"verdict": verdict, "causes": named, "error": error, **more}, "cpu_s": 1.0}


def truth(effect: str | None, *joints: int | None) -> dict[str, Any]:
    return {"truth": {"effect": effect, "joints": list(joints)}, "kind": effect or "nothing"}


def test_exact_is_the_name_the_joint_and_nothing_else() -> None:
    said = truth("spring", 2)
    assert judge.judged(said, answer(("spring", 2))).exact
    elsewhere = judge.judged(said, answer(("spring", 1)))
    assert not elsewhere.exact
    assert elsewhere.missed
    assert elsewhere.false_names == ("spring 1",)
    beside = judge.judged(said, answer(("spring", 2), ("base_tilt", None)))
    assert (beside.exact, beside.missed, beside.false_names) == (False, False, ("base_tilt -",))
    assert judge.judged(said, answer(verdict="cannot_tell")).missed


def test_an_alias_is_the_same() -> None:
    found = answer(("base_tilt", None))
    found["diagnosis"]["causes"][0]["aliases"] = [{"effect": "spring", "joint": 2}]
    assert judge.judged(truth("spring", 2), found).exact


@pytest.mark.parametrize("hidden", [None, "outside"])
def test_where_there_is_no_name_any_name_is_false(hidden: str | None) -> None:
    assert judge.judged(truth(hidden), answer(verdict="nothing_missing")).exact
    assert judge.judged(truth(hidden), answer(("spring", 1))).false_names == ("spring 1",)


def test_causes_of_lost_motion_are_siblings() -> None:
    said = truth("backlash", 1)
    found = judge.judged(said, answer(("presliding", 1)))
    assert (found.sibling, found.exact, found.false_names) == (True, False, ())
    assert judge.judged(said, answer(("presliding", 2))).false_names == ("presliding 2",)
    assert judge.judged(said, answer(("torque_ripple", 1))).false_names == ("torque_ripple 1",)


def test_a_failure_is_never_exact() -> None:
    assert not judge.judged(truth(None), {"failed": "Traceback"}).exact
    assert not judge.judged(truth(None), {"refused": "no"}).exact
    assert judge.judged(truth("spring", 1), {"refused": "no"}).missed


def test_the_error_removed_is_of_both_joints() -> None:
    assert judge.removed(answer()["diagnosis"]) == pytest.approx(100 * (1 - np.sqrt((0.25 + 1) / 2)))
    assert judge.removed({"error": None}) is None


def test_wilson_s_interval() -> None:
    # Brown, Cai and DasGupta 2001 and tables: 0 of 10, and 81 of 263 as in Newcombe 1998
    assert judge.wilson(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)
    assert judge.wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=1e-4)
    assert judge.wilson(0, 0) == (0.0, 1.0)


def test_sets_are_apart_and_refuse_what_they_do_not_know() -> None:
    assert "b" in families()
    assert first_seed("working") == 0
    assert first_seed("cc5aff7d0") == first_seed("cc5aff7") == 1000 * (1 + 0xCC5AFF7)
    with pytest.raises(ValueError, match="neither 'working' nor a commit's hash"):
        first_seed("mine")
    with pytest.raises(ValueError, match="no kind 'rust'"):
        chosen("b", kinds=["rust"])
    with pytest.raises(ValueError, match="no family 'z'"):
        chosen("z")
    both = chosen("b", kinds=["nothing", "spring"], sizes=[1.1, 1.3], settings=["two"], count=2)
    assert [(e.seed, e.kind, e.size) for e in both[:3]] == [
        (0, "nothing", None),
        (0, "spring", 1.1),
        (0, "spring", 1.3),
    ]
    assert len(both) == len({e.name for e in both}) == 6


def test_the_runner_goes_on_and_the_table_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def made(entry: Entry) -> Case:
        return Case(
            entry.family, entry.seed, entry.kind, entry.size, entry.setting, "arm", "schema: 1\n", None,
            {"train_1": {"t": np.zeros(3)}, "test": {"t": np.ones(3)}}, ("train_1",), "test", Truth(None), {},
        )  # fmt: skip

    monkeypatch.setattr(Entry, "make", made)
    asked: list[str] = []

    def by(folder: Path) -> dict[str, object]:
        asked.append(folder.name)
        assert (folder / "train_1.csv").read_text() == "t\n0\n0\n0\n"
        assert runner.command(folder)[2:6] == ["modelgen", "diagnose", "arms.yaml", "--arm"]
        return answer(verdict="nothing_missing")

    entries = chosen("b", kinds=["nothing"], settings=["two"], count=3)
    assert runner.run(entries, tmp_path, seconds=-1.0, by=by) == 3
    assert runner.run(entries[:1], tmp_path, by=by) == 0
    assert runner.run(entries, tmp_path, by=by) == 0
    assert runner.run(entries, tmp_path, by=by) == 0
    assert asked == [e.name for e in entries]
    assert not list(tmp_path.rglob("*.csv"))
    failed = tmp_path / entries[1].name / runner.ANSWER
    failed.write_text('{"failed": "Traceback"}')
    assert runner.run(entries, tmp_path, by=by) == 0
    assert asked[3:] == []
    assert runner.run(entries, tmp_path, by=by, retry=True) == 0
    assert asked[3:] == [entries[1].name]
    rows = judge.counted(judge.answers(tmp_path))
    assert [(r["cases"], r["exact"]["count"], r["nothing_missing"]["count"]) for r in rows] == [(3, 3, 3)] * 2
    assert "3 (44 to 100 %)" in judge.table(rows)
    assert json.loads((tmp_path / entries[0].name / "truth.json").read_text())["train"] == ["train_1"]
    assert capsys.readouterr().out.count("nothing_missing") == 4
