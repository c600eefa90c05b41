"""A single record in two: at a boundary of its periods, found in logs that say nothing of them."""

import re

import numpy as np
import pytest

from modelgen.dataset import ColumnTable, Record, split
from modelgen.dataset.inspection.channels import inspect
from modelgen.dataset.processing.periods import period_of
from modelgen.dataset.processing.splitting import as_given, repeating
from modelgen.errors import InputError
from modelgen.numeric import Array

RATE = 100.0


def moving(periods: float, period: float, seed: int, late: float = 0.0) -> Record:
    """Two joints on a Fourier series, with noise, for `late` seconds on the way from rest into it."""
    rng = np.random.default_rng(seed)
    t = np.arange(round((periods * period + late) * RATE)) / RATE
    phase = 2 * np.pi * np.multiply.outer(t - late, 1 + np.arange(4)) / period
    q = np.cos(phase) @ rng.uniform(-0.4, 0.4, (4, 2)) + np.sin(phase) @ rng.uniform(-0.4, 0.4, (4, 2))
    if late:
        x = np.clip(t / late, 0.0, 1.0)[:, None]
        q = q * x**3 * (10 - 15 * x + 6 * x**2)
    q += 1e-4 * rng.normal(size=q.shape)
    return Record("run.csv", t, q, q, q.copy())


def whole_periods(part: Record) -> float | None:
    """Of the motion in a part [samples], looked for in its samples alone."""
    alone = Record("alone", part.t, part.q, part.motor)
    return period_of(alone, None)


def joined(first: Record, second: Record) -> Array:
    return np.concatenate([first.t, second.t])


@pytest.mark.parametrize("late", [0.0, 0.3])
@pytest.mark.parametrize("period", [10.0, 40 / 3, 9.983])
@pytest.mark.parametrize(("periods", "before"), [(2.0, 1), (2.5, 1), (3.0, 2), (4.0, 2), (5.5, 3)])
def test_parts_meet_at_a_boundary_of_periods(periods: float, before: int, period: float, late: float) -> None:
    record = moving(periods, period, 3, late * period)
    first, second = split(record)
    begin, middle = first.t[0], second.t[0]
    assert middle - begin == pytest.approx(before * period, abs=1.0 / RATE)
    assert (begin == 0.0) if not late else (0.0 < begin <= late * period)
    kept = joined(first, second)
    assert np.array_equal(kept, record.t[len(record.t) - len(kept) :])
    (said,) = first.remarks
    assert re.search(rf"in two at t = {middle:.6g} s: {int(periods)} periods of {period:.3g}", said)
    assert ("left out" in said) == bool(late)
    assert ("noise is not measured" in said) == (before == 1)
    if before > 1:
        assert whole_periods(first) == pytest.approx(period * RATE, abs=1.0)
        assert period_of(first, None) == pytest.approx(period * RATE, abs=0.02 if periods > 3.5 else 0.1)
    assert period_of(second, None) == (period_of(first, None) if periods >= 4 else None)


def test_what_does_not_repeat_is_split_in_the_middle() -> None:
    record = moving(1.5, 10.0, 3)
    first, second = split(record)
    assert len(first.t) == len(second.t)
    assert first.period is None
    assert "the motion does not repeat" in first.remarks[0]


def test_a_beginning_of_more_than_a_period_is_another_motion() -> None:
    """Half of a log on another motion is no way into the one that repeats."""
    other, record = moving(1.0, 25.0, 7), moving(2.2, 10.0, 3)
    q = np.concatenate([other.q, record.q])
    t = np.arange(len(q)) / RATE
    first, second = split(Record("run.csv", t, q, q, q.copy()))
    assert (first.t[0], first.period) == (0.0, None)
    assert len(first.t) == len(second.t)


def test_a_period_that_is_given_sets_the_boundary() -> None:
    """The motion repeats after 5 s, and the arm is loaded anew every 10 s, say."""
    record = moving(6.0, 5.0, 3)
    assert split(record)[1].t[0] == pytest.approx(15.0)
    assert split(record, 10.0)[1].t[0] == pytest.approx(20.0)


@pytest.mark.parametrize("given", [False, True])
@pytest.mark.parametrize("late", [0.05, 0.3, 0.7])
@pytest.mark.parametrize("period", [10.0, 40 / 3])
def test_a_record_begins_where_its_motion_repeats(period: float, late: float, given: bool) -> None:
    """The way into the motion is left out, its periods are not."""
    record = moving(3.0, period, 3, late * period)
    part, lag = repeating(record, period if given else None)
    assert lag == pytest.approx(period * RATE, abs=0.1)
    assert 0.0 < part.t[0] <= late * period
    assert np.array_equal(part.q, record.q[len(record.t) - len(part.t) :])
    assert period_of(part, None) == lag
    (said,) = part.remarks
    assert f"every {lag / RATE:.6g} s from t = {part.t[0]:.9g} s on" in said
    with pytest.raises(InputError, match="does not repeat"):
        repeating(record, 0.77 * period)


@pytest.mark.parametrize("periods", [1.5, 3.0])
def test_a_record_without_a_way_in_is_as_it_was(periods: float) -> None:
    record = moving(periods, 10.0, 3)
    part, lag = repeating(record)
    assert part is record
    assert lag == (None if periods < 2 else pytest.approx(10.0 * RATE, abs=0.1))


def test_inspect_says_from_where_a_motion_repeats() -> None:
    record = moving(3.0, 10.0, 3, 4.0)
    for log in (record, {"t": record.t, "q1": record.q[:, 0], "q2": record.q[:, 1]}):
        found = inspect(log if isinstance(log, Record) else ColumnTable(log, "log"))
        assert found.period == pytest.approx(10.0, abs=0.01)
        assert any("the motion repeats every 10 s from t = " in remark for remark in found.remarks)


@pytest.mark.parametrize("periods", [1.5, 4.0])
def test_parts_are_joined_to_what_they_were(periods: float) -> None:
    record = moving(periods, 10.0, 3)
    (whole,) = as_given(split(record))
    for name in ("t", "q", "motor", "input"):
        one, other = getattr(whole, name), getattr(record, name)
        assert one is other is None or np.array_equal(one, other)
    parts = [record, moving(periods, 10.0, 4)]
    assert as_given(parts) == parts
    assert as_given([record]) == [record]
