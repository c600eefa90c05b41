"""Other methods on the blind cases: who names the truth is exact, who names everything is not."""

from __future__ import annotations

import json
import re
import runpy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from blind import judge, page
from blind.case import Case, Truth
from blind.cases import Entry
from blind.others import answers, runner, table
from blind.others.method import Answer, Method, Motion, Problem, Record, Term, known, method
from blind.others.problem import Asked, asked, said
from blind.others.regression import BLOCKS, Regression, blocks, sparsest

pytestmark = pytest.mark.xdist_group("others")

EFFECT = "asymmetric_viscous_friction"
README = Path(page.__file__).with_name("README.md")


class Named(Method):
    """Names what it is given, and everything where it is given nothing."""

    title, tuning = "named", "none"

    def __init__(self, *places: tuple[str, int | None]) -> None:
        self.places = places

    def answer(self, problem: Problem) -> Answer:
        fit = Regression(problem)
        places = self.places or [t.place for t in problem.terms]
        chosen = [k for k, term in enumerate(fit.term) if problem.terms[term].place in places]
        return fit.answer(chosen)


@pytest.fixture(scope="module")
def case() -> Case:
    return Entry("b", 0, EFFECT, 1.3, "two").make()


@pytest.fixture(scope="module")
def ask(case: Case, tmp_path_factory: pytest.TempPathFactory) -> Asked:
    return asked(case, tmp_path_factory.mktemp("case"))


def judged(case: Case, ask: Asked, by: Method) -> judge.Verdict:
    answer = {"diagnosis": said(ask, by.answer(ask.problem))}
    return judge.judged(answers.truth_of(case), answer)


@pytest.mark.slow
def test_who_names_the_truth_is_exact_and_removes_what_it_adds(case: Case, ask: Asked) -> None:
    (joint,) = case.truth.joints
    found = judged(case, ask, Named((EFFECT, joint)))
    assert (found.exact, found.false_names, found.missed) == (True, (), False)
    line = {"diagnosis": said(ask, Named((EFFECT, joint)).answer(ask.problem))}
    gone, added = table.part(answers.truth_of(case), line)
    assert added == pytest.approx(1 - 1 / 1.3**2, abs=0.02)
    assert gone == pytest.approx(added, rel=0.25)  # another motion, where it adds about as much


@pytest.mark.slow
def test_who_names_everything_is_false(case: Case, ask: Asked) -> None:
    found = judged(case, ask, Named())
    assert not found.exact
    assert not found.missed
    assert len(found.false_names) == len({t.place for t in ask.problem.terms}) - 1


@pytest.mark.slow
def test_who_names_nothing_removes_nothing(case: Case, ask: Asked) -> None:
    class Silent(Method):
        title, tuning = "silent", "none"

        def answer(self, problem: Problem) -> Answer:
            return Answer(frozenset(), problem.test.own @ Regression(problem).own)

    line = {"diagnosis": said(ask, Silent().answer(ask.problem))}
    assert line["diagnosis"]["verdict"] == "nothing_missing"
    assert table.part(answers.truth_of(case), line)[0] == pytest.approx(0.0, abs=1e-4)


@pytest.mark.slow
def test_a_method_sees_neither_the_truth_nor_the_test_record(case: Case, ask: Asked) -> None:
    assert {p.name for p in ask.problem.folder.iterdir()} <= {
        "arms.yaml",
        "mapping.yaml",
        *(f"{name}.csv" for name in case.train),
    }
    assert not hasattr(ask.problem.test, "effort")


@pytest.mark.slow
def test_forward_selection_and_the_ladder_find_a_law_of_friction(case: Case, ask: Asked) -> None:
    (joint,) = case.truth.joints
    for name in ("bic", "ladder"):
        found = method(name).answer(ask.problem)
        assert (EFFECT, joint) in found.named, name
        assert found.effort.shape == ask.problem.test.q.shape


def small(rows: int = 400) -> Problem:
    """Two joints, a model of one column each, and a term that acts at joint 2 beside three that do not."""
    random = np.random.default_rng(5)

    def motion() -> Motion:
        q = random.normal(size=(rows, 2))
        own = np.zeros((rows, 2, 2))
        own[:, 0, 0], own[:, 1, 1] = q.T
        terms = []
        for j in (0, 1, 0, 1):
            column = np.zeros((rows, 2, 1))
            column[:, j, 0] = random.normal(size=rows)
            terms.append(column)
        return Motion(np.arange(rows) * 0.02, q, q, q, np.ones((rows, 2), dtype=bool), own, terms)

    first, test = motion(), motion()
    effort = first.own @ np.array([2.0, 3.0]) + first.terms[1][:, :, 0] + 0.1 * random.normal(size=(rows, 2))
    train = Record(**{k: getattr(first, k) for k in Motion.__dataclass_fields__}, effort=effort)
    terms = [
        Term("spring", 1, {}),
        Term("spring", 2, {}),
        Term("presliding", 1, {}),
        Term("presliding", 2, {}),
    ]
    return Problem(Path(), None, terms, [train], test)


def test_a_fit_predicts_the_test_record_from_the_training_records() -> None:
    problem = small()
    found = Regression(problem).answer([1])
    assert found.named == {("spring", 2)}
    right = problem.test.own @ np.array([2.0, 3.0]) + problem.test.terms[1][:, :, 0]
    assert found.effort == pytest.approx(right, abs=0.05)


def test_columns_that_the_user_s_model_explains_are_none() -> None:
    problem = small()
    same = replace(problem.train[0], terms=[problem.train[0].own[:, :, :1], *problem.train[0].terms[1:]])
    assert Regression(replace(problem, train=[same])).term.tolist() == [1, 2, 3]


def test_compressed_equations_have_the_same_sums_of_squares() -> None:
    fit = Regression(small())
    values = np.array([0.1, -0.2, 0.3, 0.4])
    for block, part in enumerate(fit.compressed()):
        rows = fit.block == block
        left = ((fit.target - fit.columns @ values)[rows] ** 2).sum()
        assert ((part[:, -1] - part[:, :-1] @ values) ** 2).sum() == pytest.approx(left)
    assert np.bincount(blocks(97)).tolist() == [10] * 7 + [9] * 3 or len(set(blocks(97))) == BLOCKS


def test_the_sparsest_choice_within_one_standard_error() -> None:
    best = np.tile([1.0, 3.0], 5)  # mean 2, standard error 1.054 / sqrt(10) = 0.333
    errors = np.array([best + 1.0, best, best + 0.3, best + 0.4])
    assert sparsest(errors) == 2


@pytest.mark.parametrize("name", ["bic", "ladder", "stlsq", "frols"])
def test_methods_find_the_one_term_that_is_there(name: str) -> None:
    if name in ("stlsq", "frols"):
        pytest.importorskip({"stlsq": "pysindy", "frols": "sysidentpy"}[name])
    problem = small()
    if name == "ladder":  # knows laws of friction alone
        problem = replace(problem, terms=[replace(t, effect="presliding") for t in problem.terms])
    found = method(name).answer(problem)
    assert found.named == {problem.terms[1].place}


def test_the_network_learns_what_is_left_and_names_nothing() -> None:
    pytest.importorskip("sklearn")
    problem = small()
    (train,) = problem.train
    bent = replace(train, effort=train.effort + 2.0 * np.sin(2.0 * train.q))
    found = method("network").answer(replace(problem, train=[bent]))
    assert not found.named
    own = problem.test.own @ Regression(replace(problem, train=[bent])).own
    right = problem.test.own @ np.array([2.0, 3.0]) + 2.0 * np.sin(2.0 * problem.test.q)
    assert np.mean((found.effort - right) ** 2) < 0.5 * np.mean((own - right) ** 2)


def test_the_method_of_the_page_runs(tmp_path: Path) -> None:
    parts = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    (text,) = [part for part in parts if "METHOD = " in part]
    (tmp_path / "largest.py").write_text(text)
    found = runpy.run_path(str(tmp_path / "largest.py"))["METHOD"].answer(small())
    assert found.named == {("spring", 2)}


def test_every_module_is_a_method_and_says_how_it_is_tuned() -> None:
    assert set(known()) >= {"bic", "frols", "ladder", "network", "stlsq"}
    for name in known():
        assert method(name).title
        assert method(name).tuning
    with pytest.raises(ValueError, match="no method 'oracle'"):
        method("oracle")


def line(entry: Entry, causes: list[tuple[str, int]], after: float) -> dict[str, Any]:
    truth = {"effect": None if entry.kind == "nothing" else entry.kind, "joints": [1], "met": entry.size}
    own = {k: getattr(entry, k) for k in ("family", "seed", "kind", "size", "setting")}
    found = [{"effect": e, "joint": j, "aliases": []} for e, j in causes]
    error = {"before": [2.0, 1.0], "after": [after, 1.0]}
    answer = {"verdict": "named", "causes": found, "suspects": [], "error": error}
    return {"truth": {"truth": truth, **own}, "answer": {"diagnosis": answer, "cpu_s": 1.0}}


ENTRIES = [Entry("b", k, "spring", 2.0, "two") for k in range(3)] + [Entry("b", 0, "nothing", None, "two")]


def test_scores_are_of_the_cases_that_all_have_answered(tmp_path: Path) -> None:
    right = [line(e, [("spring", 1)] if e.size else [], 1.0) for e in ENTRIES]
    wrong = [line(e, [("spring", 1), ("presliding", 2)], 2.0) for e in ENTRIES]
    answers.keep("bic", {answers.entry_of(x["truth"]): x for x in wrong[1:]}, tmp_path)
    ours, theirs = table.scores(right, tmp_path)
    assert (ours.hidden, ours.other, ours.false, ours.spurious) == ((2, 2), (1, 1), (0, 3), 0.0)
    # of nothing hidden the spring is false too
    assert (theirs.hidden, theirs.other, theirs.false) == ((0, 2), (0, 1), (3, 3))
    assert theirs.spurious == pytest.approx(4 / 3)
    assert ours.removed == pytest.approx((100.0,) * 3)  # 1 - (1 / 2)^2 of 1 - 1 / 2^2
    assert theirs.removed == pytest.approx((0.0,) * 3)
    assert "2 of 2 (34 to 100 %)" in table.table([ours, theirs])
    shown = table.picture([ours, theirs])
    assert shown.count("<circle") == 6
    assert table.scores(right, tmp_path / "empty") == []


def test_answers_to_other_records_do_not_count(tmp_path: Path) -> None:
    ours = [line(e, [], 1.0) for e in ENTRIES[:2]]
    others = json.loads(json.dumps(ours))
    ours[1]["answer"]["diagnosis"]["error"]["before"] = [2.0, None]  # a joint that rests
    others[1]["answer"]["diagnosis"]["error"]["before"] = [2.0, 0.0]
    others[0]["answer"]["diagnosis"]["error"]["before"] = [2.1, 1.0]
    answers.keep("bic", {answers.entry_of(x["truth"]): x for x in others}, tmp_path)
    assert table.scores(ours, tmp_path)[0].hidden[1] == 1


def test_who_gives_no_answer_removes_nothing() -> None:
    truth = line(ENTRIES[0], [], 1.0)["truth"]
    assert table.part(truth, {"failed": "Traceback"}) == (0.0, 0.75)


def test_the_runner_goes_on_and_keeps_what_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def made(entry: Entry) -> Case:
        return Case(
            entry.family, entry.seed, entry.kind, entry.size, entry.setting, "arm", "", None, {}, (), "test",
            Truth("spring", (1,), size=2.0), {},
        )  # fmt: skip

    monkeypatch.setattr(Entry, "make", made)
    monkeypatch.setattr(runner, "asked", lambda case, folder: None)
    seen: list[Method] = []

    def by(ask: None, one: Method) -> dict[str, Any]:
        seen.append(one)
        if one is methods["frols"]:
            raise RuntimeError("singular")
        return line(ENTRIES[0], [("spring", 1)], 1.0)["answer"]

    monkeypatch.setattr(runner, "answered", by)
    methods = {name: method(name) for name in ("bic", "frols")}
    assert runner.run(ENTRIES, methods, seconds=-1.0, folder=tmp_path) == len(ENTRIES)
    assert runner.run(ENTRIES[:1], methods, folder=tmp_path) == 0
    assert runner.run(ENTRIES[:2], methods, folder=tmp_path) == 0
    assert seen == [methods["bic"], methods["frols"]] * 2
    assert answers.lines("frols", tmp_path)[ENTRIES[0]]["answer"] == {"failed": "RuntimeError: singular"}
    assert answers.lines("bic", tmp_path)[ENTRIES[1]]["truth"]["truth"]["met"] == 2.0
    assert runner.run(ENTRIES[:2], methods, retry=True, folder=tmp_path) == 0
    assert seen[4:] == [methods["frols"]] * 2
    assert "bic 1, frols failed" in capsys.readouterr().out


def test_cases_come_by_lot_and_each_once() -> None:
    found = runner.entries()
    every = {answers.entry_of(truth) for truth, _ in page.every_case()}
    assert len(found) == len(every)
    assert set(found) == every
    half = found[: len(found) // 2]
    assert {e.family for e in half} == {e.family for e in every}
    assert {e.setting for e in half} == {e.setting for e in every}


def test_the_picture_is_that_of_the_kept_answers() -> None:
    assert page.PICTURE.read_text(encoding="utf-8") == table.picture(page.compared(page.every_case()))
