"""What an identification says of the errors that it left, for the watch on the arm."""

from dataclasses import replace

import numpy as np
import pytest
from arms_support import ARMS
from scipy.signal import butter, sosfiltfilt

import modelgen as mg
from modelgen.dataset import prepare
from modelgen.evaluation import Evaluator
from modelgen.functions import EVALUATED, build_model
from modelgen.identification.instrumental import Comparison
from modelgen.identification.noise import gain_of, outside
from modelgen.identification.summary import biased
from modelgen.identification.validation import held_against, validate

STEP = 0.005


def table(rng: np.random.Generator, seconds: float, noise: float) -> dict[str, np.ndarray]:
    """A log of two pendulums: sines, and inputs of their inverse dynamics with noise."""
    model = mg.build_model(ARMS["gravity_arm"])
    nominal = model.nominal
    assert nominal is not None
    t = np.arange(0.0, seconds, STEP)
    phase, speed = rng.uniform(0, 6, (2, 2)), np.array([[0.5, 0.9], [0.7, 1.1]])
    q, dq, ddq = np.zeros((3, len(t), 2))
    for k in range(2):
        angle = speed[k] * t[:, None] + phase[k]
        q += 0.5 * np.sin(angle)
        dq += 0.5 * speed[k] * np.cos(angle)
        ddq -= 0.5 * speed[k] ** 2 * np.sin(angle)
    effort = model.functions["inverse_dynamics"](q, dq, ddq, np.array(list(nominal.values())))
    effort += noise * rng.standard_normal(effort.shape)
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "tau1": effort[:, 0], "tau2": effort[:, 1]}


def test_the_observer_along_a_record_is_the_function_step_by_step() -> None:
    rng = np.random.default_rng(1)
    arm = ARMS["gravity_arm"]
    record = prepare(mg.read_log(table(rng, 20.0, 0.05), arm))
    model = build_model(arm, EVALUATED)
    theta = rng.uniform(0.5, 1.0, len(model.grouping.base))
    (found,) = outside(model, [record], theta) or []
    gain = gain_of([record])
    step = mg.build_model(arm).functions["momentum_observer_step"]
    mass = mg.build_model(arm).functions["mass_matrix"]
    first = int(record.rows[0])
    state, expected = mass(record.q[first], theta) @ record.dq[first], [np.zeros(2)] * first
    assert record.input is not None
    for q, dq, current in list(zip(record.q, record.dq, record.input, strict=True))[first:]:
        state, external = step(q, dq, current, [STEP], np.full(2, gain), theta, state)
        expected.append(external)
    last = int(record.rows[-1]) + 1
    np.testing.assert_allclose(found, expected[last - len(found) : last], rtol=1e-6, atol=1e-9)


def test_noise_of_the_inputs_is_found() -> None:
    """Deviation, correlation of what the filters leave, and what the observer makes of it: a low pass."""
    rng = np.random.default_rng(2)
    arm, noise = ARMS["gravity_arm"], 0.2
    data = mg.identify(arm, table(rng, 120.0, noise), table(rng, 60.0, noise), cutoff=8.0).to_json()["noise"]
    observer = data["observer"]
    assert observer["gain"] == pytest.approx(2 * np.pi * 8.0 / 3, rel=1e-9)
    low_passed = noise * np.sqrt(observer["gain"] * STEP / 2)
    np.testing.assert_allclose(observer["rms"], low_passed, rtol=0.2)
    assert (np.array(observer["largest"]) > 2.5 * np.array(observer["rms"])).all()
    assert (np.array(data["input"]) < noise).all()  # filtered
    assert all(0.01 < time < 0.2 for time in data["correlation_s"])


def test_what_differs_between_periods_is_the_noise_of_the_test_record() -> None:
    """White noise through the filter of the efforts, whatever else the model lacks; nothing where no motion
    repeats.
    """
    rng, arm, noise, cutoff = np.random.default_rng(5), ARMS["gravity_arm"], 0.05, 8.0
    model = mg.build_model(arm)
    nominal = model.nominal
    assert nominal is not None

    def log(begin: float, periods: int) -> dict[str, np.ndarray]:
        t = np.arange(0.0, 10.0 * periods, STEP)
        w = 2.0 * np.pi / 10.0 * np.array([[2.0, 3.0], [3.0, 5.0]])
        angle = w[:, None, :] * t[:, None] + begin
        q, dq, ddq = (x.sum(axis=0) for x in (np.sin(angle), w[:, None, :] * np.cos(angle),
                                              -w[:, None, :] ** 2 * np.sin(angle)))  # fmt: skip
        effort = model.functions["inverse_dynamics"](q, dq, ddq, np.array(list(nominal.values())))
        effort += 0.5 * np.sin(2.0 * q) + noise * rng.standard_normal(effort.shape)
        return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "tau1": effort[:, 0], "tau2": effort[:, 1]}

    found = mg.identify(arm, log(0.0, 3), log(1.0, 3), cutoff=cutoff)
    test = found.to_json()["test"]
    white = sosfiltfilt(butter(4, cutoff * 2 * STEP, output="sos"), rng.standard_normal(200_000))
    np.testing.assert_allclose(test["noise_rmse"], noise * np.std(white), rtol=0.15)
    assert min(test["rmse"]) > 3.0 * max(test["noise_rmse"])
    assert "noise, between periods" in found.files()["report.html"]
    once = mg.identify(arm, log(0.0, 3), log(1.0, 1), cutoff=cutoff)
    assert "noise_rmse" not in once.to_json()["test"]
    assert "do not show how much of it is noise" in once.files()["report.html"]


def test_an_estimate_that_predicts_far_worse_is_weak_and_one_worse_than_none_impossible() -> None:
    """Least squares on a record that moves every joint, beside the same with one parameter three times as
    large; and a test record of which every effort has the other sign.
    """
    rng, arm = np.random.default_rng(6), ARMS["gravity_arm"]
    train, test = table(rng, 60.0, 0.02), table(rng, 40.0, 0.02)
    outcome = mg.identify(arm, train, test, cutoff=8.0).outcome
    found, held = outcome.found, [prepare(mg.read_log(test, arm), outcome.chosen)]
    evaluator, solution = Evaluator(arm), found.solution
    found = replace(found, test=validate(evaluator, found.model, held, solution.theta))
    for factor, weak in ((1.0, False), (3.0, True)):
        theta = solution.theta.copy()
        theta[int(np.argmax(np.abs(theta)))] *= factor
        beside = Comparison(replace(solution, theta=theta), 99.0, 3, 9.0)
        judged = held_against(replace(found, comparison=beside), held, evaluator)
        assert judged.comparison is not None
        assert judged.comparison.weak == weak
        assert biased(replace(found, comparison=beside)) == weak  # by what the parameter moves
        assert not biased(judged)
    other = test | {"tau1": -test["tau1"], "tau2": -test["tau2"]}
    wrong = mg.identify(arm, train, other, cutoff=8.0)
    assert "more than that of no model at all" in " ".join(wrong.to_json()["doubts"])
    assert "no code should be generated" in wrong.files()["report.html"]
