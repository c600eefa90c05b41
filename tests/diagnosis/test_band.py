"""The band in which coarse positions are asked: narrower than the usual one, and no less honest."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import ARM, COUNT, coarse, three

from modelgen.dataset import Record, prepare
from modelgen.dataset.processing.periods import period_of
from modelgen.diagnosis.equations import Band, Study, bands, settings_for
from modelgen.diagnosis.equations.position_errors import repeating_errors
from modelgen.diagnosis.equations.rows import rows_of
from modelgen.diagnosis.options.thresholds import USUAL, in_band
from modelgen.diagnosis.pipeline import diagnose
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model

EXACT = three("friction_offset", 1, 0.15, seed=8)
SEEN = [coarse(r) for r in EXACT]


def made(records: list[Record], narrower: bool = True) -> Band:
    lengths = [period_of(r, None) for r in records[:-1]]
    settings, model = settings_for(records, None, USUAL), build_model(ARM)
    return next(bands(Study(model, Evaluator(ARM), records, lengths, settings, USUAL, narrower)))


def test_coarse_positions_alone_narrow_the_band() -> None:
    exact, seen, wide = made(EXACT), made(SEEN), made(SEEN, narrower=False)
    assert exact.equations.narrowed == wide.equations.narrowed == 1.0
    assert exact.chosen.cutoff == wide.chosen.cutoff == 18.0
    assert seen.equations.narrowed == pytest.approx(18.0 / seen.chosen.cutoff)
    assert seen.equations.narrowed > 2.0
    # Errors of the positions lose more than what is white, since power of accelerations grows as f^5; what
    # comes down through samples that are left out loses less.
    assert (seen.equations.blur < wide.equations.blur / (2.0 * seen.equations.narrowed)).all()


def test_no_more_than_the_blur_comes_of_the_errors() -> None:
    """Against the same equations of positions without errors."""
    seen, evaluator, model = made(SEEN), Evaluator(ARM), build_model(ARM)
    total, count = np.zeros(2), np.zeros(2)
    for record, rows in zip(EXACT, seen.equations.rows, strict=False):
        exact = replace(prepare(record, seen.chosen), awake=rows.prepared.awake)  # of the same samples
        true = rows_of(evaluator, model, exact, seen.theta, rows.baseline)
        left = (true.effort - rows.effort) - (true.columns - rows.columns) @ seen.theta
        total += (left**2 * rows.moving).sum(axis=0)
        count += rows.moving.sum(axis=0)
    assert (0.2 * seen.equations.blur < total / count).all()
    assert (total / count < 1.5 * seen.equations.blur).all()


def test_a_cause_that_the_usual_band_loses_is_named_alone() -> None:
    found = diagnose(ARM, SEEN, experiment=False)
    assert [(c.effect, c.joint) for c in found.causes] == [("friction_offset", 1)]
    assert found.settings["practical_gain_percent"] > 1.5
    lost = diagnose(ARM, SEEN, cutoff=18.0, experiment=False)
    assert lost.settings["practical_gain_percent"] == 1.5
    assert [(c.effect, c.joint) for c in lost.causes] != [("friction_offset", 1)]


def test_the_gain_that_counts_is_the_same_cause_in_white_noise() -> None:
    noise, cause = 1.0, 0.04  # power in the usual band
    for narrowed in (1.0, 2.0, 5.0):
        in_usual = 100 * (1 - np.sqrt(noise / (noise + cause)))
        in_narrow = 100 * (1 - np.sqrt(noise / narrowed / (noise / narrowed + cause)))
        assert in_band(in_usual, narrowed) == pytest.approx(in_narrow)


def test_errors_of_steps_repeat_with_the_motion() -> None:
    seen = made(SEEN)
    assert repeating_errors(seen.equations).all()
    random = np.random.default_rng(3)
    shaken = [
        coarse(replace(r, q=r.q + np.array([0.0, COUNT]) * random.normal(size=r.q.shape))) for r in EXACT
    ]
    other = made(shaken)
    assert list(repeating_errors(other.equations)) == [True, False]
    assert not repeating_errors(replace(other.equations, periods=[None, None])).any()
    exact = made(EXACT)
    assert not repeating_errors(exact.equations).any()


def hummed(record: Record, size: float, seed: int) -> Record:
    """Positions with noise that vibrate between 9 and 16 Hz, otherwise in every period."""
    random = np.random.default_rng(seed)
    waves = [
        np.sin(2 * np.pi * f * record.t + phase)
        for f, phase in zip(random.uniform(9.0, 16.0, 30), random.uniform(0.0, 6.3, 30), strict=True)
    ]
    q = record.q + size * np.sum(waves, axis=0)[:, None] / np.sqrt(15.0)
    q = q + 0.03 * size * random.normal(size=q.shape)
    return replace(record, q=q, motor=q * np.array([80.0, 60.0]), motor_side=(False, False))


def test_where_nothing_repeats_the_band_ends_where_other_noise_begins() -> None:
    """In records with periods the noise is measured instead."""
    loud = [hummed(r, 3e-4, k) for k, r in enumerate(EXACT)]
    once = [r.part(0, round(0.6 * len(r.t) / 3)) for r in loud]
    calm = [r.part(0, round(0.6 * len(r.t) / 3)) for r in EXACT]
    assert settings_for(loud, None, USUAL).cutoff == settings_for(calm, None, USUAL).cutoff == 18.0
    assert 3.0 < (settings_for(once, None, USUAL).cutoff or 0.0) < 9.0
    assert settings_for(once, 18.0, USUAL).cutoff == 18.0
