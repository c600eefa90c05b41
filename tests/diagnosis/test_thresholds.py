"""A threshold of the diagnosis acts: with another value the function that uses it answers otherwise.

The function is called by itself, on equations of a made-up arm or on some of which all is known.
"""

from dataclasses import replace
from functools import cache
from itertools import islice
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import ARM, BARE, UNUSED, coarse, equations_of
from numpy.random import default_rng
from threshold_decisions import CASES as DECISIONS
from threshold_support import Seen, band, known, law, logs, real, refusal, valued, with_columns

from modelgen.description import Inertial
from modelgen.diagnosis.adequacy import lack_of_fit
from modelgen.diagnosis.adequacy.explained import explained
from modelgen.diagnosis.adequacy.free_form import further_terms
from modelgen.diagnosis.adequacy.smooth_functions import like_delta_bic, smooth_functions
from modelgen.diagnosis.candidates import FittedCandidate, asked, candidates, check_one_arm, cold
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import sensible
from modelgen.diagnosis.candidates.periodogram import waves
from modelgen.diagnosis.candidates.search import Search
from modelgen.diagnosis.decision import _counted
from modelgen.diagnosis.equations import Rows, bands, check_efforts, settings_for, study_of
from modelgen.diagnosis.equations.checks import check_excitation, check_motion
from modelgen.diagnosis.equations.position_errors import counts, repeating_errors, rounded
from modelgen.diagnosis.equations.prior import told
from modelgen.diagnosis.evidence import System, endogeneity, independent
from modelgen.diagnosis.evidence.noise import whitener
from modelgen.diagnosis.experiment import setup
from modelgen.diagnosis.experiment.bench_tests import _motions
from modelgen.diagnosis.experiment.discrimination import hypothesis
from modelgen.diagnosis.extended.test_errors import compared
from modelgen.diagnosis.options import Options, Thresholds
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.compliance import member
from modelgen.diagnosis.selection.rivals import ambiguity_set, lesser_rivals, needed_behind
from modelgen.diagnosis.selection.stepwise import least_evidence, threshold
from modelgen.diagnosis.validation.conditions import Conditions, Judgement
from modelgen.functions import build_model
from modelgen.thresholds import Value


def still(limits: Thresholds, share: float, count: int = 400) -> Any:
    """Whether records that move so much of the time are refused."""
    moving = np.arange(count)[:, None] < share * count
    rows = [
        Rows(UNUSED, np.ones((count, 1)), default_rng(1).normal(size=(count, 1, 2)), moving, BARE)
        for _ in range(2)
    ]
    prepared: Any = SimpleNamespace(record=SimpleNamespace(name="log"), rows=range(count), rate=100.0)
    given = SimpleNamespace(
        thresholds=limits,
        rows=[replace(r, prepared=prepared) for r in rows],
        arm=ARM,
        unknowns=2,
        model=SimpleNamespace(grouping=SimpleNamespace(base=[])),
    )
    return refusal(lambda: check_motion(given))  # type: ignore[arg-type]


def explaining(limits: Thresholds) -> Any:
    """Whether a constant is said to explain most of a constant force and a wave over the position."""
    equations = known(limits, lambda x: 0.3 + 0.3 * np.sin(5.0 * x))
    trial = law(equations, np.ones_like)
    system = System(equations, with_columns(equations, trial))
    return explained(Selection([Cause(trial, 0.0, 0.0, 0.0)], system, []), {})[0].passed


def completed(limits: Thresholds) -> Any:
    """Whether the first terms of a series explain most of friction that has a wave over the position."""
    equations = real(limits)
    rows = []
    for r in equations.rows:
        q, dq = (r.prepared.picked(x)[:, 0] for x in (r.prepared.q, r.prepared.dq))
        force = 0.2 * np.sign(dq) * np.sin(6.0 * q + 1.0)
        rows.append(replace(r, effort=r.effort + np.column_stack([force, 0.0 * force])))
    equations = equations.with_rows(rows)
    place = "position_dependent_friction", 1
    candidate = next(c for c in candidates(equations) if c.place == place)
    trial = Search(System(equations)).trial(candidate)
    assert trial is not None
    system = System(equations, with_columns(equations, trial))
    selection = Selection([Cause(trial, trial.gain.delta_bic, 0.0, 0.0)], system, [])
    return explained(selection, further_terms(selection))[0].passed


def stepped(limits: Thresholds) -> Any:
    """Counts of positions that step by one count, now and then by two, and one time in ten by 3.3."""
    steps = np.where(np.arange(400) % 10 == 0, 3.3, np.where(np.arange(400) % 7 == 0, 1.3, 1.0))
    q = np.cumsum(steps)[:, None] * np.ones(2)
    one = replace(logs()[0].part(0, 400), q=q, motor=q, motor_side=(False, False))
    return counts(one, limits.equations).tolist()


def rounding(limits: Thresholds) -> Any:
    noisy = logs()[0].q + 1e-3 * default_rng(1).normal(size=logs()[0].q.shape)
    return rounded(coarse(replace(logs()[0], q=noisy)), limits.equations).tolist()


def of_links(limits: Thresholds) -> Any:
    link = Inertial(3.0, (0.2, 0.0, 0.0), (0.01, 0.0, 0.0, 0.2, 0.0, 0.2))
    prior = told(_model(link), limits.equations)
    assert prior is not None
    return prior.rows.tolist(), prior.least


@cache
def _model(link: Inertial) -> Any:
    return build_model(replace(ARM, links=(link, link)))


def swinging(limits: Thresholds) -> Any:
    """Settings of free motions whose positions have noise."""
    random = default_rng(2)
    free = [
        replace(r, q=r.q + 1e-7 * random.normal(size=r.q.shape), input=None, motor_side=(False, False))
        for r in logs()
    ]
    found = settings_for(free, None, limits)
    return found.cutoff, found.position_cutoff, found.rest_gate


def banded(limits: Thresholds) -> Any:
    """Cut-offs of the bands that are asked with coarse encoders."""
    study = study_of(ARM, logs(fine=False), Options(thresholds=limits))
    return [round(b.chosen.cutoff or 0.0, 6) for b in bands(study)]


def noise_of_size(limits: Thresholds) -> Any:
    return independent(np.convolve(default_rng(1).normal(size=400), np.ones(20), "valid"), limits.evidence)


def correlated(limits: Thresholds) -> Any:
    found = endogeneity(System(known(limits)))
    return found and found.threshold


def two_arms(limits: Thresholds) -> Any:
    """Whether records are refused, the second with much noise, as of two arms."""
    first, second = real(limits).rows
    noise = second.effort.std(axis=0) * default_rng(1).normal(size=second.effort.shape)
    pair = real(limits).with_rows([first, replace(second, effort=second.effort + noise)])
    return refusal(lambda: check_one_arm(replace(band(), equations=pair)))


def cooled(limits: Thresholds) -> Any:
    names = ("a.csv", "b.csv@3:9")
    records = [SimpleNamespace(record=SimpleNamespace(name=n), before=None) for n in names]
    rows = [SimpleNamespace(prepared=p) for p in records]
    return cold(SimpleNamespace(thresholds=limits, rows=rows))  # type: ignore[arg-type]


def asked_for(limits: Thresholds) -> Any:
    equations = real(limits)
    pool = candidates(equations)
    return refusal(lambda: len(asked(pool, [("stribeck_friction", 1)], replace(band(), equations=equations))))


def rippled(limits: Thresholds) -> Any:
    position = np.linspace(0.0, 30.0, 600) + np.sin(np.linspace(0.0, 40.0, 600))
    speed = 0.05 + np.abs(np.cos(np.linspace(0.0, 40.0, 600)))
    return waves(np.sin(2.0 * position), position, speed, 0.3, limits.candidates)


def soft(limits: Thresholds) -> Any:
    """Whether an elastic joint is sensible of which six tenths were found."""
    trial = valued(50.0, "joint_flexibility", stiffness=1e4, relaxation=1e-3)
    trial = replace(trial, gain=SimpleNamespace(values=np.array([0.6]), delta_bic=50.0, rank=1))
    return sensible(trial, real(limits))


def gap_or_spring(limits: Thresholds) -> Any:
    """Which of the two laws of a compliant joint is taken."""
    spring = (valued(100.0, "joint_flexibility", stiffness=1e4), Judgement(10.0, 10.0, ""))
    gap = (valued(105.0, "backlash", play=1e-3), Judgement(11.0, 11.0, ""))
    return member(gap, [gap, spring], limits)[0].candidate.effect


def judged(
    limits: Thresholds, sizes: tuple[float, float] = (1.0, 1.0), effect: str = "friction_offset"
) -> Any:
    """Verdict on a cause of these sizes in two records that hardly tell it from forty other unknowns."""
    random = default_rng([13, 3])
    mixing = random.normal(size=(2, 40, 1)) / np.sqrt(40)
    rows, columns = [], []
    for size, mix in zip(sizes, mixing, strict=True):
        slow = random.normal(size=(300, 40))
        own = slow @ mix + 0.35 * random.normal(size=(300, 1))
        effort = slow @ np.ones((40, 1)) + size * own + random.normal(size=(300, 1))
        rows.append(Rows(UNUSED, effort, slow[:, None, :], np.ones((300, 1), dtype=bool), BARE))
        columns.append(own[:, None, :])
    system = System(replace(equations_of(rows, [100, 100]), thresholds=limits))
    gain = system.gain(columns)
    assert gain is not None
    trial = FittedCandidate(Candidate(effect, 1), {}, columns, gain)
    return Conditions(system, []).judged(trial).refused


def least_gain(
    limits: Thresholds, effect: str, *before: str, delta_bic: float = 8.0, repeat: bool = True
) -> Any:
    """Percent that a cause must gain beside others."""
    gates = Conditions(System(known(limits, repeat=repeat)), [])
    gates.before = [valued(50.0, name) for name in before]
    return gates._least(valued(delta_bic, effect))


def formed(limits: Thresholds, effect: str) -> Any:
    """Percent that a cause must exceed beside this one, whose form leaves some."""
    equations = known(limits)
    trial = law(equations, lambda x: np.ones(len(x)), effect)
    tables = with_columns(equations, trial)
    other = Candidate("presliding" if effect == "stribeck_friction" else "spring", 1)
    return Conditions(System(equations, tables), [trial]).forms.least(other).tolist()


def evident(limits: Thresholds, effect: str = "friction_offset", rank: int = 2) -> Any:
    return least_evidence(valued(9.0, effect, rank=rank), known(limits))


def ambiguous(limits: Thresholds) -> Any:
    """Rivals that are kept beside the cause."""
    equations = known(limits)
    cause = law(equations, lambda x: np.ones(len(x)))
    rival = law(equations, lambda x: 1.0 + 0.3 * np.sin(x), "asymmetric_viscous_friction")
    tables = with_columns(equations, cause)
    rivals = [(rival, 5.0)]
    return [
        len(c.rivals)
        for c in ambiguity_set([Cause(cause, 30.0, 5.0, 5.0, rivals)], System(equations, tables))
    ]


def faint(limits: Thresholds) -> Any:
    equations = known(limits)
    best, other = (
        law(equations, lambda x: np.ones(len(x))),
        law(equations, np.tanh, "asymmetric_viscous_friction"),
    )
    gates = SimpleNamespace(equations=equations, judged=lambda _: Judgement(5.0, 5.0, ""))
    return len(lesser_rivals(best, [replace(other, gain=best.gain)], gates))  # type: ignore[arg-type]


def repeats(limits: Thresholds) -> Any:
    """Tests of lack of fit."""
    system = System(known(limits))
    fit = lack_of_fit(system)
    return fit and (fit.statistic, fit.threshold, fit.by_joint.tolist(), len(fit.tests))


def bending(limits: Thresholds) -> Any:
    """How many functions each of the first ones is made of."""
    found = islice(smooth_functions(System(real(limits))), 3)
    return [{j: x[0].shape for j, x in s.columns.items()} for s in found]


def counted(limits: Thresholds) -> Any:
    """Whether encoder counts explain what is left, a little more than they leave."""
    equations = real(limits, fine=False)
    return _counted(equations, 1.2 * equations.blur)


def planned(limits: Thresholds, period: int | None = None) -> Any:
    s = setup(ARM, real(limits), band().base)
    found = s.settings(period)
    return found.period, found.harmonics, s.coarse.every


def bench(limits: Thresholds) -> Any:
    return [(text, q.tolist()) for text, q in _motions(setup(ARM, real(limits), band().base), 0)]


def interval(limits: Thresholds) -> Any:
    before = default_rng(1).normal(size=500)
    return compared(before, 0.8 * before + 0.1 * default_rng(2).normal(size=500), limits.extended)


CASES: dict[str, tuple[Value, Seen]] = {
    "equations.max_cutoff": (10.0, lambda t: settings_for(logs(), None, t).cutoff),
    "equations.max_free_cutoff": (5.0, swinging),
    "equations.samples_per_cutoff_period": (100.0, lambda t: settings_for(logs(), None, t).cutoff),
    "equations.narrow_cutoff_over_bandwidth": (7.0, banded),
    "equations.min_moving_share": (0.2, lambda t: still(t, 0.1)),
    "equations.min_equations_per_unknown": (50.0, lambda t: still(t, 0.1)),
    "equations.max_condition_number": (1.0, lambda t: refusal(lambda: check_excitation(real(t)))),
    "equations.max_unseparated_share": (-0.1, lambda t: refusal(lambda: check_excitation(real(t)))),
    "equations.max_unexplained_effort": (0.0, lambda t: refusal(lambda: check_efforts(real(t)))),
    "equations.max_turned_share": (1e9, lambda t: refusal(lambda: check_efforts(real(t)))),
    "equations.max_driving_friction": (-1.0, lambda t: refusal(lambda: check_efforts(real(t)))),
    "equations.min_position_steps": (100_000, lambda t: counts(coarse(logs()[0]), t.equations).tolist()),
    "equations.near_step_ratio": (
        1.2,
        lambda t: stepped(t.with_values({"equations.max_count_deviation": 0.5})),
    ),
    "equations.small_step_counts": (
        1.2,
        lambda t: stepped(t.with_values({"equations.max_count_deviation": 0.2})),
    ),
    "equations.whole_steps_share": (0.5, stepped),
    "equations.max_count_deviation": (0.5, stepped),
    "equations.max_rounding_error": (50.0, rounding),
    "equations.max_repeated_difference": (0.0, lambda t: repeating_errors(real(t, fine=False)).tolist()),
    "equations.nominal_scatter": (0.1, of_links),
    "equations.min_nominal_weight": (9.0, of_links),
    "equations.rest_noise_deviations": (3e5, swinging),
    "equations.max_position_cutoff": (0.1, swinging),
    "equations.position_cutoff_ratios": ((5.0, 3.0), swinging),
    "equations.max_noise_over_rest_speed": (1e-9, swinging),
    "equations.lost_band_percent": (99.9, banded),
    "evidence.whitening_order": (6, lambda t: System(known(t)).white.counts.tolist()),
    "evidence.min_rows_per_lag": (100, lambda t: still(t, 1.0)),
    "evidence.min_fitted_rows_per_lag": (
        1000,
        lambda t: whitener(
            [default_rng(1).normal(size=500)], [np.ones(500, dtype=bool)], t.evidence
        ).taps.tolist(),
    ),
    "evidence.max_lag_share": (0.02, noise_of_size),
    "evidence.autocorrelation_lags": (5, noise_of_size),
    "evidence.min_noise_rows": (100_000, lambda t: System(known(t)).coloured),
    "evidence.unknown_noise_price": (3.0, lambda t: System(known(t, repeat=False)).price),
    "evidence.min_equations_per_instrument": (1e6, correlated),
    "evidence.endogeneity_significance": (0.1, correlated),
    "candidates.max_record_disagreement": (0.01, two_arms),
    "candidates.min_record_disagreement": (
        1e6,
        lambda t: two_arms(t.with_values({"candidates.max_record_disagreement": 0.01})),
    ),
    "candidates.min_own_share": (2.0, asked_for),
    "candidates.max_log_begin": (5.0, cooled),
    "candidates.scanned_waves": (2, rippled),
    "candidates.min_wave_rows": (1000, rippled),
    "candidates.slow_rows_share": (0.9, rippled),
    "candidates.compliant_share": ((0.7, 2.0), soft),
    "candidates.certain_delta_bic": (1.0, gap_or_spring),
    "validation.min_gain_percent": (2.0, lambda t: least_gain(t, "friction_offset", delta_bic=50.0)),
    "validation.faint_gain_percent": (9.0, lambda t: least_gain(t, "friction_offset")),
    "validation.faint_delta_bic": ((1.0, 2.0), lambda t: least_gain(t, "friction_offset")),
    "validation.gain_beside_delay_percent": (
        9.0,
        lambda t: least_gain(t, "stribeck_friction", "time_delay"),
    ),
    "validation.gain_at_reversals_percent": (
        9.0,
        lambda t: least_gain(t, "stribeck_friction", "presliding"),
    ),
    "validation.min_agreement": (-1.0, lambda t: judged(t, (1.5, -0.5))),
    "validation.form_error": (0.3, lambda t: formed(t, "stribeck_friction")),
    "validation.elastic_form_error": (0.3, lambda t: formed(t, "joint_flexibility")),
    "selection.min_delta_bic": (7.0, evident),
    "selection.single_parameter_delta_bic": (7.0, lambda t: evident(t, rank=1)),
    "selection.fading_delta_bic": (7.0, lambda t: evident(t, "friction_warm_up")),
    "selection.unknown_noise_delta_bic": (7.0, lambda t: threshold(System(known(t, repeat=False)))),
    "selection.rival_margin_bic": (
        7.0,
        lambda t: needed_behind(valued(90.0), valued(80.0, "stribeck_friction"), t.selection),
    ),
    "selection.rival_margin_of_evidence": (
        0.3,
        lambda t: needed_behind(valued(900.0, "backlash"), valued(80.0, "joint_flexibility"), t.selection),
    ),
    "selection.max_rival_share": (-1e6, ambiguous),
    "selection.min_gap_gain_ratio": (1.01, gap_or_spring),
    "adequacy.lack_of_fit_significance": (0.1, repeats),
    "adequacy.parts_of_period": (8, repeats),
    "adequacy.min_part_rows": (1e6, repeats),
    "adequacy.min_phase_rows": (1e6, repeats),
    "adequacy.min_scatter_rows": (1e6, repeats),
    "adequacy.null_share": (0.9, lambda t: like_delta_bic(t.adequacy)),
    "adequacy.min_explained_share": (0.3, explaining),
    "adequacy.usual_null_share": (1.0, explaining),
    "adequacy.max_further_terms_share": (2.0, completed),
    "adequacy.max_counts_ratio": (1.0, counted),
    "adequacy.bend_lengths": ((0.3, 0.6), bending),
    "adequacy.spot_length": (0.3, bending),
    "experiment.usual_period": (5.0, planned),
    "experiment.period_range": ((4.0, 6.0), planned),
    "experiment.harmonics": (3, planned),
    "experiment.min_samples_per_row": (1, planned),
    "experiment.bench_duration": (10.0, bench),
    "experiment.bench_speeds": ((0.1, 0.5), bench),
    "experiment.bench_range_share": (0.5, bench),
    "experiment.reversal_amplitude": (0.1, bench),
    "experiment.reversal_speed": (0.1, bench),
    "experiment.other_values": (
        (0.5,),
        lambda t: len(hypothesis(valued(9.0, "stribeck_friction", velocity=8.0), t.experiment).others),
    ),
    "extended.bootstrap_blocks": (40, interval),
    "extended.interval_quantiles": ((0.1, 0.9), interval),
    **DECISIONS,
}


@pytest.mark.parametrize("name", list(CASES))
def test_a_threshold_of_the_diagnosis_acts(name: str) -> None:
    other, seen = CASES[name]
    usual = seen(USUAL)
    assert seen(USUAL) == usual
    assert seen(USUAL.with_values({name: other})) != usual


def test_every_threshold_of_the_diagnosis_has_a_case() -> None:
    assert set(CASES) == {e.name for e in USUAL.entries() if not e.name.startswith("dataset.")}
