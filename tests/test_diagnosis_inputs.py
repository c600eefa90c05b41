"""Bad input to the diagnosis: one line that says what is wrong, exit 2, nothing written."""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.probing import places


@dataclass(frozen=True)
class Answer:
    code: int
    said: str


def ask(folder: Path, out: Path, *more: str, train: tuple[str, ...], test: tuple[str, ...]) -> Answer:
    command = [sys.executable, "-m", "modelgen", "diagnose", str(folder / "arms.yaml"), "--arm", "digger"]
    for name in train:
        command += ["--train", name]
    for name in test:
        command += ["--test", name]
    found = subprocess.run(
        [*command, "--out", str(out), *more], capture_output=True, text=True, check=False, timeout=100
    )
    return Answer(found.returncode, " ".join(found.stderr.split()))


@pytest.fixture(scope="module")
def logs(checkout: Path) -> Path:
    return checkout / "examples" / "diagnosis"


def table(path: Path) -> list[list[str]]:
    return [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()]


def written(path: Path, lines: list[list[str]]) -> str:
    path.write_text("\n".join(",".join(line) for line in lines) + "\n", encoding="utf-8")
    return str(path)


def still(logs: Path, folder: Path, name: str) -> str:
    head, first, *others = table(logs / "train_a.csv")
    shift = 0.01 if name == "two.csv" else 0.0
    lines = [[t[0], *first[1:4], *(f"{float(x) + shift:.4g}" for x in t[4:])] for t in [first, *others]]
    return written(folder / name, [head, *lines])


def test_one_record_for_everything(logs: Path, tmp_path: Path) -> None:
    one = str(logs / "train_a.csv")
    answer = ask(logs, tmp_path / "out", train=(one,), test=(one,))
    assert answer.code == 2
    assert "share samples" in answer.said
    assert "@" in answer.said  # how to split it
    assert not (tmp_path / "out").exists()


def test_one_record_and_none_to_measure_the_gain_on(logs: Path, tmp_path: Path) -> None:
    answer = ask(logs, tmp_path / "out", train=(str(logs / "train_a.csv"),), test=())
    assert answer.code == 2
    assert "the gain cannot be measured" in answer.said
    assert "record the arm once more" in answer.said
    assert not (tmp_path / "out").exists()


def test_records_with_and_without_efforts(logs: Path, tmp_path: Path) -> None:
    head, *lines = table(logs / "test.csv")
    kept = [k for k, name in enumerate(head) if not name.startswith(("i", "tau"))]
    free = written(tmp_path / "free.csv", [[line[k] for k in kept] for line in [head, *lines]])
    train = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    answer = ask(logs, tmp_path / "out", train=train, test=(free,))
    assert answer.code == 2
    assert "found no effort" in answer.said
    assert not (tmp_path / "out").exists()


def test_test_record_also_given_for_training(logs: Path, tmp_path: Path) -> None:
    a, b = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    answer = ask(logs, tmp_path / "out", train=(a, b), test=(b,))
    assert answer.code == 2
    assert "train_b.csv" in answer.said
    assert "share samples" in answer.said


def test_a_record_of_another_arm(logs: Path, tmp_path: Path) -> None:
    lines = [[*line[:3], *line[4:6]] for line in table(logs / "train_a.csv")]
    other = written(tmp_path / "two_joints.csv", lines)
    answer = ask(
        logs, tmp_path / "out", train=(str(logs / "train_b.csv"), other), test=(str(logs / "test.csv"),)
    )
    assert answer.code == 2
    assert "two_joints.csv" in answer.said
    assert not (tmp_path / "out").exists()


def test_all_joints_at_rest(logs: Path, tmp_path: Path) -> None:
    train = still(logs, tmp_path, "one.csv"), still(logs, tmp_path, "two.csv")
    answer = ask(logs, tmp_path / "out", train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "rest" in answer.said
    assert "Traceback" not in answer.said
    assert not (tmp_path / "out").exists()


def test_records_too_short(logs: Path, tmp_path: Path) -> None:
    train = f"{logs / 'train_a.csv'}@0:0.8", f"{logs / 'train_b.csv'}@0:0.8"
    answer = ask(logs, tmp_path / "out", train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "too short a record" in answer.said
    assert not (tmp_path / "out").exists()


def test_an_effect_that_the_arm_has_already_is_no_candidate(logs: Path) -> None:
    arm = next(iter(load(logs / "arms.yaml", known_effects()).values()))
    assert places(arm, "coulomb_friction") == []
    assert 2 in places(arm, "load_dependent_friction")
