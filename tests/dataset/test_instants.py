"""Readings are used at the instants at which they were taken, whatever the log's stamps and rows say."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from dataset_support import AXIS, DRIVEN, columns, motion, times, write_csv

from modelgen.dataset import Stream, last_quarter_out, prepare, read, split
from modelgen.dataset.inspection import inspect
from modelgen.errors import InputError

RNG = np.random.default_rng(11)


@pytest.mark.parametrize("every", [3, 7, 20 / 3])
def test_readings_that_stand_there_several_times_count_once(every: float, tmp_path: Path) -> None:
    rate = 600.0
    t = np.arange(round(12 * rate)) / rate
    fresh = np.floor(np.arange(len(t)) / every + 1e-9) * every / rate  # the instant of the reading in the row
    _, dq, _ = motion(fresh)
    noise = 0.01 * np.random.default_rng(4).normal(size=1 << 13)[np.rint(fresh * rate / every).astype(int)]
    table = columns(fresh) | {"t": t, "i1": 2 * dq[:, 0] + noise}
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    assert 1 / record.step == pytest.approx(rate / every, rel=1e-3)
    assert record.repeats == pytest.approx(every, rel=2e-3)
    assert record.q == pytest.approx(motion(record.t)[0], abs=2.0 / rate)
    assert "every reading stands there" in record.remarks[0]
    # Position and effort are new together: they were read together.
    assert record.hold == 0.0
    assert prepare(record).q.shape == record.q.shape


def test_a_coarse_encoder_that_turns_slowly_does_not_repeat_readings(tmp_path: Path) -> None:
    t = times(20.0, 200.0)
    step = 2 * np.pi / 1024
    q = step * np.rint(0.25 * np.abs((t / 5) % 2 - 1) / step)  # one step after every eight samples
    with_effort = {"t": t, "q1": q, "tau1": np.sign(np.gradient(q)) + 0.0}
    record = read(write_csv(tmp_path / "a.csv", with_effort), AXIS)
    assert len(record.t) == len(t)


@pytest.mark.parametrize(("every", "coarse"), [(20, 0.004), (6, 0.004), (20 / 3, 0.002)])
def test_coarse_readings_that_come_again_at_a_refresh_repeat(
    every: float, coarse: float, tmp_path: Path
) -> None:
    rate = 500.0
    t = np.arange(round(20 * rate)) / rate
    fresh = np.floor(np.arange(len(t)) / every + 1e-9) * every / rate
    q = 0.2 * np.sin(2.1 * fresh) + 0.05 * np.sin(5.3 * fresh)
    effort = 2.0 * np.cos(2.1 * fresh) + 0.7 * np.sin(3.7 * fresh)
    table = {"t": t, "q1": coarse * np.rint(q / coarse), "tau1": 0.25 * np.rint(effort / 0.25)}
    record = read(write_csv(tmp_path / "a.csv", table), AXIS)
    assert record.repeats == pytest.approx(every, rel=2e-3)
    assert 1 / record.step == pytest.approx(rate / every, rel=1e-3)


@pytest.mark.parametrize("slow", [("q1", "qm2"), ("q1",)])
def test_positions_that_are_refreshed_less_often_than_efforts(slow: tuple[str, ...], tmp_path: Path) -> None:
    t = times(12.0, 500.0)
    fresh = t[np.arange(len(t)) // 10 * 10]
    noise = 0.01 * np.random.default_rng(3).normal(size=len(t))
    fast = columns(t)
    table = fast | {name: columns(fresh)[name] for name in slow} | {"i1": fast["i1"] + noise}
    log = write_csv(tmp_path / "a.csv", table)
    record = read(log, DRIVEN)
    # five rows for every reading of a position, which is interpolated
    assert 1 / record.step == pytest.approx(250.0, rel=1e-4)
    assert record.repeats == pytest.approx(10.0)
    assert record.q[10:-10] == pytest.approx(motion(record.t)[0][10:-10], abs=1e-6)
    assert record.input is not None
    # the effort until the next row, on average half a period after this one
    later = 2 * motion(record.t + 0.001)[1][:, 0]
    assert record.input[1:-1, 0] == pytest.approx(later[1:-1], abs=0.05)
    assert record.hold == pytest.approx(0.002)
    assert f"{', '.join(slow)} stand" in record.remarks[0]
    assert any(
        re.search("q1.* stands? there 10 times while others change", said) for said in inspect(log).remarks
    )
    with pytest.raises(InputError, match="a reading of the positions stands there 10 times"):
        Stream(log, DRIVEN).settings  # noqa: B018


def test_rows_that_stand_there_twice_count_once(tmp_path: Path) -> None:
    table = columns(times(8.0, 200.0))
    again = np.sort(np.append(np.arange(1600), np.arange(0, 1600, 10)))
    record = read(write_csv(tmp_path / "a.csv", {k: x[again] for k, x in table.items()}), DRIVEN)
    assert record.t == pytest.approx(table["t"], abs=1e-9)
    assert record.q[:, 0].tolist() == table["q1"].tolist()
    assert record.remarks == ("160 rows stand there again, stamp and readings: each counts once",)


def test_slow_coarse_joints_at_constant_speeds_do_not_repeat_readings(tmp_path: Path) -> None:
    t = times(20.0, 200.0)
    ramp = np.abs((t / 5) % 2 - 1)
    table = {"t": t, "q1": 0.002 * np.rint(0.25 * ramp / 0.002), "tau1": 0.25 * np.rint(0.25 * ramp / 0.004)}
    assert read(write_csv(tmp_path / "a.csv", table), AXIS).repeats == 1.0


def test_stamps_coarser_than_the_samples(tmp_path: Path) -> None:
    t = times(8.0, 400.0)
    table = columns(t) | {"t": np.floor(t * 100) / 100}  # hundredths of a second, four samples each
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    assert record.step == pytest.approx(1 / 400, rel=1e-4)
    assert record.q == pytest.approx(motion(t)[0], abs=1e-9)
    assert "75 % of the stamps equal the one before" in record.remarks[0]


@pytest.mark.parametrize("true", [True, False])
def test_jitter_of_the_transport_is_told_from_jitter_of_the_sampling(true: bool, tmp_path: Path) -> None:
    t = times(8.0, 200.0)
    stamps = t + 0.0024 * np.random.default_rng(8).uniform(-1, 1, len(t))
    table = columns(stamps if true else t) | {"t": stamps}
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    assert record.q[5:-5] == pytest.approx(motion(record.t)[0][5:-5], abs=3e-4)
    assert any("samples count as evenly spaced" in remark for remark in record.remarks) != true


def test_stamps_since_an_epoch_are_written_in_full(tmp_path: Path) -> None:
    table = columns(times())
    small = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    large = read(write_csv(tmp_path / "b.csv", table | {"t": table["t"] + 3e8}), DRIVEN)
    assert [re.sub(r".*@", "", part.name) for part in split(small)] == ["0:4", "4:8"]
    first, second = split(large)
    assert first.name.endswith("@300000000:300000004")
    assert read(second.name, DRIVEN).q == pytest.approx(second.q)
    assert "@300000005.99" in last_quarter_out(large)


def test_a_log_without_stamps_has_the_rate_that_the_mapping_says(tmp_path: Path) -> None:
    t = times()
    mapping = tmp_path / "m.yaml"
    text = "schema: 1\nrate: 200\njoints: [{position: {column: x, unit: m}, effort: {column: f, unit: N}}]\n"
    mapping.write_text(text)
    file = write_csv(tmp_path / "a.csv", {"x": 0.2 * np.cos(t), "f": np.sin(t)})
    record = read(f"{file}@1:3", AXIS, mapping)
    assert record.t == pytest.approx(t[200:600])
    assert record.q[:, 0] == pytest.approx(0.2 * np.cos(t[200:600]))
    mapping.write_text(text.replace("200", "-1"))
    with pytest.raises(InputError, match="rate: found -1, expected a number above 0"):
        read(file, AXIS, mapping)
