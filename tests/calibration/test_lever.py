"""Levers found again from motor counts and measured angles."""

import json
import re
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import modelgen as mg
from modelgen.api.results import Table
from modelgen.calibration import Lever, calibrate, calibrated_yaml, lever_of
from modelgen.cli.app import app
from modelgen.dataset import drives_of
from modelgen.description import load, loads
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.report.calibration import charts, stands, verdict
from modelgen.resources import shipped_arms

ARMS = load(shipped_arms(), known_effects())
LEVERED = [
    (name, n)
    for name, arm in ARMS.items()
    for n, i in enumerate(arm.coordinates, 1)
    if type(arm.joints[i].drive).__name__ == "LeveredDrive"
]


def triangle(lever: Lever, motor: np.ndarray) -> np.ndarray:
    """Joint angle by bisection on the law of cosines: another way than the arccosine's."""
    l1, l2, low, high, offset = lever.values
    length = low + (high - low) * (motor - lever.motor[0]) / (lever.motor[1] - lever.motor[0])
    a, b = np.zeros_like(length), np.full_like(length, np.pi)
    for _ in range(60):
        middle = (a + b) / 2
        short = np.hypot(l1 - l2 * np.cos(middle), l2 * np.sin(middle)) < length
        a, b = np.where(short, middle, a), np.where(short, b, middle)
    found: np.ndarray = lever.rev * (a + b) / 2 + offset
    return found


def experiment(lever: Lever, noise: float, seed: int, count: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Motor counts over the stroke and the angles of a marker with white noise [rad]."""
    rng = np.random.default_rng(seed)
    share = 0.5 - 0.5 * np.cos(np.linspace(0, 6 * np.pi, count))
    motor = np.round(lever.motor[0] + (lever.motor[1] - lever.motor[0]) * share)
    return motor, triangle(lever, motor) + noise * rng.standard_normal(count)


def wrong(lever: Lever, seed: int) -> Lever:
    """As measured by hand: every length 5 to 10 mm off, small ones less."""
    rng = np.random.default_rng(seed)
    error = rng.uniform(0.005, 0.010, 4) * rng.choice([-1.0, 1.0], 4)
    return Lever(lever.rev, lever.motor, lever.values + np.append(error, 0.0))


@pytest.mark.parametrize(("name", "joint"), LEVERED)
def test_angle_and_derivatives(name: str, joint: int) -> None:
    lever = lever_of(ARMS[name], joint)
    motor = np.linspace(*lever.motor, 25)
    inside = motor[1:-1]
    assert np.allclose(lever.angle(inside), triangle(lever, inside), atol=1e-9)
    assert np.allclose(lever.angle(inside), drives_of(ARMS[name])[joint - 1].joint(inside), atol=1e-12)
    for k, column in enumerate(lever.jacobian(inside).T):
        step = np.zeros(5)
        step[k] = 1e-6
        ends = [Lever(lever.rev, lever.motor, lever.values + s * step).angle(inside) for s in (1.0, -1.0)]
        assert np.allclose(column, (ends[0] - ends[1]) / 2e-6, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("joint", [1, 2, 3])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_residual_reaches_the_noise_floor(joint: int, seed: int) -> None:
    true = lever_of(ARMS["ariane4"], joint)
    noise = 0.02
    motor, measured = experiment(true, noise, seed)
    found = calibrate(wrong(true, seed), joint, motor, measured, 0.008)
    count = len(motor)
    assert found.after.rev == true.rev
    # chi-square of N - 4 degrees of freedom, four standard deviations wide
    assert abs(found.rms_after / noise - 1) < 4 / np.sqrt(2 * count) + 4 / count
    assert np.sqrt(np.mean((found.after.angle(motor) - triangle(true, motor)) ** 2)) < noise / 5
    assert found.rms_before > found.rms_after


def test_the_common_scale_is_named_and_left_as_measured() -> None:
    true = lever_of(ARMS["ariane4"], 1)
    motor, measured = experiment(true, 1e-4, 1)
    found = calibrate(true, 1, motor, measured, 0.005)
    assert any(words.startswith("the common scale of l1, l2, qp_min and qp_max") for words in found.weak)
    larger = Lever(true.rev, true.motor, true.values * np.array([1.1, 1.1, 1.1, 1.1, 1.0]))
    assert np.allclose(larger.angle(motor), true.angle(motor), atol=1e-9)
    l1 = next(e for e in found.estimates if e.name == "l1")
    # of the scale as much is known as four lengths with one error each can say
    assert l1.std == pytest.approx(0.005 * true.values[0] / np.linalg.norm(true.values[:4]), rel=0.1)


def test_uncertainty_covers_the_truth() -> None:
    """The prior's errors and the noise drawn anew: normalised errors have unit size."""
    true = lever_of(ARMS["ariane4"], 3)
    scores = []
    for seed in range(60):
        rng = np.random.default_rng(1000 + seed)
        prior = Lever(true.rev, true.motor, true.values + np.append(0.004 * rng.standard_normal(4), 0.3))
        motor, measured = experiment(true, 0.01, seed, 400)
        found = calibrate(prior, 3, motor, measured, 0.004)
        scores.append([(e.value - t) / e.std for e, t in zip(found.estimates, true.values, strict=True)])
    table = np.abs(np.array(scores))
    assert 0.88 <= (table < 1.96).mean() <= 0.99


def test_a_lever_agrees_by_all_its_values_together() -> None:
    """One length 4 mm off, which no value alone shows beside lengths known to 5 mm; and of ten levers as
    described, none does not agree.
    """
    true = lever_of(ARMS["ariane4"], 1)
    motor, measured = experiment(true, 0.002, 3, 500)
    wrong = Lever(true.rev, true.motor, true.values + np.array([0.004, 0.0, 0.0, 0.0, 0.0]))
    found = calibrate(wrong, 1, motor, measured, 0.005)
    assert all(abs(e.value - e.before) < 2.0 * e.std for e in found.estimates)
    assert not found.agrees
    assert not stands(found)
    assert "together they are not those described" in verdict(found)
    for seed in range(10):
        assert calibrate(true, 1, *experiment(true, 0.002, 20 + seed, 500), 0.005).agrees


def test_the_other_branch_is_found() -> None:
    true = lever_of(ARMS["ariane4"], 2)
    motor, measured = experiment(true, 0.005, 4)
    mirrored = Lever(-true.rev, true.motor, true.values)
    assert calibrate(mirrored, 2, motor, measured, 0.01).after.rev == true.rev


def test_angles_have_one_unit_and_what_an_offset_alone_explains_is_said() -> None:
    """The page and the terminal in degrees, an offset that is wrong by 6 deg beside noise of 0.2 deg."""
    arm = mg.load_arms()["ariane4"]
    motor = np.linspace(0.0, 20_000.0, 300)
    noise = np.radians(0.2) * np.random.default_rng(1).standard_normal(300)
    angle = lever_of(arm, 3).angle(motor) + np.radians(6.0) + noise
    found = mg.calibrate(arm, 3, {"t": 0.05 * np.arange(300), "qm3": motor, "q3": angle})
    page = unescape(found.files()["report.html"])
    shown = found.shown()
    lines = [part for part in shown if isinstance(part, str)]
    (alone,) = [line for line in lines if line.startswith("A constant offset of the angle alone")]
    (left,) = re.findall(r"leaves (0\.\d+) deg\.", alone)
    assert float(left) == pytest.approx(0.2, rel=0.15)
    assert alone in page
    assert re.search(r"RMSE of the angle 5\.98 -> 0\.\d+ deg", lines[0])
    (table,) = [part for part in shown if isinstance(part, Table)]
    assert [row[-1] for row in table.rows] == ["mm", "mm", "mm", "mm", "deg"]
    assert " rad" not in " ".join(re.sub("<[^>]*>", " ", page).split())
    assert "qp_min and qp_max its lengths" in page
    assert all(curve.dots for curve in charts(arm, found.found)[1].curves)


def test_command_writes_a_description_that_loads(tmp_path: Path) -> None:
    true = lever_of(ARMS["ariane4"], 1)
    bent = Lever(1, true.motor, true.values + np.array([0.004, -0.001, 0.005, -0.002, 0.05]))
    motor, measured = experiment(bent, 0.01, 5)
    log = tmp_path / "log.csv"
    table = np.column_stack([0.1 * np.arange(len(motor)), motor, measured])
    np.savetxt(log, table, delimiter=",", header="t,qm1,q1", comments="", fmt="%.9g")
    out = tmp_path / "out"
    line = ["calibrate", str(shipped_arms()), str(log), "--arm", "ariane4", "--joint", "1", "--out", str(out)]
    answer = CliRunner().invoke(app, [*line, "--json"])
    assert answer.exit_code == 0, answer.output
    found = json.loads((out / "calibration.json").read_text())
    assert found["rmse"]["after"] < 0.0105 < found["rmse"]["before"]
    arm = load(out / "ariane4_calibrated.yaml", known_effects())["ariane4"]
    assert np.allclose(lever_of(arm, 1).angle(motor), triangle(bent, motor), atol=0.004)
    first = {p.name: p.read_bytes() for p in out.iterdir()}
    assert CliRunner().invoke(app, line).exit_code == 0
    assert first == {p.name: p.read_bytes() for p in out.iterdir()}


def test_a_comment_on_a_value_that_is_another_one_now_goes_with_it() -> None:
    """And those on lines of their own, and beside what stays, are kept."""
    text = shipped_arms().read_text(encoding="utf-8")
    first = text.index("l1:", text.index("ariane4:"))
    end = text.index("\n", first)
    said = "# measured on the drawing\n          # of the motor's side"
    whole = f"{text[:end]} {said}{text[end:]}"
    described = loads(whole, known_effects=known_effects())["ariane4"]
    true = lever_of(described, 1)
    same = calibrated_yaml(described, 1, true)
    assert "# measured on the drawing" in same
    moved = calibrated_yaml(described, 1, Lever(1, true.motor, true.values + 0.001))
    assert "# measured on the drawing" not in moved
    assert "# of the motor's side" in moved
    assert "# assumed" in moved  # rev stays as it is


def test_refusals(tmp_path: Path) -> None:
    lever = lever_of(ARMS["ariane4"], 1)
    motor, measured = experiment(lever, 0.01, 1)
    for bad, text in (
        ((motor[:10], measured[:10]), "10 samples"),
        ((motor * 3, measured), "another joint"),
        ((np.full_like(motor, 100.0), measured), "of the stroke"),
        ((motor, np.degrees(measured)), "not degrees"),
        ((motor, np.where(motor == motor[5], np.nan, measured)), "not finite"),
    ):
        with pytest.raises(InputError, match=text):
            calibrate(lever, 1, bad[0], bad[1], 0.01)
    with pytest.raises(InputError, match="expected 1 to 3"):
        lever_of(ARMS["ariane4"], 4)
    with pytest.raises(InputError, match="no lever"):
        lever_of(ARMS["rx90"], 1)
    log = tmp_path / "log.csv"
    log.write_text("t,qm1\n0,0\n")
    line = ["calibrate", str(shipped_arms()), str(log), "--arm", "ariane4", "--joint", "1"]
    answer = CliRunner().invoke(app, [*line, "--out", str(tmp_path / "no")])
    assert answer.exit_code == 2
    assert not (tmp_path / "no").exists()


@pytest.mark.parametrize("joint", [1, 2, 3])
def test_what_is_uncertain_in_angle_and_effort_is_how_far_these_scatter(joint: int) -> None:
    """Over records with other noise: angles, and the slopes to which the effort per current is inverse."""
    true = lever_of(ARMS["ariane4"], joint)
    start = wrong(true, 1)
    fits = [calibrate(start, joint, *experiment(true, 0.02, seed, 400), 0.008) for seed in range(40)]
    motor = fits[0].motor
    step = 1e-3 * (true.motor[1] - true.motor[0])
    inner = np.clip(motor, *(np.sort(true.motor) + abs(step) * np.array([1.0, -1.0])))
    angles = np.array([triangle(f.after, motor) for f in fits])
    efforts = np.array(
        [2.0 * step / (triangle(f.after, inner + step) - triangle(f.after, inner - step)) for f in fits]
    )
    rms = lambda x: float(np.sqrt(np.mean(x**2)))  # noqa: E731
    for seen, said in (
        (np.std(angles, axis=0), fits[0].angle_std),
        (np.std(efforts, axis=0) / np.abs(np.mean(efforts, axis=0)), fits[0].effort_std),
    ):
        assert rms(seen) == pytest.approx(rms(said), rel=0.35)  # of 40 records: 11 % by chance
