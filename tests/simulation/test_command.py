"""modelgen simulate as a user runs it: files, scores, controllers, one clear line for bad input."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS
from simulation_support import middle, pendulum
from typer.testing import CliRunner

from modelgen.cli.app import app
from modelgen.dataset import prepare, read
from modelgen.simulation import Reference, cascade, computed_torque, plant, replay, scores, simulate
from modelgen.simulation.metrics import repeated

RUNNER = CliRunner()


def call(*words: str) -> tuple[int, str, str]:
    done = RUNNER.invoke(app, ["simulate", *words])
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done.exit_code, done.stdout, done.stderr


FREE = ("--arm", "gravity_link1", "--q0", "20 deg", "--dq0", "0", "--duration", "16.315", "--rate", "1000")


@pytest.fixture(scope="module")
def swing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A free swing, written by the command."""
    folder = tmp_path_factory.mktemp("swing")
    code, out, _ = call(
        *FREE,
        "--out",
        str(folder / "sim.csv"),
        "--plot",
        str(folder / "sim.svg"),
        "--animation",
        str(folder / "sim.html"),
    )
    assert code == 0
    assert "at rest from 7.397 s on" in out
    return folder


def test_the_files_of_a_free_motion(swing: Path) -> None:
    lines = (swing / "sim.csv").read_text().splitlines()
    assert lines[0] == "t,q1,dq1"
    assert len(lines) == 16317
    t, q, dq = (float(x) for x in lines[1].split(","))
    assert (t, dq) == (0.0, 0.0)
    assert abs(q - np.deg2rad(20)) < 1e-11
    assert float(lines[-1].split(",")[2]) == 0.0
    assert (swing / "sim.svg").read_text().startswith("<?xml")
    page = (swing / "sim.html").read_text()
    assert "://" not in page.replace("http://www.w3.org/2000/svg", "")  # nothing is fetched


def test_a_log_of_the_same_motion_fits(swing: Path) -> None:
    code, out, _ = call("--arm", "gravity_link1", "--log", str(swing / "sim.csv"), "--json")
    assert code == 0
    (joint,) = json.loads(out)["joints"]
    assert joint["f_gof_percent"] > 99.9
    code, out, _ = call("--arm", "gravity_link1_loaded", "--log", str(swing / "sim.csv"), "--json")
    (other,) = json.loads(out)["joints"]
    assert other["f_gof_percent"] < 50  # another arm does not
    code, out, _ = call(
        "--arm", "gravity_link1_loaded", "--log", str(swing / "sim.csv"), "--window", "0.5", "--json"
    )
    windowed = json.loads(out)
    assert windowed["windows"] == 33
    assert windowed["joints"][0]["rmse"] < other["rmse"] / 3


def test_repeated_runs_are_averaged(swing: Path) -> None:
    """Noise of known size: it is the scatter, and the mean of the runs fits better than any of them."""
    data = np.loadtxt(swing / "sim.csv", delimiter=",", skiprows=1)[::10]
    rng = np.random.default_rng(4)
    words = []
    for k in range(4):
        noisy = np.column_stack([data[:, 0], data[:, 1] + 0.003 * rng.normal(size=len(data))])
        path = swing / f"run_{k}.csv"
        np.savetxt(path, noisy, delimiter=",", header="t,q1", comments="")
        words += ["--log", str(path)]
    code, out, _ = call("--arm", "gravity_link1", *words, "--q0", "20 deg", "--json")
    assert code == 0
    found = json.loads(out)
    assert len(found["runs"]) == 4
    # The processing's low-pass takes a part of white noise away.
    assert 0.0002 < found["joints"][0]["scatter"] < 0.003
    assert found["joints"][0]["rmse"] < min(run["joints"][0]["rmse"] for run in found["runs"])
    code, out, _ = call("--arm", "gravity_link1", *words, "--q0", "20 deg")
    assert "mean of all" in out
    assert "scatter" in out


def test_given_inputs_move_the_arm_as_a_function_does(tmp_path: Path) -> None:
    """Held between their samples; here against the same efforts through Python."""
    path = tmp_path / "efforts.csv"
    t = np.arange(101) / 50
    tau = np.column_stack([8 * np.sin(3 * t), 2 * np.cos(5 * t)])
    np.savetxt(path, np.column_stack([t, tau]), delimiter=",", header="t,tau1,tau2", comments="")
    out = tmp_path / "sim.csv"
    code, _, _ = call("--arm", "gravity_arm", "--input", str(path), "--rate", "500", "--out", str(out))
    assert code == 0
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    assert table[-1, 0] == 2.0

    def efforts(now: float, q: np.ndarray, dq: np.ndarray) -> np.ndarray:
        return tau[int(now * 50 + 1e-6)]

    made = plant(ARMS["gravity_arm"])
    found = simulate(made, 0.0, 0.0, 2.0, 500.0, efforts)
    np.testing.assert_allclose(table[:, 1:3], found.q, rtol=0, atol=1e-9)


def test_scores_by_their_definitions() -> None:
    y = np.array([[0.0], [1.0], [2.0], [3.0]])
    found = scores(y, y + np.array([[0.1], [-0.1], [0.1], [-0.1]]))
    assert found.f_gof[0] == pytest.approx(100 * (1 - 0.2 / np.sqrt(5.0)))
    assert found.mae[0] == pytest.approx(0.1)
    assert found.rmse[0] == pytest.approx(0.1)
    assert np.isnan(scores(np.ones((4, 1)), y).f_gof[0])
    # what runs away so far that its square is none: no score, and no warning
    away = scores(y, y + 1e200)
    assert np.isnan(away.f_gof[0])
    assert np.isinf(away.rmse[0])


def test_repeated_runs_give_the_noise_floor() -> None:
    rng = np.random.default_rng(0)
    truth = np.sin(np.arange(400) / 20)[:, None]
    runs = [truth + 0.01 * rng.normal(size=truth.shape) for _ in range(10)]
    mean, scatter = repeated(runs)
    assert scatter[0] == pytest.approx(0.01, rel=0.05)
    assert np.abs(mean - truth).std() < 0.005
    with pytest.raises(ValueError, match="two at least"):
        repeated(runs[:1])


def smooth(begin: np.ndarray, size: float, duration: float = 4.0) -> Reference:
    t = np.arange(round(duration * 100) + 1) / 100
    return Reference(t, begin + size * (1 - np.cos(2 * np.pi * t / duration))[:, None] / 2)


@pytest.mark.parametrize("name", ["ariane4"])
def test_controllers_follow_on_a_levered_arm(name: str) -> None:
    made = plant(ARMS[name])
    reference = smooth(middle(made), 0.2)
    errors = {}
    for kind, control in (
        ("pi", cascade(made, reference, 10.0, 1000.0)),
        ("computed_torque", computed_torque(made, reference, 5.0)),
    ):
        found = simulate(made, reference.q[0], 0.0, 4.0, 1000.0, control, stop_at_limits=True)
        assert not found.ended
        expected = np.array([reference.at(t)[0] for t in found.t])
        errors[kind] = np.abs(found.q - expected).max()
    assert errors["pi"] < 0.02
    assert errors["computed_torque"] < 0.005


def test_any_callable_controls() -> None:
    made = plant(pendulum())

    def hold(t: float, q: np.ndarray, dq: np.ndarray) -> np.ndarray:
        return 2.0 * 9.81 * 0.4 * np.sin(q) - 20 * (q - 0.5) - 5 * dq

    found = simulate(made, 0.0, 0.0, 6.0, 500.0, hold)
    assert abs(found.q[-1, 0] - 0.5) < 1e-3


def test_closed_loop_replay_follows_the_log(tmp_path: Path) -> None:
    made = plant(ARMS["ariane4"])
    reference = smooth(middle(made), 0.2)
    found = simulate(
        made, reference.q[0], 0.0, 4.0, 1000.0, computed_torque(made, reference, 5.0), stop_at_limits=True
    )
    table = np.column_stack([found.t, found.q, found.input])
    path = tmp_path / "log.csv"
    np.savetxt(path, table, delimiter=",", header="t,q1,q2,q3,i1,i2,i3", comments="")
    prepared = prepare(read(str(path), made.arm))
    # The inputs alone: the same motion, as far as a filtered beginning lets it.
    alone = replay(made, prepared, window=0.5)
    closed = replay(made, prepared, control="computed_torque")
    assert alone.windows == 8
    assert alone.scores.rmse.max() < 2e-3
    assert closed.scores.rmse.max() < 5e-3
    assert (closed.scores.f_gof > 90).all()


def test_an_unstable_loop_is_reported_and_what_ran_is_kept(tmp_path: Path) -> None:
    reference = tmp_path / "reference.csv"
    t = np.arange(201) / 100
    begin = middle(plant(ARMS["ariane4"]))
    np.savetxt(
        reference,
        np.column_stack([t, begin + 0.3 * np.sin(40 * t)[:, None]]),
        delimiter=",",
        header="t,q1,q2,q3",
        comments="",
    )
    code, _, error = call(
        "--arm",
        "ariane4",
        "--control",
        "pi",
        "--reference",
        str(reference),
        "--bandwidth",
        "2000",
        "--rate",
        "200",
        "--out",
        str(tmp_path / "sim.csv"),
    )
    assert code == 2
    assert len(error.strip().splitlines()) == 1
    assert "left its" in error or "not finite" in error
    assert " s" in error
    kept = (tmp_path / "sim.csv").read_text().splitlines()
    assert 1 < len(kept) < 402


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--arm", "ariane4", "--q0", "3", "--duration", "1"), "outside its stroke"),
        (("--arm", "gravity_link1"), "--duration"),
        (("--arm", "gravity_link1", "--duration", "-1"), "more than 0"),
        (("--arm", "gravity_link1", "--duration", "nan"), "more than 0"),
        (("--arm", "gravity_link1", "--duration", "1", "--rate", "1e12"), "samples"),
        (("--arm", "gravity_link1", "--duration", "1", "--q0", "twenty"), "--q0"),
        (("--arm", "gravity_link1", "--duration", "1", "--q0", "1,2"), "expected 1 or 1"),
        (("--arm", "gravity_arm", "--duration", "1", "--lock", "j9=0"), "no such joint"),
        (("--arm", "gravity_arm", "--duration", "1", "--lock", "j2"), "JOINT=COORDINATE"),
        (("--arm", "gravity_arm", "--duration", "1", "--payload", "1,2"), "MASS,X,Y,Z"),
        (("--arm", "gravity_arm", "--duration", "1", "--payload", "-1"), "0 or more"),
        (("--arm", "gravity_arm", "--duration", "1", "--step", "0"), "--step"),
        (("--arm", "gravity_arm", "--duration", "1", "--method", "euler"), "cvodes"),
        (("--arm", "gravity_arm", "--duration", "1", "--window", "1"), "--log"),
        (("--arm", "gravity_arm", "--duration", "1", "--control", "pi"), "--reference"),
        (("--arm", "wam7", "--duration", "1"), "nominal value"),
    ],
)
def test_bad_input_gets_one_line(words: tuple[str, ...], message: str, tmp_path: Path) -> None:
    out = tmp_path / "sim.csv"
    code, printed, error = call(*words, "--out", str(out))
    assert code == 2
    assert printed == ""
    assert len(error.strip().splitlines()) == 1
    assert message in error
    assert not out.exists()


def test_a_log_without_the_effort_that_a_driven_arm_needs(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    t = np.arange(400) / 100
    q = middle(plant(ARMS["ariane4"])) + 0.1 * np.sin(t)[:, None]
    np.savetxt(path, np.column_stack([t, q]), delimiter=",", header="t,q1,q2,q3", comments="")
    code, _, error = call("--arm", "ariane4", "--log", str(path))
    assert code == 2
    assert "expected i<n> or tau<n>" in error
    assert len(error.strip().splitlines()) == 1


@pytest.mark.parametrize("duration", ["nan", "inf", "1e12"])
def test_given_inputs_of_no_length_get_one_line(duration: str, tmp_path: Path) -> None:
    table = tmp_path / "in.csv"
    table.write_text("t,i1\n0,0.1\n0.1,0.2\n0.2,0.1\n0.3,0\n")
    code, _, error = call("--arm", "screw_axis", "--input", str(table), "--duration", duration)
    assert code == 2
    assert len(error.strip().splitlines()) == 1
    assert "--duration" in error
