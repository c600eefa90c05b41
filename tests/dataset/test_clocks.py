"""Sources that refresh their readings at instants of their own, whatever their clock, under a faster log."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dataset_support import AXIS, DRIVEN, columns, motion, times, write_csv

from modelgen.dataset import choose, read
from modelgen.dataset.inspection import inspect
from modelgen.dataset.reading.clocks import clocks
from modelgen.errors import InputError
from modelgen.numeric import Array

NAMES = ("q1", "qm2", "i1", "i2")


def instants(seconds: float, rate: float, jitter: float, seed: int = 0) -> Array:
    """When a source refreshes [s]: its periods vary by a share of their mean."""
    periods = np.random.default_rng(seed).uniform(1.0 - jitter, 1.0 + jitter, round(1.2 * seconds * rate))
    return np.append(0.0, np.cumsum(periods) / rate)


def noisy(t: Array, seed: int = 0) -> dict[str, Array]:
    """A log of `driven` whose efforts are measured."""
    table, rng = columns(t), np.random.default_rng(seed)
    return table | {name: table[name] + 0.005 * rng.normal(size=len(t)) for name in ("i1", "i2")}


def held(t: Array, source: Array, names: tuple[str, ...] = NAMES) -> dict[str, Array]:
    """What a log of `driven` with stamps t has of channels that a source refreshes."""
    last = np.searchsorted(source, t + 1e-9, side="right") - 1
    shown = noisy(source)
    return noisy(t, seed=1) | {name: shown[name][last] for name in names}


@pytest.mark.parametrize(
    ("rate", "source", "jitter"), [(400.0, 40.0, 0.15), (600.0, 90.0, 0.35), (1000.0, 70.0, 0.5)]
)
def test_a_source_without_an_even_clock_counts_at_its_own_instants(
    rate: float, source: float, jitter: float, tmp_path: Path
) -> None:
    table = held(times(16.0, rate), instants(16.0, source, jitter))
    log = write_csv(tmp_path / "a.csv", table)
    record = read(log, DRIVEN)
    assert record.repeats == pytest.approx(rate / source, rel=0.03)
    assert 1 / record.step == pytest.approx(source, rel=0.1)
    # A reading shows in the row after it: it is as much as a row old.
    assert record.q[5:-5] == pytest.approx(motion(record.t)[0][5:-5], abs=2.5 / rate)
    assert record.hold == 0.0
    assert record.jitter > 0.5 * jitter
    assert "every reading stands there" in record.remarks[0]
    assert "times on average, from" in record.remarks[0]
    assert any("every reading stands there" in remark for remark in inspect(log).remarks)


def test_records_of_unlike_rates_are_told_which_repeats_its_readings(tmp_path: Path) -> None:
    t = times(16.0, 400.0)
    tables = {"all.csv": noisy(t), "some.csv": held(t, np.arange(0.0, 17.0, 0.025))}
    every, some = (read(write_csv(tmp_path / name, table), DRIVEN) for name, table in tables.items())
    why = r"40 Hz, .* 400 Hz, for readings are new once in every 10 rows of .*some"
    with pytest.raises(InputError, match=why) as said:
        choose([every, some])
    assert "rows of " + every.name not in str(said.value)


def test_readings_at_random_instants_count_once(tmp_path: Path) -> None:
    waits = np.random.default_rng(7).exponential(1 / 60.0, 1500)
    record = read(
        write_csv(tmp_path / "a.csv", held(times(16.0, 500.0), np.cumsum(np.append(0, waits)))), DRIVEN
    )
    assert record.repeats == pytest.approx(500 / 60, rel=0.15)


@pytest.mark.parametrize("source", [410.0, 270.0])
def test_a_source_that_is_little_slower_than_the_log_repeats_some_readings(
    source: float, tmp_path: Path
) -> None:
    record = read(
        write_csv(tmp_path / "a.csv", held(times(12.0, 500.0), instants(12.0, source, 0.0))), DRIVEN
    )
    assert 1 / record.step == pytest.approx(source, rel=1e-3)
    assert record.q[5:-5] == pytest.approx(motion(record.t)[0][5:-5], abs=5e-3)
    assert record.hold == 0.0


def test_one_joint_that_is_refreshed_at_instants_of_its_own(tmp_path: Path) -> None:
    rate, source = 400.0, 80.0
    table = held(times(16.0, rate), instants(16.0, source, 0.3), ("qm2", "i2"))
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    assert record.repeats == pytest.approx(rate / source, rel=0.03)
    assert record.input is not None
    dq = motion(record.t)[1]
    # what is new in every row is read at the instants of what is not
    assert record.input[5:-5] == pytest.approx(np.column_stack([2 * dq[:, 0], 1 + dq[:, 1]])[5:-5], abs=0.06)


@pytest.mark.parametrize("jitter", [0.0, 0.3])
def test_efforts_that_are_refreshed_alone_count_when_they_are_new(jitter: float, tmp_path: Path) -> None:
    rate, source = 400.0, 50.0
    log = write_csv(tmp_path / "a.csv", held(times(16.0, rate), instants(16.0, source, jitter), ("i1", "i2")))
    record = read(log, DRIVEN)
    assert record.repeats == pytest.approx(rate / source, rel=0.03)
    assert record.hold == 0.0
    assert record.input is not None
    q, dq, _ = motion(record.t)
    assert record.q[5:-5] == pytest.approx(q[5:-5], abs=1e-3)
    assert record.input[5:-5, 0] == pytest.approx(2 * dq[5:-5, 0], abs=0.08)
    for remarks in (record.remarks, inspect(log).remarks):
        assert any("i1, i2 stand there 8" in x or "i1, i2 stand there 7.9" in x for x in remarks)
    assert "log each once, or with its own stamp" in record.remarks[0]


def test_joints_whose_sources_have_rates_of_their_own(tmp_path: Path) -> None:
    t = times(16.0, 600.0)
    quick, slow = (instants(16.0, rate, 0.0) for rate in (200.0, 100.0))
    table = held(t, quick, ("q1", "i1")) | {k: held(t, slow)[k] for k in ("qm2", "i2")}
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    assert 1 / record.step == pytest.approx(100.0, rel=1e-3)
    assert record.hold == 0.0
    assert record.q[5:-5] == pytest.approx(motion(record.t)[0][5:-5], abs=1e-4)
    for part in ("q1, i1 stand there 3 times, at 200 Hz", "qm2, i2 stand there 6 times, at 100 Hz"):
        assert part in record.remarks[0]


def test_a_coarse_channel_has_the_clock_of_the_fine_ones_beside_it(tmp_path: Path) -> None:
    table = held(times(16.0, 600.0), instants(16.0, 90.0, 0.35))
    step = 2 * np.pi / 256
    record = read(write_csv(tmp_path / "a.csv", table | {"q1": step * np.rint(table["q1"] / step)}), DRIVEN)
    assert record.repeats == pytest.approx(600 / 90, rel=0.03)
    assert "every reading stands there" in record.remarks[0]


@pytest.mark.parametrize("bits", [8, 10, 12])
@pytest.mark.parametrize("ampere", [0.1, 0.25, 1.0])
@pytest.mark.parametrize("noise", [0.0, 0.2])
def test_coarse_encoders_and_currents_are_read_in_every_row(
    bits: int, ampere: float, noise: float, tmp_path: Path
) -> None:
    t, step = times(16.0, 500.0), 2 * np.pi / 2**bits
    q, dq, _ = motion(t)
    shaken = noise * np.random.default_rng(bits).normal(size=len(t))
    effort = 4.0 * np.cos(q[:, 0]) + 2.0 * np.sign(dq[:, 0]) + dq[:, 0] + shaken
    table = {"t": t, "q1": step * np.rint(0.3 * q[:, 0] / step), "tau1": ampere * np.rint(effort / ampere)}
    assert read(write_csv(tmp_path / "a.csv", table), AXIS).repeats == 1.0


def test_joints_that_rest_and_efforts_that_are_cut_off_are_read_in_every_row(tmp_path: Path) -> None:
    t = times(30.0, 400.0)
    wave = np.maximum(np.sin(2 * np.pi * 0.3 * t), 0.0) ** 3  # half of the time at rest
    table = {"t": t, "q1": 0.3 * wave, "tau1": np.clip(9.0 * np.sin(2 * np.pi * 0.7 * t), -2.0, 2.0)}
    assert read(write_csv(tmp_path / "a.csv", table), AXIS).repeats == 1.0


def test_an_effort_of_a_few_levels_is_read_in_every_row(tmp_path: Path) -> None:
    t = times(60.0, 200.0)
    profile = np.sign(np.sin(2 * np.pi * 0.5 * t)) * (1.0 + 2.0 * (np.sin(2 * np.pi * 1.5 * t) > 0.0))
    table = {"t": t, "q1": 0.2 * np.sin(2 * np.pi * 0.5 * t), "tau1": profile}
    assert read(write_csv(tmp_path / "a.csv", table), AXIS).repeats == 1.0


def test_a_motor_that_is_logged_as_it_moves_on_repeats_nothing() -> None:
    """It stands while some rows are written, and moves by far more than a step between them."""
    random = np.random.default_rng(2)
    stays = random.integers(1, 5, 300)
    q = np.repeat(np.cumsum(random.uniform(0.001, 0.03, 300)), stays)
    i = 0.1 * np.sin(20 * q) + 0.01 * random.standard_normal(len(q))
    begins = np.append(0, np.cumsum(stays))[:-1]
    steps = np.full(len(q), 0.013)
    steps[begins] += random.uniform(0.1, 0.8, 300)
    logged, paced = np.cumsum(steps), 0.013 * np.arange(len(q))
    assert clocks(np.column_stack([logged, q, i]), [1], [2]) == {}
    assert 1 in clocks(np.column_stack([paced, q, i]), [1], [2])


def test_the_rounding_of_what_a_mapping_computes_is_no_reading() -> None:
    """An angle against the link before, of two inclinometers of 0.1 degrees, moves at times by 1e-14."""
    random, t = np.random.default_rng(3), times(75.0, 50.0)
    first, second = (
        sum(18.0 / k * np.sin(0.25 * k * t + random.uniform(0, 6.28)) for k in (1, 2, 3, 5)) for _ in range(2)
    )
    boom, stick = (0.1 * np.rint(10.0 * (x + 40.0)) for x in (first, first + second))
    efforts = [1e5 * np.round(100 + 30 * np.sin(t + k) + random.normal(size=len(t)), 1) for k in range(2)]
    turned = np.radians(stick - boom)
    assert 0.0 < np.abs(np.diff(turned))[np.diff(turned) != 0.0].min() < 1e-12
    assert not clocks(np.column_stack([t, np.radians(boom), turned, *efforts]), (1, 2), (3, 4))
