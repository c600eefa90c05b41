"""A function does what its command does: the same files byte for byte, the same data, the same refusals."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_support import called

import modelgen as mg

ARMS = """
schema: 1
convention: khalil_kleinfinger
arms:
  boom:
    gravity: [0, 0, -9.81]
    joints:
      - name: lift
        alpha: pi/2
        d: 0.1
        r: 0
        limits: {position: [-25 deg, 60 deg], velocity: 1.5, acceleration: 6}
        drive: {type: levered, l1: 0.32, l2: 0.06, length: [0.27, 0.36], motor: [0, 20000], rev: 1,
                offset: -60 deg, torque_constant: 1.0e-4}
        effects:
          - viscous_friction: {coefficient: 2.0e-6}
          - coulomb_friction: {magnitude: 1.0e-4}
          - drive_inertia: {inertia: 1.0e-8}
    links:
      lift: {mass: 4, com: [0.3, 0.02, 0], inertia: [0.01, 0, 0, 0.3, 0, 0.3]}
"""
RATE, PERIOD = 100, 4.0


def motion(t: np.ndarray, phase: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position, speed and acceleration of two harmonics about the middle of the range."""
    w = 2 * math.pi / PERIOD
    q = 0.3 + 0.35 * np.sin(w * t + phase) + 0.12 * np.sin(3 * w * t)
    dq = 0.35 * w * np.cos(w * t + phase) + 0.36 * w * np.cos(3 * w * t)
    ddq = -0.35 * w**2 * np.sin(w * t + phase) - 1.08 * w**2 * np.sin(3 * w * t)
    return q[:, None], dq[:, None], ddq[:, None]


def written(path: Path, columns: dict[str, np.ndarray]) -> None:
    table = np.stack(list(columns.values()), axis=1)
    np.savetxt(path, table, fmt="%.12g", delimiter=",", header=",".join(columns), comments="")


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a description, three records of a motion with a hidden spring, and motor beside angle."""
    folder = tmp_path_factory.mktemp("bench")
    (folder / "arms.yaml").write_text(ARMS, encoding="utf-8")
    model = mg.build_model(mg.load_arms(folder / "arms.yaml")["boom"])
    functions, t = model.functions, np.arange(int(3 * PERIOD * RATE)) / RATE
    for seed, name in enumerate(("a", "b", "c")):
        rng = np.random.default_rng(seed)
        q = motion(t, seed / 3)[0]
        at = motion(t + 0.5 / RATE, seed / 3)  # the current is held until the next sample
        current = functions["inverse_dynamics"](*at, model.nominal)
        current += 12 * (at[0] - 0.2) / functions["drive_gain"](at[0])
        current *= 1 + 0.003 * rng.normal(size=current.shape)
        written(folder / f"{name}.csv", {"t": t, "q1": q[:, 0], "i1": current[:, 0]})
    q, dq, ddq = motion(t, 0.0)
    turned = functions["motor_from_joint"](q, dq, ddq)
    counts = np.round(turned[0] if isinstance(turned, tuple) else turned)[:, 0]
    noise = 1e-4 * np.random.default_rng(9).normal(size=len(t))
    written(folder / "lever.csv", {"t": t, "qm1": counts, "q1": q[:, 0] + 0.01 + noise})
    return folder


@pytest.fixture
def arm(bench: Path, monkeypatch: pytest.MonkeyPatch) -> mg.Arm:
    """The arm; commands and functions are called in the bench's folder."""
    monkeypatch.chdir(bench)
    return mg.load_arms()["boom"]


def content(folder: Path) -> dict[str, bytes]:
    """Every file by its name, with one name in place of the folder's, which the commands of pages have."""
    own = str(folder).encode()
    return {
        p.relative_to(folder).as_posix(): p.read_bytes().replace(own, b"OUT")
        for p in folder.rglob("*")
        if p.is_file()
    }


def generated(arm: mg.Arm, out: Path) -> mg.Generated:
    return mg.generate(arm, out)


def simulated(arm: mg.Arm, out: Path) -> mg.Simulation:
    found = mg.simulate(arm, q0="-10 deg", duration=1.0, rate=200)
    found.write(out)
    return found


def excited(arm: mg.Arm, out: Path) -> mg.Excitation:
    found = mg.excite(arm, period=6, starts=1, iterations=5, processes=1)
    found.write(out)
    return found


def calibrated(arm: mg.Arm, out: Path) -> mg.Calibration:
    found = mg.calibrate(arm, 1, "lever.csv")
    found.write(out)
    return found


def identified(arm: mg.Arm, out: Path) -> mg.Identification:
    found = mg.identify(arm, train=["a.csv", Path("b.csv")], test="c.csv", method="ols")
    found.write(out)
    return found


def refined(arm: mg.Arm, out: Path) -> mg.Refinement:
    found = mg.refine(arm, "a.csv@0:4", free=["MX1"])
    found.write(out)
    return found


def diagnosed(arm: mg.Arm, out: Path) -> mg.Diagnosis:
    found = mg.diagnose(arm, train=["a.csv", "b.csv"], test="c.csv", processes=1)
    found.write(out)
    return found


COMMANDS: dict[str, tuple[str, Callable[[mg.Arm, Path], Any]]] = {
    "generate": ("--out {out}", generated),
    "simulate": (
        "--q0 '-10 deg' --duration 1 --rate 200 --out {out}/simulation.csv --plot {out}/simulation.svg "
        "--animation {out}/simulation.html",
        simulated,
    ),
    "excite": ("--period 6 --starts 1 --iterations 5 --jobs 1 --out {out}/trajectory.csv", excited),
    "calibrate": ("lever.csv --joint 1 --out {out}", calibrated),
    "identify": ("--train a.csv --train b.csv --test c.csv --method ols --out {out}", identified),
    "refine": ("--log a.csv@0:4 --free MX1 --out {out}", refined),
    "diagnose": ("--train a.csv --train b.csv --test c.csv --jobs 1 --out {out}", diagnosed),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_function_writes_and_says_what_its_command_does(command: str, arm: mg.Arm, tmp_path: Path) -> None:
    arguments, function = COMMANDS[command]
    by_command, by_function = tmp_path / "command", tmp_path / "function"
    by_command.mkdir()
    words = [command, *shlex.split(arguments.format(out=by_command))]
    done = called(*words, "--json")
    assert done.returncode == 0, done.stderr
    found = function(arm, by_function)
    files = content(by_command)
    assert files
    assert content(by_function) == files
    assert json.loads(json.dumps(found.to_json())) == json.loads(done.stdout)
    assert len(repr(found)) < 300
    assert "<table>" in found._repr_html_()
    printed = called(*words).stdout
    for part in found.shown():
        if isinstance(part, str):
            assert part in printed


def test_what_a_model_and_the_catalogue_say_is_what_their_commands_say(arm: mg.Arm) -> None:
    for command, found in (("show", mg.build_model(arm)), ("effects", mg.EFFECTS)):
        assert json.loads(called(command, "--json").stdout) == json.loads(json.dumps(found.to_json()))
        assert "<table>" in found._repr_html_()


REFUSED: dict[str, tuple[str, Callable[[mg.Arm], Any]]] = {
    "no description": (
        "show absent.yaml",
        lambda arm: mg.load_arms("absent.yaml"),
    ),
    "no log": (
        "identify --train absent.csv --test c.csv --out x",
        lambda arm: mg.identify(arm, "absent.csv", "c.csv"),
    ),
    "no such column": (
        "calibrate a.csv --joint 1 --out x",
        lambda arm: mg.calibrate(arm, 1, "a.csv"),
    ),
    "no such joint": (
        "calibrate lever.csv --joint 2 --out x",
        lambda arm: mg.calibrate(arm, 2, "lever.csv"),
    ),
    "overlap": (
        "diagnose --train a.csv --train b.csv --test b.csv@2: --out x",
        lambda arm: mg.diagnose(arm, ["a.csv", "b.csv"], "b.csv@2:"),
    ),
    "no test record": (
        "diagnose --train a.csv --train b.csv --out x",
        lambda arm: mg.diagnose(arm, ["a.csv", "b.csv"], []),
    ),
    "no such method": (
        "identify --train a.csv --test b.csv --method best --out x",
        lambda arm: mg.identify(arm, "a.csv", "b.csv", method="best"),
    ),
    "no such effect": (
        "diagnose --train a.csv --test b.csv --effect sprung --out x",
        lambda arm: mg.diagnose(arm, "a.csv", "b.csv", effects=["sprung"]),
    ),
    "outside the stroke": (
        "simulate --q0 '120 deg' --duration 1 --out x.csv",
        lambda arm: mg.simulate(arm, q0="120 deg", duration=1.0),
    ),
    "no such parameter": (
        "refine --log a.csv --free MX9 --out x",
        lambda arm: mg.refine(arm, "a.csv", free=["MX9"]),
    ),
    "no such criterion": (
        "excite --criterion best --out x.csv",
        lambda arm: mg.excite(arm, criterion="best"),
    ),
    "no such target": (
        "generate --target toaster --max-flash 100 --out x",
        lambda arm: mg.generate(arm, "x", generation=mg.GenerationOptions(target="toaster", max_flash=100)),
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_function_refuses_with_the_line_of_its_command(case: str, arm: mg.Arm) -> None:
    arguments, function = REFUSED[case]
    done = called(*shlex.split(arguments))
    assert done.returncode == 2
    with pytest.raises(mg.InputError) as refused:
        function(arm)
    assert done.stderr == " ".join(str(refused.value).split("\n")) + "\n"


def test_logs_in_memory_give_the_answer_of_their_files(arm: mg.Arm) -> None:
    files = mg.identify(arm, ["a.csv", "b.csv"], "c.csv")

    def table(name: str) -> dict[str, np.ndarray]:
        values = np.loadtxt(name, delimiter=",", skiprows=1)
        return dict(zip(("t", "q1", "i1"), values.T, strict=True))

    tables = mg.identify(arm, [table("a.csv"), table("b.csv")], table("c.csv"))
    one, two, three = (mg.read_log(f"{name}.csv", arm) for name in "abc")
    records = mg.identify(arm, [one, two], three)
    assert np.array_equal(np.asarray(tables.parameters), np.asarray(files.parameters))
    assert np.array_equal(np.asarray(records.parameters), np.asarray(files.parameters))
    with pytest.raises(mg.InputError, match=r"^--train train\[1\] and --test test share samples"):
        mg.identify(arm, [table("a.csv"), table("c.csv")], table("c.csv"))
    spoilt = table("b.csv")
    spoilt["i1"][3] = np.nan
    with pytest.raises(mg.InputError, match=r"^train\[1\]: found nan in the column i1 at t = 0.03 s"):
        mg.identify(arm, [table("a.csv"), spoilt], table("c.csv"))
    simulated = mg.simulate(arm, table("a.csv"))
    assert simulated.to_json()["joints"] == mg.simulate(arm, "a.csv").to_json()["joints"]
    refined = mg.refine(arm, mg.read_log("a.csv@0:4", arm), free=["MX1"])
    assert refined.to_json() == mg.refine(arm, "a.csv@0:4", free=["MX1"]).to_json()


def test_a_joint_is_given_by_its_name_or_its_number(arm: mg.Arm, bench: Path, tmp_path: Path) -> None:
    """The same result; a name that no joint has gets the names, and exit status 2."""
    line = ["calibrate", "lever.csv", "--arm", "boom", "--json", "--out", tmp_path / "lever", "--joint"]
    by_number, by_name = (called(*line, joint, cwd=bench) for joint in ("1", "lift"))
    assert (by_name.returncode, by_name.stdout) == (0, by_number.stdout)
    assert mg.calibrate(arm, "lift", "lever.csv").to_json() == json.loads(by_name.stdout)
    logs = ["--arm", "boom", "--train", "a.csv", "--train", "b.csv", "--test", "c.csv", "--no-experiment"]
    asked = ["diagnose", *logs, "--jobs", "1", "--json", "--out", tmp_path / "found", "--effect"]
    answers = [called(*asked, f"spring:{joint}", cwd=bench) for joint in ("1", "lift")]
    assert answers[0].returncode == 0
    assert answers[0].stdout == answers[1].stdout
    for wrong in ("lit", "2", "0"):
        for command in ([*line, wrong], [*asked, f"spring:{wrong}"]):
            done = called(*command, cwd=bench)
            assert done.returncode == 2
            assert f"found joint '{wrong}', expected a joint of boom" in done.stderr
            assert "lift" in done.stderr
