"""Filters, derivatives, the hold, parallel filtering: against closed forms."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from dataset_support import AXIS, DRIVEN, FREE, columns, counts_of, motion, times, write_csv

from modelgen.dataset import Record, Settings, choose, described, prepare, preset, read, spectra_svg
from modelgen.dataset.processing.filters import advanced, differences, low_pass
from modelgen.errors import InputError


@pytest.mark.parametrize("half_width", [1, 2, 3])
def test_differences_are_exact_for_polynomials_of_their_order(half_width: int) -> None:
    t = np.linspace(-1.0, 1.0, 41)
    power = 2 * half_width
    first, second = differences(t[:, None] ** power, t[1] - t[0], half_width)
    inner = slice(half_width, -half_width)
    assert first[inner, 0] == pytest.approx(power * t[inner] ** (power - 1), abs=1e-12)
    assert second[inner, 0] == pytest.approx(power * (power - 1) * t[inner] ** (power - 2), abs=1e-10)


def test_the_low_pass_has_no_phase_and_halves_the_cut_off() -> None:
    t = np.arange(0.0, 20.0, 1e-3)
    wave = np.cos(2 * np.pi * 5.0 * t + 0.3)[:, None]
    filtered = low_pass(wave, 5.0, 1e3, 4)
    assert filtered[5000:-5000] == pytest.approx(0.5 * wave[5000:-5000], abs=1e-5)


@pytest.mark.parametrize("delay", [0.5, -0.5, 0.3, 2.25, -1.0])
def test_a_late_sample_is_moved_back_to_its_stamp(delay: float) -> None:
    k = np.arange(200.0)
    moved = advanced(np.cos(0.1 * (k + delay))[:, None], delay, held=False)
    # Cubic interpolation: error below 3/128 of the fourth difference.
    assert moved[5:-5, 0] == pytest.approx(np.cos(0.1 * k[5:-5]), abs=3 / 128 * 0.1**4 * 1.01)


@pytest.mark.parametrize("side", [1, -1])
def test_what_was_held_over_a_period_is_its_mean(side: int) -> None:
    """Means of a wave by fine sampling, before or after each stamp, give the wave at the stamps."""
    k = np.arange(400.0)
    w = 2 * np.pi / 40
    fine = (np.arange(256) + 0.5) / 256 * side
    means = np.cos(w * (k[:, None] + fine) + 0.4).mean(axis=1)
    moved = advanced(means[:, None], side / 2, held=True)
    # 1 / sinc(w/2) less the response of the taps begins with 0.53 (w/2)^4; the mean of two would leave 8e-3
    assert moved[5:-5, 0] == pytest.approx(np.cos(w * k[5:-5] + 0.4), abs=0.55 * (w / 2) ** 4)


RATE = 200.0
T = times(20.0, RATE)


def recorded(folder: Path, **changed: np.ndarray) -> Record:
    return read(write_csv(folder / "a.csv", columns(T) | changed), DRIVEN)


@pytest.mark.parametrize("cutoff", [2.0, 4.0, None])
def test_derivatives_are_those_of_the_motion(cutoff: float | None, tmp_path: Path) -> None:
    p = prepare(recorded(tmp_path), Settings(cutoff=cutoff))
    for found, expected in zip((p.q, p.dq, p.ddq), motion(T), strict=True):
        error = np.abs(found - expected)[p.rows] / np.max(np.abs(expected), axis=0)
        assert np.max(error) < 2e-4
    # Motor rates by the chain rule, against differences of the law of cosines.
    q = motion(T)[0][:, 1]
    dmotor = np.gradient(counts_of(q), 1 / RATE, edge_order=2)
    ddmotor = np.gradient(dmotor, 1 / RATE, edge_order=2)
    assert p.dmotor[p.rows, 1] == pytest.approx(dmotor[p.rows], abs=2e-3 * np.ptp(dmotor))
    assert p.ddmotor[p.rows, 1] == pytest.approx(ddmotor[p.rows], abs=5e-3 * np.ptp(ddmotor))


def test_a_quantised_lever_is_filtered_in_its_increments(tmp_path: Path) -> None:
    coarse = np.round(counts_of(motion(T)[0][:, 1]) / 40) * 40
    record = recorded(tmp_path, qm2=coarse)
    p = prepare(record, Settings(cutoff=2.0))
    assert p.motor[:, 1] == pytest.approx(low_pass(coarse[:, None], 9.0, RATE, 4)[:, 0], rel=1e-12)
    assert p.q[:, 1] != pytest.approx(low_pass(record.q, 9.0, RATE, 4)[:, 1], abs=1e-9)


def test_a_linear_law_stays_linear_through_the_parallel_filter(tmp_path: Path) -> None:
    """Friction's steps at reversals pass the filter in the effort as in the regressor."""
    _, dq, _ = motion(T)
    law = 0.3 * np.sign(dq[:, 0]) + 0.2 * dq[:, 0] + 0.1
    record = replace(recorded(tmp_path, i1=law), hold=0.0)
    p = prepare(record, Settings(cutoff=2.0))
    sign = np.sign(p.dq[:, 0])
    wide = p.parallel(np.stack([sign, p.dq[:, 0], np.ones_like(sign)], axis=1))
    values, *_ = np.linalg.lstsq(wide, p.effort[:, 0], rcond=None)
    assert values == pytest.approx([0.3, 0.2, 0.1], abs=1e-3)
    # Filtering the effort alone leaves the steps over, and biases.
    alone, *_ = np.linalg.lstsq(p.picked(np.stack([sign, p.dq[:, 0]], axis=1)), p.effort[:, 0], rcond=None)
    assert abs(alone[0] - 0.3) > 0.01


MASS = 400.0


def pushed(stamps: np.ndarray) -> dict[str, np.ndarray]:
    """A mass under a force that a controller holds between the stamps, solved exactly."""
    held, steps = np.cos(2 * np.pi * 1.5 * stamps), np.diff(stamps)
    speed = np.concatenate([[0.0], np.cumsum(held[:-1] * steps)]) / MASS
    moved = speed[:-1] * steps + held[:-1] * steps**2 / 2 / MASS
    return {"t": stamps, "q1": np.concatenate([[0.0], np.cumsum(moved)]), "tau1": held}


def mass_and_delay(record: Record) -> tuple[float, float]:
    """By least squares: mass [kg], and the delay of the motion behind the force [s]."""
    p = prepare(record, Settings(cutoff=5.0))
    columns = np.stack([p.ddq[:, 0], np.gradient(p.ddq[:, 0], record.step)], axis=1)
    values, *_ = np.linalg.lstsq(p.parallel(columns), p.effort[:, 0], rcond=None)
    return float(values[0]), float(values[1] / values[0])


def test_a_held_effort_is_known_half_a_period_later(tmp_path: Path) -> None:
    record = read(write_csv(tmp_path / "a.csv", pushed(T)), AXIS)
    mass, delay = mass_and_delay(record)
    assert mass == pytest.approx(MASS, rel=1e-3)
    assert abs(delay) < 1e-2 * record.step
    # Where that is not undone, half a period is a delay.
    assert mass_and_delay(replace(record, hold=0.0))[1] == pytest.approx(0.5 * record.step, rel=0.05)


def test_a_held_effort_on_a_jittering_clock_has_no_delay(tmp_path: Path) -> None:
    rng = np.random.default_rng(8)
    stamps = np.cumsum(rng.uniform(0.8, 1.2, len(T)) / RATE)
    record = read(write_csv(tmp_path / "a.csv", pushed(stamps)), AXIS)
    assert "resampled" in record.remarks[0]
    mass, delay = mass_and_delay(record)
    assert mass == pytest.approx(MASS, rel=1e-3)
    assert abs(delay) < 2e-2 * record.step


def test_rest_is_gated_and_reversals_are_not(tmp_path: Path) -> None:
    q = motion(T)[0][:, 0].copy()
    still = (T > 5) & (T < 9)
    q[still] = q[np.argmax(still)]
    p = prepare(recorded(tmp_path, q1=q), Settings(cutoff=5.0, rest_gate=0.05))
    inside = (p.t > 5.1) & (p.t < 8.9)
    assert not p.moving[inside, 0].any()
    away = (p.t < 4.6) | (p.t > 9.4)
    assert p.moving[away, 0].mean() > 0.9
    assert p.moving[:, 1].mean() > 0.9


def test_a_reversal_is_no_rest_however_wide_the_band(tmp_path: Path) -> None:
    """A triangle of speed that turns round at 0.8 m/s^2, and one that stands for 10 ms where it turns."""
    t = times(1.6, 1000.0)

    def moving(dwell: float) -> np.ndarray:
        away = (t - 0.8) - np.clip(t - 0.8, -dwell / 2, dwell / 2)
        table = {"t": t, "q1": 0.05 - 0.4 * away**2, "tau1": np.sin(t)}
        p = prepare(
            read(write_csv(tmp_path / "a.csv", table), AXIS), Settings(cutoff=77.0, rest_gate=1.25e-3)
        )
        return p.moving[np.abs(p.t - 0.8) < 0.012, 0]

    assert moving(0.0).all()
    assert not moving(0.01).any()


def test_samples_are_awake_but_for_rests_of_a_moment(tmp_path: Path) -> None:
    t = times(30.0, 500.0)
    stuck = np.zeros(len(t), dtype=bool)
    for k in range(12):  # reversals, each as much later as it stuck before
        turn = 1.25 + 2.516 * k
        stuck |= (t > turn) & (t < turn + 0.016)
    late = np.cumsum(np.where(stuck, 1 / 500.0, 0.0))
    q = 0.25 * np.sin(2 * np.pi * 0.2 * (t - late))
    log = write_csv(tmp_path / "a.csv", {"t": t, "q1": q, "tau1": np.zeros(len(t))})
    p = prepare(read(log, AXIS), Settings(cutoff=8.0, rest_gate=0.005))
    assert not p.awake[stuck, 0].any()
    assert p.awake[:, 0].mean() > 0.9


def test_rows_fill_the_pass_band(tmp_path: Path) -> None:
    p = prepare(recorded(tmp_path), Settings(cutoff=4.0))
    assert p.rate == pytest.approx(RATE / p.settings.factor)
    assert 2.3 <= p.rate / 4.0 < 2.6
    assert p.settings.position_cutoff >= 4 * 4.0
    assert p.t[0] >= 1.5 / 4.0
    assert T[-1] - p.t[-1] >= 1.5 / 4.0 - 1e-9


def test_the_preset_of_the_paper(tmp_path: Path) -> None:
    record = recorded(tmp_path)
    settings = choose(record, preset("paper", RATE))
    assert settings.position_cutoff == pytest.approx(0.1 * RATE / 2)
    assert (settings.position_order, settings.half_width, settings.factor) == (3, 1, 1)
    p = prepare(replace(record, hold=0.0), settings)
    assert p.effort == pytest.approx(record.input[p.rows])
    assert choose(record, preset("paper_parallel", RATE)).cutoff == pytest.approx(10.0)
    with pytest.raises(InputError, match="found the preset 'papers', expected one of default, paper"):
        preset("papers", RATE)


def test_the_cut_off_falls_with_the_noise_of_the_positions() -> None:
    rng = np.random.default_rng(5)
    t = times(30.0, 500.0)
    q = sum(np.sin(2 * np.pi * 0.1 * k * t + k) / k for k in range(1, 6))
    found = []
    for step in (1e-6, 1e-4, 1e-2):
        logged = (np.round((q + rng.uniform(0, step, len(t))) / step) * step)[:, None]
        found.append(choose(Record("a", t, logged, logged)).cutoff)
    assert found == sorted(found, reverse=True)
    assert found[0] == pytest.approx(20.0)  # a twenty-fifth of the rate
    assert 1.25 <= found[2] < 0.5 * found[0]


def test_the_noisiest_of_several_records_decides_the_cut_off() -> None:
    rng = np.random.default_rng(6)
    t = times(30.0, 500.0)
    q = sum(np.sin(2 * np.pi * 0.1 * k * t + k) / k for k in range(1, 6))[:, None]
    quiet, noisy = (Record("a", t, q + x * rng.normal(size=q.shape), q) for x in (1e-7, 1e-3))
    alone = [choose(record).cutoff for record in (quiet, noisy)]
    assert alone[1] < 0.5 * alone[0]
    assert choose([quiet, noisy]).cutoff == choose([noisy, quiet]).cutoff == alone[1]
    # a short record is not lost in the filter's ends: the band is as wide as it needs
    assert choose([noisy.part(0, 1000), noisy]).cutoff > 2.0 * alone[1]


def test_one_choice_serves_several_records(tmp_path: Path) -> None:
    record = recorded(tmp_path)
    quiet = record.part(0, 2000)
    both = choose([quiet, record.part(2000, 4000)])
    assert prepare(quiet, both).settings is both
    other = replace(record, t=record.t * 2)
    with pytest.raises(InputError, match=r"found the rate 100 Hz, .* has 200 Hz"):
        choose([record, other])


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            Settings(cutoff=120.0),
            "found the cut-off 120 Hz, expected one above 0 and below half the rate, 100 Hz",
        ),
        (Settings(cutoff=5.0, position_cutoff=-1.0), "found the position cut-off -1 Hz"),
        (Settings(cutoff=0.2), "too short a record: with the cut-off 0.2 Hz only"),
        (Settings(rest_gate=(0.1, 0.1, 0.1)), "found 3 rest thresholds, expected one or 2"),
    ],
)
def test_settings_must_fit_the_record(settings: Settings, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        prepare(recorded(tmp_path), settings)


def test_the_spectra_are_drawn_alike_every_time(tmp_path: Path) -> None:
    p = prepare(recorded(tmp_path), Settings(cutoff=4.0))
    picture = spectra_svg(p)
    assert picture == spectra_svg(p)
    assert "<dc:date>" not in picture
    words = [e.text for e in ElementTree.fromstring(picture).iter() if e.tag.endswith("text")]
    assert {"hip, position, cut-off 18 Hz", "knee, effort, cut-off 4 Hz", "effort [A/√Hz]"} <= set(words)
    free = read(write_csv(tmp_path / "b.csv", {"t": T, "q1": np.cos(T), "q2": np.sin(T)}), FREE)
    assert "free motion" in spectra_svg(prepare(free))


def test_the_processing_is_told(tmp_path: Path) -> None:
    text = described(prepare(recorded(tmp_path), Settings(cutoff=4.0)))
    assert text[0] == "record: 4000 samples at 200 Hz"
    assert "effort and regressor alike: Butterworth, order 4, 4 Hz, forwards and backwards" in text[3]
    assert "every 21st sample" in text[4]
    one = replace(recorded(tmp_path), name="one.csv")
    text = described(prepare(one, replace(choose([one], Settings(cutoff=4.0)), spacing=9.998)), 2, 9000)
    assert text[0] == "2 training records: 9000 samples at 200 Hz"
    assert text[4].startswith("rows (one.csv, the first record): a row every 9.998 samples, ")
    assert text[5].startswith("rows that move (one.csv, the first record): ")
