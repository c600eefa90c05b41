"""identify and diagnose say what their logs are like: what was put into the logs stands in both."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import modelgen as mg

ARMS = """
schema: 1
convention: khalil_kleinfinger
arms:
  axis:
    gravity: [0, 0, -9.81]
    joints:
      - {name: swing, alpha: pi/2, d: 0, r: 0, drive: {type: direct, ratio: 1, torque_constant: 1}}
"""
LINES, PERIOD, RATE = 1024, 4.0, 200.0
STEP = 2 * np.pi / LINES


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> mg.Arm:
    path = tmp_path_factory.mktemp("arm") / "arms.yaml"
    path.write_text(ARMS, encoding="utf-8")
    return mg.load_arms(path)["axis"]


def log(seconds: float, seed: int, every: int = 1) -> dict[str, np.ndarray]:
    """A pendulum that repeats every 4 s, at 200 Hz, with an encoder of 1024 lines; readings stand there
    `every` times.
    """
    t = np.arange(int(seconds * RATE)) / RATE
    w = 2 * np.pi / PERIOD * np.arange(1, 4)
    phase = np.array([0.3, 1.1, 2.5])
    q = np.sin(np.outer(t, w) + phase) @ (0.5 / np.arange(1, 4))
    dq = np.cos(np.outer(t, w) + phase) @ (0.5 / np.arange(1, 4) * w)
    ddq = -np.sin(np.outer(t, w) + phase) @ (0.5 / np.arange(1, 4) * w**2)
    effort = 0.3 * ddq + 4.0 * np.cos(q) + 0.2 * dq + 0.1 * np.sign(dq)
    effort += 0.02 * np.random.default_rng(seed).normal(size=len(t))
    rows = np.arange(len(t)) // every * every
    return {"t": t, "q1": STEP * np.round(q / STEP)[rows], "i1": effort[rows]}


@pytest.fixture(scope="module")
def results(arm: mg.Arm) -> list[Any]:
    """An identification and a diagnosis of the same records."""
    train, test = [log(16.0, 1), log(16.0, 2)], log(8.0, 3)
    asked = mg.diagnose(arm, train, test, experiment=False, effects=["friction_offset:1"])
    return [mg.identify(arm, train, test), asked]


@pytest.mark.parametrize("which", [0, 1])
def test_the_log_is_as_it_was_made(which: int, results: list[Any]) -> None:
    found = results[which].to_json()["log"]
    assert found["rate"] == pytest.approx(RATE)
    assert found["period_s"] == pytest.approx(PERIOD, abs=1 / RATE)
    assert found["resolution"]["q1"] == pytest.approx(STEP, rel=1e-6)
    assert found["repeated_readings"] == 1.0
    assert found["jitter"] == 0.0
    assert found["hold"] == "following"
    assert found["samples"] == 2 * 16 * RATE
    assert 0 < found["samples_left_out"][0] < 0.4 * found["samples"]
    assert [r["use"] for r in found["records"]] == ["train", "train", "test"]
    assert [r["samples"] for r in found["records"]] == [3200, 3200, 1600]


def test_both_say_the_same_in_six_lines_at_most(results: list[Any]) -> None:
    said = [[x for x in r.shown() if isinstance(x, str) and x.startswith("log: ")] for r in results]
    for lines in said:
        assert 1 <= len(lines) <= 6
        assert any(f"q1 in steps of {STEP:.3g} rad" in line for line in lines)
        assert any("period 4 s" in line and "200 Hz" in line for line in lines)
    assert said[0][:2] == said[1][:2]


def test_readings_that_repeat_are_said_with_the_true_rate(arm: mg.Arm) -> None:
    data = mg.identify(arm, log(16.0, 1, every=4), log(8.0, 2, every=4)).to_json()["log"]
    assert data["repeated_readings"] == pytest.approx(4.0)
    assert data["rate"] == pytest.approx(RATE / 4)
    assert data["hold"] == "instant"
    assert any("every reading stands there 4 times" in remark for remark in data["remarks"])


def test_the_log_of_a_stream_is_that_of_the_whole(arm: mg.Arm, tmp_path: Path) -> None:
    paths = []
    for k, seconds in enumerate((24.0, 8.0)):
        table = log(seconds, k)
        paths.append(tmp_path / f"{k}.csv")
        rows = np.column_stack(list(table.values()))
        np.savetxt(paths[-1], rows, delimiter=",", header=",".join(table), comments="")
    whole, streamed = (mg.identify(arm, *map(str, paths), stream=s).to_json()["log"] for s in (False, True))
    for key in ("rate", "samples", "hold", "repeated_readings"):
        assert streamed[key] == pytest.approx(whole[key]) if key != "hold" else streamed[key] == whole[key]
    assert streamed["resolution"]["q1"] == pytest.approx(whole["resolution"]["q1"], rel=1e-6)


def test_the_two_errors_are_one_in_the_same_band(arm: mg.Arm, results: list[Any]) -> None:
    diagnosed = results[1].to_json()
    cutoff = diagnosed["settings"]["cutoff_hz"]
    train, test = [log(16.0, 1), log(16.0, 2)], log(8.0, 3)
    same = mg.identify(arm, train, test, cutoff=cutoff).to_json()
    assert diagnosed["error"]["with_rest"] == pytest.approx(same["test"]["rmse"], rel=1e-5)
    said = [x for x in results[1].shown() if isinstance(x, str) and "identify --cutoff" in x]
    assert len(said) == 1
    assert f"{cutoff:.4g} Hz" in said[0]
    assert f"--cutoff {cutoff:g}" in said[0]


def test_what_is_written_can_be_simulated_and_generated_at_once(results: list[Any], tmp_path: Path) -> None:
    results[1].write(tmp_path, code=False)
    extended = mg.load_arms(tmp_path / "axis_extended.yaml")["axis"]
    motion = mg.simulate(extended, q0=0.3, duration=0.5)
    assert "axis_parameters.yaml beside the description" in str(motion.shown()[0])
    values = (tmp_path / "axis_parameters.yaml").read_text(encoding="utf-8")
    assert all(f"{e.value:.6g}"[:6] in values for e in results[1].parameters.values())
    # The same motion as with the values given by name: a swing that gravity drives and friction slows.
    named = mg.simulate(extended, q0=0.3, duration=0.5, parameters=results[1].parameters)
    assert motion.q == pytest.approx(named.q, rel=1e-9)  # the file has twelve digits
    assert motion.q[-1, 0] < 0.3 - 0.05
    mg.generate([extended], tmp_path / "generated")
    assert "identified" in (tmp_path / "generated" / "axis" / "include" / "axis.h").read_text(
        encoding="utf-8"
    )
