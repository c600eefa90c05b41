"""Bad input to the diagnosis: one line that says what is wrong, exit 2, nothing written."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from modelgen.cli.app import app
from modelgen.dataset import read
from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.evaluation import places


@dataclass(frozen=True)
class Decision:
    code: int
    said: str


def words(folder: Path, out: Path, *more: str, train: tuple[str, ...], test: tuple[str, ...]) -> list[str]:
    command = ["diagnose", str(folder / "arms.yaml"), "--arm", "digger"]
    for name in train:
        command += ["--train", name]
    for name in test:
        command += ["--test", name]
    return [*command, "--out", str(out), *more]


def ask(folder: Path, out: Path, *more: str, train: tuple[str, ...], test: tuple[str, ...]) -> Decision:
    found = CliRunner().invoke(app, [*words(folder, out, *more, train=train, test=test), "--jobs", "1"])
    assert found.exception is None or isinstance(found.exception, SystemExit), found.exception
    return Decision(found.exit_code, " ".join(found.stderr.split()))


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
    """As users call it, in a process of its own; the other tests save its beginning."""
    one = str(logs / "train_a.csv")
    command = [sys.executable, "-m", "modelgen", *words(logs, tmp_path / "out", train=(one,), test=(one,))]
    answer = subprocess.run(command, capture_output=True, text=True, check=False, timeout=100)
    assert answer.returncode == 2
    (said,) = answer.stderr.splitlines()
    assert "share samples" in said
    assert "@" in said  # how to split it
    assert not (tmp_path / "out").exists()


def test_one_record_and_none_to_measure_the_gain_on(logs: Path, tmp_path: Path) -> None:
    answer = ask(logs, tmp_path / "out", train=(str(logs / "train_a.csv"),), test=())
    assert answer.code == 2
    assert "the gain cannot be measured" in answer.said
    assert "record the arm once more" in answer.said
    assert not (tmp_path / "out").exists()
    told = answer.said.split()
    options = told[told.index("--train") :]
    assert options[::2] == ["--train", "--test"]
    arm = load(logs / "arms.yaml", known_effects())["digger"]
    train, test = (read(spec, arm).t for spec in options[1::2])
    assert train[-1] < test[0]  # what it advises can be done
    assert len(train) == pytest.approx(3 * len(test), rel=0.01)


def test_records_with_and_without_efforts(logs: Path, tmp_path: Path) -> None:
    head, *lines = table(logs / "test.csv")
    kept = [k for k, name in enumerate(head) if not name.startswith(("i", "tau"))]
    free = written(tmp_path / "free.csv", [[line[k] for k in kept] for line in [head, *lines]])
    train = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    answer = ask(logs, tmp_path / "out", train=train, test=(free,))
    assert answer.code == 2
    assert "found no effort" in answer.said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--period", "7"), "does not repeat after 7 s"),
        (("--period", "0"), "found 0 s, expected at least 4 samples"),
        (("--period", "nan"), "found nan s"),
        (("--period", "inf"), "found inf s"),
        (("--period", "1e9"), "expected one of which a training record holds two"),
        (("--cutoff", "0"), "--cutoff: found 0 Hz, expected more than 0"),
    ],
)
def test_periods_and_bands_that_are_none(
    more: tuple[str, str], said: str, logs: Path, tmp_path: Path
) -> None:
    train = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    answer = ask(logs, tmp_path / "out", *more, train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert said in answer.said
    assert "Traceback" not in answer.said
    assert not (tmp_path / "out").exists()


def test_a_test_record_at_rest(logs: Path, tmp_path: Path) -> None:
    train = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    answer = ask(logs, tmp_path / "out", train=train, test=(lockstep(tmp_path, "still.csv", 3e-5),))
    assert answer.code == 2
    assert "still.csv: all joints rest in the test record" in answer.said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("record", ["train_a.csv", "train_b.csv"])
def test_efforts_of_the_wrong_sign(record: str, logs: Path, tmp_path: Path) -> None:
    """With what the other record says of the arm they fit the motion turned round."""
    head, *lines = table(logs / record)
    turned = [
        ["-" + x if name.startswith("i") else x for name, x in zip(head, line, strict=True)] for line in lines
    ]
    turned = [[x.removeprefix("--") for x in line] for line in turned]
    wrong = written(tmp_path / "turned.csv", [head, *turned])
    other = str(logs / ("train_b.csv" if record == "train_a.csv" else "train_a.csv"))
    answer = ask(logs, tmp_path / "out", train=(wrong, other), test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "turned.csv" in answer.said or other in answer.said  # of two it is not known which
    assert "with the other sign; expected one sign in all of them" in answer.said
    assert not (tmp_path / "out").exists()


def test_efforts_of_the_wrong_sign_in_all_records(logs: Path, tmp_path: Path) -> None:
    """Friction takes work from a motion, whatever else is unknown."""
    wrong = []
    for name in ("train_a.csv", "train_b.csv", "test.csv"):
        head, *lines = table(logs / name)
        turned = [
            [f"{-float(x):.9g}" if n.startswith("i") else x for n, x in zip(head, line, strict=True)]
            for line in lines
        ]
        wrong.append(written(tmp_path / name, [head, *turned]))
    answer = ask(logs, tmp_path / "out", train=(wrong[0], wrong[1]), test=(wrong[2],))
    assert answer.code == 2
    assert "would drive the motion" in answer.said
    assert "is their sign the other way round" in answer.said


def test_efforts_that_have_nothing_to_do_with_the_motion(logs: Path, tmp_path: Path) -> None:
    head, *lines = table(logs / "train_a.csv")
    random = np.random.default_rng(4)
    noise = [
        [f"{random.normal():.4f}" if name.startswith("i") else x for name, x in zip(head, line, strict=True)]
        for line in lines
    ]
    wrong = written(tmp_path / "noise.csv", [head, *noise])
    answer = ask(
        logs, tmp_path / "out", train=(str(logs / "train_b.csv"), wrong), test=(str(logs / "test.csv"),)
    )
    assert answer.code == 2
    assert "noise.csv: the model explains next to nothing" in answer.said
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
    assert "all 3 joints are at rest" in answer.said
    assert "Traceback" not in answer.said
    assert "modelgen excite" in answer.said
    assert not (tmp_path / "out").exists()


def test_all_joints_at_rest_under_a_shaking_brake(logs: Path, tmp_path: Path) -> None:
    train = lockstep(tmp_path, "one.csv", 2e-5), lockstep(tmp_path, "three.csv", 3e-5)
    answer = ask(logs, tmp_path / "out", train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "all joints rest in the training records" in answer.said
    assert not (tmp_path / "out").exists()


def test_records_too_short(logs: Path, tmp_path: Path) -> None:
    train = f"{logs / 'train_a.csv'}@0:0.8", f"{logs / 'train_b.csv'}@0:0.8"
    answer = ask(logs, tmp_path / "out", train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "too short a record" in answer.said
    assert not (tmp_path / "out").exists()


def test_a_refused_part_of_a_single_log_is_said_to_be_one(logs: Path, tmp_path: Path) -> None:
    train = f"{logs / 'train_a.csv'}@0:1.6"
    answer = ask(logs, tmp_path / "out", train=(train,), test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert f"{train}, the single training log, is split in two, and of the parts " in answer.said
    assert "too short a record" in answer.said


def test_an_effect_that_the_arm_has_already_is_no_candidate(logs: Path) -> None:
    arm = next(iter(load(logs / "arms.yaml", known_effects()).values()))
    assert places(arm, "coulomb_friction") == []
    assert 2 in places(arm, "load_dependent_friction")


def test_records_whose_joints_are_in_another_order(logs: Path, tmp_path: Path) -> None:
    _, *lines = table(logs / "train_b.csv")
    turned = written(tmp_path / "turned.csv", [["t", "qm2", "qm1", "qm3", "i2", "i1", "i3"], *lines])
    train = str(logs / "train_a.csv"), turned
    answer = ask(logs, tmp_path / "out", train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "no one model of digger fits both" in answer.said
    assert "turned.csv" in answer.said
    assert not (tmp_path / "out").exists()


def lockstep(folder: Path, name: str, size: float) -> str:
    """All motors follow one small sine: gravity, inertia and friction of the links look alike."""
    t = np.arange(2500) / 250.0
    motion = size * np.sin(np.pi * t)
    noise = np.random.default_rng(len(name)).normal(size=(len(t), 3))
    currents = noise + np.sign(np.cos(np.pi * t))[:, None]
    columns = [t, *(np.round(middle * (1 + motion)) for middle in (6e4, 5e4, 3.5e4)), *currents.T]
    lines = [[f"{x:.8g}" for x in row] for row in np.column_stack(columns)]
    return written(folder / name, [["t", "qm1", "qm2", "qm3", "i1", "i2", "i3"], *lines])


def test_a_motion_that_does_not_tell_the_models_own_parameters_apart(logs: Path, tmp_path: Path) -> None:
    train = lockstep(tmp_path, "one.csv", 0.004), lockstep(tmp_path, "three.csv", 0.005)
    answer = ask(logs, tmp_path / "out", train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "does not tell the model's parameters apart" in answer.said
    assert "modelgen excite" in answer.said
    assert not (tmp_path / "out").exists()


def slowed(logs: Path, folder: Path, name: str) -> str:
    """The record with the last joint shaken by a count or two, as a brake lets it."""
    head, *lines = table(logs / name)
    place = head.index("qm3")
    for k, line in enumerate(lines):
        line[place] = str(42245 + k // 250 % 2)
    return written(folder / name, [head, *lines])


def test_a_joint_at_rest_cannot_show_what_is_asked_for(logs: Path, tmp_path: Path) -> None:
    train = slowed(logs, tmp_path, "train_a.csv"), slowed(logs, tmp_path, "train_b.csv")
    more = "--effect", "stribeck_friction:3"
    answer = ask(logs, tmp_path / "out", *more, train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 2
    assert "bucket rests in the training records, which cannot show it" in answer.said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ("coulomb_friction:2", "the model of stick has it already"),
        ("viscous_friction", "the model of the arm has it already"),
        ("stribek_friction", "did you mean 'stribeck_friction'"),
        ("stribek", "did you mean 'stribeck_friction'"),
        ("stribeck_friction:9", "found joint '9', expected a joint of"),
        ("stribeck_friction:x", "found joint 'x', expected a joint of"),
    ],
)
def test_questions_that_make_no_sense(logs: Path, tmp_path: Path, asked: str, said: str) -> None:
    train = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    test = (str(logs / "test.csv"),)
    answer = ask(logs, tmp_path / "out", "--effect", asked, train=train, test=test)
    assert answer.code == 2
    assert said in answer.said
    assert "Traceback" not in answer.said
    assert not (tmp_path / "out").exists()


def test_one_effect_alone_is_asked_for(logs: Path, tmp_path: Path) -> None:
    train = str(logs / "train_a.csv"), str(logs / "train_b.csv")
    more = "--effect", "load_dependent_friction:2", "--json"
    answer = ask(logs, tmp_path / "out", *more, train=train, test=(str(logs / "test.csv"),))
    assert answer.code == 0
    found = json.loads((tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    assert {(r["effect"], r["joint"]) for turn in found["ranking"] for r in turn} == {
        ("load_dependent_friction", 2)
    }
