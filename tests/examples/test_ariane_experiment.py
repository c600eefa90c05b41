"""The simulated experiment: its plant against the model, its record through the command line, coverage."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import mujoco
import numpy as np
import pytest
from twin_body import LEVERS, MOTORS, Lever, model
from twin_coverage import coverage
from twin_plant import Recording, reference
from twin_records import ARM, ARMS, HERE, recorded, set_points, truth, write_calibration, write_log
from typer.testing import CliRunner

from modelgen.backends.numpy import NumpyFunction
from modelgen.cli.app import app
from modelgen.description import LeveredDrive, load
from modelgen.functions import build_model

pytestmark = pytest.mark.xdist_group("ariane_experiment")


@pytest.fixture(scope="module")
def points(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A trajectory of 80 s within the limits, of one start."""
    file = tmp_path_factory.mktemp("excite") / "run.csv"
    call = ["excite", str(ARMS), "--arm", ARM, "--rate", "10", "--starts", "1", "--out", str(file)]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 0, result.output
    return file.with_name("run_set_points.csv")


@pytest.fixture(scope="module")
def recording(points: Path) -> Recording:
    return recorded(points, 1)


def test_the_plant_imports_nothing_of_modelgen() -> None:
    for name in ("twin_body", "twin_plant"):
        tree = ast.parse((HERE / f"{name}.py").read_text(encoding="utf-8"))
        nodes = list(ast.walk(tree))
        names = [a.name for n in nodes if isinstance(n, ast.Import) for a in n.names]
        names += [n.module or "" for n in nodes if isinstance(n, ast.ImportFrom)]
        assert names
        assert not [x for x in names if x.startswith("modelgen")]


def test_its_levers_and_their_derivatives_agree_with_finite_differences() -> None:
    for lever, end in zip(LEVERS, (20850, 6810, 26750), strict=True):
        for m in np.linspace(0.02, 0.98, 9) * end:
            q, h = lever.joint(m), 1e-5
            assert lever.motor(q) == pytest.approx(m, abs=1e-6)
            ratio, slope = lever.ratio(q)
            assert ratio == pytest.approx((lever.motor(q + h) - lever.motor(q - h)) / (2 * h), rel=1e-7)
            numeric = (lever.ratio(q + h)[0] - lever.ratio(q - h)[0]) / (2 * h)
            assert slope == pytest.approx(numeric, rel=1e-6, abs=1e-3)


def test_its_equations_are_those_of_the_model_with_the_true_parameters() -> None:
    made = build_model(load(ARMS)[ARM])
    (function,) = [f for f in made.functions if f.name == "inverse_dynamics"]
    theta = np.array(list(truth().values()))
    body = model(1e-3)
    data = mujoco.MjData(body)
    rng = np.random.default_rng(3)
    for _ in range(20):
        m = rng.uniform(0.1, 0.9, 3) * [20850, 6810, 26750]
        q = np.array([lever.joint(x) for lever, x in zip(LEVERS, m, strict=True)])
        dq, ddq = rng.normal(size=3), rng.normal(size=3)
        body.dof_frictionloss[:] = 0
        data.qpos[:], data.qvel[:], data.qacc[:] = q, dq, ddq
        mujoco.mj_inverse(body, data)
        current = []
        for k, (lever, motor) in enumerate(zip(LEVERS, MOTORS, strict=True)):
            ratio, slope = lever.ratio(q[k])
            speed = ratio * dq[k]
            own = motor.inertia * (ratio * ddq[k] + slope * dq[k] ** 2)
            own += motor.viscous * speed + motor.dry * np.sign(speed)
            current.append((data.qfrc_inverse[k] / ratio + own) / motor.constant)
        assert NumpyFunction(function)(q, dq, ddq, theta) == pytest.approx(np.array(current), rel=1e-6)


def test_it_tracks_the_set_points_and_logs_whole_increments(points: Path, recording: Recording) -> None:
    t, wanted = set_points(points)
    assert len(recording.t) == 1600
    assert recording.t[1] == pytest.approx(0.1)
    assert (recording.counts == np.round(recording.counts)).all()
    error = np.abs(recording.counts - np.vstack([wanted[:-1], wanted[:-1]])).max(axis=0)
    assert (error < 0.005 * np.array([20850, 6810, 26750])).all()
    # The regulators' oscillation: in the samples, not in the means.
    scatter = (recording.sample - recording.mean).std(axis=0)
    assert ((scatter > 0.09) & (scatter < 0.14)).all()
    path, begin = reference(t, wanted, 1)
    assert path[0] == pytest.approx(wanted[0])
    assert path[round(begin / 1e-3) :: 100][: len(t)] == pytest.approx(wanted, abs=1.0)


def test_drive_dynamics_explain_the_current_down_to_the_regulators_ripple(
    points: Path, recording: Recording, tmp_path: Path
) -> None:
    test = recorded(points, 2, periods=1)
    write_log(recording, tmp_path / "train.csv", recording.sample)
    write_log(test, tmp_path / "test.csv", test.sample)
    out = tmp_path / "out"
    logs = ["--train", str(tmp_path / "train.csv"), "--test", str(tmp_path / "test.csv")]
    call = ["identify", str(ARMS), "--arm", ARM, *logs, "--mapping", str(HERE / "mapping.yaml")]
    result = CliRunner().invoke(app, [*call, "--preset", "paper", "--compare-drives", "--out", str(out)])
    assert result.exit_code == 0, result.output
    data = json.loads((out / "identification.json").read_text(encoding="utf-8"))
    assert data["processing"][1].startswith("positions: Butterworth, order 3, 0.5 Hz")
    assert (out / "spectra.svg").exists()
    rmse = np.array(data["test"]["rmse"])
    links, gears = data["without_drives"]
    assert links["model"] in result.output
    noise = (test.sample - test.mean).std(axis=0)
    assert (rmse < 1.25 * noise).all()
    assert links["model"] == "links alone"
    assert (np.array(links["rmse"]) > 2 * rmse).all()
    # A constant ratio and friction at the joints, as of geared arms: the levers are what is missing.
    assert gears["model"] == "levers as gears of constant ratio"
    assert (np.array(gears["rmse"])[1:] > 1.1 * rmse[1:]).all()
    page = (out / "report.html").read_text(encoding="utf-8")
    for text in (f"{rmse[0]:.4g}", f"{links['nrmse_percent'][2]:.1f}", gears["model"], data["verdict"][:40]):
        assert text in page


def test_intervals_cover_the_true_parameters(points: Path) -> None:
    # Eight seeds: the standard deviations found scatter by a quarter, their median by far less.
    found = coverage(points, 8, jobs=1)
    assert 0.90 <= found.covered.mean() <= 0.99
    assert 0.8 < np.median(found.ratio) < 1.3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--preset", "papr"], "papr"),
        (["--preset", "paper", "--cutoff", "1"], "--preset paper has its own"),
    ],
)
def test_presets_that_do_not_fit_are_refused(
    recording: Recording, tmp_path: Path, options: list[str], message: str
) -> None:
    write_log(recording, tmp_path / "a.csv", recording.sample)
    logs = ["--train", f"{tmp_path / 'a.csv'}@0:120", "--test", f"{tmp_path / 'a.csv'}@120:"]
    call = ["identify", str(ARMS), "--arm", ARM, *logs]
    call += ["--mapping", str(HERE / "mapping.yaml"), "--out", str(tmp_path / "out")]
    result = CliRunner().invoke(app, [*call, *options])
    assert result.exit_code == 2
    assert message in result.output
    assert not (tmp_path / "out").exists()


def test_the_tutorials_lever_is_found_from_marker_angles(recording: Recording, tmp_path: Path) -> None:
    write_calibration(recording, tmp_path)
    call = ["calibrate", str(tmp_path / "measured_arms.yaml"), str(tmp_path / "marker.csv"), "--arm", ARM]
    result = CliRunner().invoke(app, [*call, "--joint", "3", "--out", str(tmp_path / "out")])
    assert result.exit_code == 0, result.output
    drive = load(tmp_path / "out" / "ariane4_calibrated.yaml")[ARM].joints[2].drive
    assert isinstance(drive, LeveredDrive)
    # The common scale is not seen by angles: the transmission ratio is.
    low, high = (float(x) for x in drive.length)
    found = Lever(float(drive.l1), float(drive.l2), low, (high - low) / 26750, float(drive.offset))
    for m in (3000.0, 13000.0, 24000.0):
        angle = LEVERS[2].joint(m)
        assert found.joint(m) == pytest.approx(angle, abs=0.005)
        assert found.ratio(found.joint(m))[0] == pytest.approx(LEVERS[2].ratio(angle)[0], rel=0.05)
