"""What is said of a log is what was put into it."""

from __future__ import annotations

import gzip
import math
from pathlib import Path

import numpy as np
import pytest

import modelgen as mg
from modelgen.api.inspect import mapping_skeleton

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  mixed:
    joints:
      - {name: a, alpha: 0, d: 0, r: 0, drive: {type: direct, ratio: 100, torque_constant: 0.05}}
      - {name: b, type: prismatic, alpha: 0, d: 0.3, r: 0, drive: {type: none}}
"""
STEP = 2 * math.pi / 4096


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> mg.Arm:
    path = tmp_path_factory.mktemp("arm") / "arms.yaml"
    path.write_text(ARM, encoding="utf-8")
    return mg.load_arms(path)["mixed"]


@pytest.fixture(scope="module")
def log() -> dict[str, np.ndarray]:
    """200 Hz, a period of 2 s, an encoder of 4096 lines, a current renewed every fourth sample."""
    t = np.arange(1600) / 200
    q = np.sin(np.pi * t) + 0.3 * np.sin(3 * np.pi * t)
    current = np.repeat(np.cos(np.pi * t[::4]), 4)
    return {
        "t": t,
        "q1": STEP * np.round(q / STEP),
        "q2": 0.1 * np.cos(np.pi * t),
        "i1": current,
        "tau2": np.random.default_rng(1).normal(size=len(t)),
    }


@pytest.mark.parametrize("with_arm", [False, True])
def test_what_was_put_into_a_log_is_found(with_arm: bool, arm: mg.Arm, log: dict[str, np.ndarray]) -> None:
    found = mg.inspect_log(log, arm if with_arm else None)
    assert found.samples == 1600
    assert found.rate == pytest.approx(200)
    assert found.jitter < 1e-9
    assert found.period == pytest.approx(2.0, abs=0.006)
    by_name = {c.name: c for c in found.channels}
    assert list(by_name) == ["q1", "q2", "i1", "tau2"]
    assert by_name["q1"].resolution == pytest.approx(STEP, rel=1e-9)
    assert by_name["tau2"].resolution is None
    # For an arm each reading of the current counts once, at the rows at which it is new, which is said.
    rows = slice(None, None, 4 if with_arm else 1)
    assert by_name["i1"].repeated == pytest.approx(0.0 if with_arm else 0.75, abs=0.01)
    assert any(said.startswith("i1 stands there 4 times") for said in found.to_json()["remarks"])
    assert by_name["tau2"].repeated == 0.0
    assert (by_name["q2"].low, by_name["q2"].high) == (log["q2"][rows].min(), log["q2"][rows].max())
    units = {"q1": "rad", "q2": "m", "i1": "A", "tau2": "N"}
    assert all(c.unit == (units[c.name] if with_arm else "") for c in found.channels)
    assert "1600 samples" in repr(found)
    assert "evenly sampled" in repr(found)
    assert len(repr(found)) < 200
    assert "<table>" in found._repr_html_()


def test_time_that_jitters_and_runs_backwards_is_said(log: dict[str, np.ndarray]) -> None:
    t = log["t"].copy()
    t[100] += 0.002
    t[500] = t[498]
    found = mg.inspect_log({"t": t, "q1": log["q1"]})
    assert found.to_json()["backwards"] == 1
    assert "varies by up to 2 sampling periods" in repr(found)
    assert found.jitter == pytest.approx(2.0)  # from 498 to 500 and on to 501
    found = mg.inspect_log({"t": np.delete(log["t"], [100, 101]), "q1": np.delete(log["q1"], [100, 101])})
    assert found.jitter == pytest.approx(2.0)


def test_a_file_is_said_to_hold_what_its_table_holds(tmp_path: Path, log: dict[str, np.ndarray]) -> None:
    path = tmp_path / "log.csv"
    rows = [",".join([*log, "mode"])]
    table = np.stack(list(log.values()), axis=1)
    rows += [",".join([*(repr(float(x)) for x in row), "auto"]) for row in table]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    of_file, of_table = mg.inspect_log(path).to_json(), mg.inspect_log(log).to_json()
    assert of_file.pop("without_numbers") == ["mode"]
    assert of_table.pop("without_numbers") == []
    assert of_file.pop("log") == str(path)
    assert of_table.pop("log") == "log"
    assert of_file == of_table
    assert mg.inspect_log(f"{path}@2:4").samples == 400


def test_a_log_without_time_and_one_that_is_missing(tmp_path: Path, arm: mg.Arm) -> None:
    found = mg.inspect_log({"q1": [1.0, 2.0, 4.0]})
    assert found.to_json()["rate_hz"] is None
    assert found.channels[0].high == 4.0
    with pytest.raises(mg.InputError, match="there is no such log"):
        mg.inspect_log(tmp_path / "absent.csv")


def test_a_mapping_is_enough_to_look_at_a_log(tmp_path: Path, log: dict[str, np.ndarray]) -> None:
    mapping = tmp_path / "m.yaml"
    joints = (
        "{position: {column: q1, unit: deg, side: motor}, effort: {column: i1, unit: mA}}",
        "{position: {column: q2, unit: mm}, effort: {column: tau2, unit: kN}}",
    )
    mapping.write_text(f"schema: 1\nhold: instant\njoints: [{', '.join(joints)}]\n", encoding="utf-8")
    found = mg.inspect_log(log, mapping=mapping)
    by_name = {c.name: c for c in found.channels}
    assert {name: c.unit for name, c in by_name.items()} == {"q1": "rad", "q2": "m", "i1": "A", "tau2": "N"}
    assert by_name["q1"].high == pytest.approx(math.radians(log["q1"].max()))
    assert by_name["q2"].high == pytest.approx(1e-3 * log["q2"].max())
    assert by_name["i1"].high == pytest.approx(1e-3 * log["i1"].max())
    assert by_name["tau2"].high == pytest.approx(1e3 * log["tau2"].max())
    assert found.to_json()["effort_instant"] is None  # for which a model is needed


@pytest.mark.parametrize("position", ["unit: counts, side: motor", "unit: mm, side: motor"])
def test_what_a_drive_alone_gives_a_meaning_needs_the_arm(position: str, tmp_path: Path) -> None:
    mapping = tmp_path / "m.yaml"
    mapping.write_text(
        f"schema: 1\njoints:\n  - {{position: {{column: q1, {position}}}}}\n", encoding="utf-8"
    )
    with pytest.raises(mg.InputError, match=r"m\.yaml:3:.*expected an arm too: modelgen inspect LOG ARMS"):
        mg.inspect_log({"t": [0.0, 1.0], "q1": [1.0, 2.0]}, mapping=mapping)


def test_a_skeleton_of_what_was_inspected_is_that_of_the_log(log: dict[str, np.ndarray]) -> None:
    for table in (log, {"header.stamp": 1e9 * log["t"]} | {k: x for k, x in log.items() if k != "t"}):
        assert mapping_skeleton(mg.inspect_log(table)) == mapping_skeleton(table)


def test_the_columns_of_a_record_are_a_log(arm: mg.Arm, log: dict[str, np.ndarray]) -> None:
    log = log | {"i1": np.cos(np.pi * log["t"])}  # new in every row
    record = mg.read_log(log, arm)
    assert record.units == {"t": "s", "q1": "rad", "q2": "m", "i1": "A", "tau2": "N"}
    again = mg.read_log(record.columns, arm)
    for name, values in record.columns.items():
        assert np.array_equal(values, again.columns[name])
        assert np.array_equal(values, log[name]) or name == "t"
    assert len(repr(record)) < 200
    assert "<table>" in record._repr_html_()
    assert mg.inspect_log(record, arm).to_json() == mg.inspect_log(log, arm).to_json()


def test_units_are_guessed_and_marked_as_guesses() -> None:
    t = np.arange(1000) / 100
    q = np.sin(t)
    table = {
        "t": t,
        "hip_angle": np.degrees(q),
        "knee_pos": q,
        "motor_current": 3e3 * q,
        "drive_temp": 30 + q,
    }
    table |= {"encoder": np.round(1e4 * q), "homed_pos": np.round(1e4 * q) - 211.35, "state": q}
    found = mg.inspect_log(table)
    guesses = {c["name"]: c["unit_guess"] for c in found.to_json()["channels"]}
    assert guesses == {
        "hip_angle": "deg",
        "knee_pos": "rad",
        "motor_current": "mA",
        "drive_temp": "degC",
        "encoder": "counts",
        "homed_pos": "counts",
        "state": None,
    }
    assert all(c.unit == "" for c in found.channels)
    assert "deg?" in found._repr_html_()


def test_rest_and_spikes_are_counted(log: dict[str, np.ndarray]) -> None:
    q, current = log["q2"].copy(), log["tau2"].copy()
    q[400:800] = q[400]
    current[[100, 900]] = 80.0
    found = {c.name: c for c in mg.inspect_log({"t": log["t"], "q1": q, "tau1": current}).channels}
    assert found["q1"].at_rest == pytest.approx(0.25, abs=0.02)
    assert found["q1"].spikes == 0
    assert found["tau1"].spikes == 2
    assert found["tau1"].at_rest is None


def test_a_joint_that_rests_throughout_is_a_note(arm: mg.Arm, log: dict[str, np.ndarray]) -> None:
    """As identify and diagnose have it: a log may hold a joint, not all of them."""
    held = log | {"q1": np.full(1600, 0.4)}
    found = mg.inspect_log(held, arm)
    assert any("left out for a, at rest throughout" in remark for remark in found.to_json()["remarks"])
    assert next(c for c in found.channels if c.name == "q1").at_rest == 1.0
    assert any(isinstance(part, str) and part.startswith("note: ") for part in found.shown())
    with pytest.raises(mg.InputError, match="all 2 joints are at rest"):
        mg.inspect_log(held | {"q2": np.zeros(1600)}, arm)


def test_stamps_of_another_name_are_used_by_a_guess(log: dict[str, np.ndarray]) -> None:
    table = {"stamp_ms": 1e12 + 1e3 * log["t"], "hip_pos": log["q2"]}
    found = mg.inspect_log(table)
    assert found.rate == pytest.approx(200, rel=1e-3)
    assert found.period == pytest.approx(2.0, abs=0.006)
    assert any("stamp_ms, in ms by a guess" in remark for remark in found.to_json()["remarks"])


def test_a_compressed_table_is_read(tmp_path: Path, arm: mg.Arm, log: dict[str, np.ndarray]) -> None:
    text = ",".join(log) + "\n"
    text += "\n".join(",".join(f"{x:.9g}" for x in row) for row in zip(*log.values(), strict=True))
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    (tmp_path / "a.csv.gz").write_bytes(gzip.compress(text.encode()))
    one, two = (mg.read_log(str(tmp_path / name), arm) for name in ("a.csv", "a.csv.gz"))
    assert np.array_equal(one.q, two.q)
    assert mg.inspect_log(str(tmp_path / "a.csv.gz")).samples == 1600
    (tmp_path / "b.csv.gz").write_bytes(gzip.compress(text.encode())[:-900])
    with pytest.raises(mg.InputError, match="ends too early, or is damaged"):
        mg.inspect_log(str(tmp_path / "b.csv.gz"))


def test_the_picture_has_every_channel_and_its_spikes(log: dict[str, np.ndarray]) -> None:
    found = mg.inspect_log(log)
    picture = found.picture()
    assert picture == mg.inspect_log(log).picture()
    assert all(f">{name}<" in picture for name in ("q1", "q2", "i1", "tau2"))
    assert "time between" in picture
    assert len(picture) < 300_000
