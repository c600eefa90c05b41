"""Elastic joints and play behind a link's own encoder: what they add, and that they are named."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from arms_support import base_vector, standard_vector
from hidden.cases import Case, Hidden, make
from hidden.judging import FOUND
from hidden.running import run_here
from scipy.optimize import brentq

from modelgen.description import Arm, DirectDrive, EffectUse, Joint, load
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose, records
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import build_model

RATIO, CONSTANT = 100.0, 0.05
EFFECTS = tuple(EffectUse(n) for n in ("viscous_friction", "drive_inertia"))
ARM = Arm(
    "two",
    (
        Joint("j1", "revolute", alpha=np.pi / 2, drive=DirectDrive(80.0, 0.05), effects=EFFECTS),
        Joint("j2", "revolute", d=0.4, antecedent=0, drive=DirectDrive(RATIO, CONSTANT), effects=EFFECTS),
    ),
    (None, None),
    (0.0, 0.0, -9.81),
)
WAVES = ((0.2, 1, 0.0), (0.1, 2, 0.9), (0.05, 3, 2.0))  # amplitude [rad], harmonic, phase


def test_the_drive_of_an_elastic_joint_leads_by_what_moves_the_link() -> None:
    model, evaluator = build_model(ARM), Evaluator(ARM)
    standard = standard_vector(model, np.random.default_rng(3))
    base = base_vector(model, standard)
    values = dict(zip((p.name for p in model.standard), standard, strict=True))
    t = np.arange(0.0, 8.0, 0.002)
    w, size, stiffness, relaxation = 2 * np.pi * 1.0, 0.2, 300.0, 0.01
    q = np.column_stack([np.zeros_like(t), size * np.sin(w * t)])
    dq = np.column_stack([np.zeros_like(t), size * w * np.cos(w * t)])
    ddq = -(w**2) * q
    motion = Motion(t, q, dq, ddq, (False, False), 18.0)
    found = evaluator.contribution(
        "joint_flexibility", 2, motion, {"stiffness": stiffness, "damping": relaxation * stiffness}, base
    )
    # a pendulum in the vertical plane of joint 2: inertia about its axis, first moments, gravity along x
    effort = values["ZZ2"] * ddq[:, 1]
    lift = 9.81 * (values["MX2"] * np.cos(q[:, 1]) - values["MY2"] * np.sin(q[:, 1]))
    effort += lift if abs(lift[0] - weight(evaluator, motion, base)) < 1e-6 else -lift
    # the spring and the damper: relaxation * rate + lead = effort / stiffness, period by period
    spectrum = np.fft.rfft(effort[:4000]) / stiffness
    s = 2j * np.pi * np.fft.rfftfreq(4000, 0.002)
    lead = spectrum / (1 + relaxation * s)
    rate, acceleration = (np.fft.irfft(lead * s**k, 4000) for k in (1, 2))
    wanted = RATIO**2 * (values["IA2"] * acceleration + values["FV2"] * rate) / (RATIO * CONSTANT)
    middle = slice(1000, 3000)
    assert np.abs(found[middle, 0]).max() == 0.0
    assert found[middle, 1] == pytest.approx(wanted[middle], abs=0.03 * np.abs(wanted).max())


def weight(evaluator: Evaluator, motion: Motion, base: np.ndarray) -> float:
    """Effort at joint 2 that holds the arm where the motion begins."""
    still = np.zeros((2, 2))
    held = evaluator.inputs(Motion(motion.t[:2], motion.q[:2], still, still), base)
    return float(held[0, 1]) * RATIO * CONSTANT


@pytest.mark.parametrize("stiffness", [300.0, 450.0, 700.0, 1500.0])
def test_dry_friction_turns_when_the_drive_does_by_fractions_of_a_sample(stiffness: float) -> None:
    """The drive, ahead of the link by inertia times acceleration over stiffness, turns back earlier or later
    than the link: dry friction has changed by twice its size for that long, to a part of a sample.
    """
    rubbing = (*EFFECTS, EffectUse("coulomb_friction"))
    arm = replace(
        ARM, joints=(ARM.joints[0], replace(ARM.joints[1], effects=rubbing)), gravity=(0.0, 0.0, 0.0)
    )
    model, evaluator = build_model(arm), Evaluator(arm)
    step, w = 0.01, 2 * np.pi * 0.5
    t = np.arange(0.0, 12.0, step)

    def moved(order: int, at: np.ndarray = t) -> np.ndarray:
        sines = (
            size * (k * w) ** order * np.sin(k * w * at + phase + order * np.pi / 2)
            for size, k, phase in WAVES
        )
        return np.sum(list(sines), axis=0)

    still = np.zeros_like(t)
    motion = Motion(t, *(np.column_stack([still, moved(order)]) for order in (0, 1, 2)), (False, False), 20.0)
    standard = standard_vector(model, np.random.default_rng(3))
    names = [p.name for p in model.standard]
    values = {"stiffness": stiffness, "damping": 0.0}
    size, found = 4.0, []
    for friction in (0.0, size):
        standard[names.index("FC2")] = friction
        found.append(
            evaluator.contribution("joint_flexibility", 2, motion, values, base_vector(model, standard))
        )
    added = (found[1] - found[0])[:, 1]
    turns = np.flatnonzero(np.diff(np.sign(motion.dq[:, 1])))
    turns = turns[(turns > 200) & (turns < len(t) - 200)]
    assert len(turns) > 8
    inertia = standard[names.index("ZZ2")]
    for turn in turns:
        link, drive = (
            brentq(lambda at, lag=lag: moved(1, at) + lag * moved(3, at), t[turn - 3], t[turn + 4])
            for lag in (0.0, inertia / stiffness)
        )
        acceleration = moved(2, np.array(link))
        change = 2 * size / CONSTANT * np.sign(acceleration)  # of the current, where the drive turns
        near = slice(turn - 6, turn + 8)
        assert -added[near].sum() / change == pytest.approx((drive - link) / step, abs=1 / 24)


def test_play_is_asked_for_where_the_link_is_loose_up_to_half_of_the_time() -> None:
    """A pendulum about its rest: the wider the gap, the longer the link lies in it."""
    model, evaluator = build_model(ARM), Evaluator(ARM)
    base = base_vector(model, standard_vector(model, np.random.default_rng(3)))
    t = np.arange(0.0, 16.0, 0.002)
    w = 2 * np.pi / 8.0
    q = np.column_stack([np.zeros_like(t), 2.0 * np.sin(w * t)])
    dq = np.column_stack([np.zeros_like(t), 2.0 * w * np.cos(w * t)])
    motion = Motion(t, q, dq, -(w**2) * q, (False, False), 18.0)
    shares = []
    for play in np.geomspace(1e-5, 10.0, 80):
        values = {"play": float(play), "stiffness": 300.0, "damping": 3.0}
        found = evaluator.contribution("backlash", 2, motion, values, base)
        shares.append(np.mean(found[:, 1] != 0.0))
    assert 0.35 < max(shares) <= 0.5
    assert shares[-1] == 0.0


@pytest.mark.parametrize(
    "case",
    [
        Case("direct2", 485685058, (Hidden("backlash", 1, 1.3, 1.2592284511),), "joint"),
        # at no stiffness of the scan is about as much found as was simulated
        Case("mixed4", 4020527152, (Hidden("joint_flexibility", 3, 1.3, 0.3),), "joint"),
    ],
    ids=lambda case: f"{case.arm}-{case.hidden[0].effect}",
)
def test_it_is_named_from_the_motion_of_the_link_alone(case: Case, tmp_path: Path) -> None:
    outcome, _ = run_here(case, tmp_path / "case")
    assert outcome.result == FOUND, outcome
    assert outcome.recovered is not None
    assert outcome.recovered > 0.5


@pytest.mark.parametrize(
    ("arm", "seed", "magnitude"), [("direct3", 1464809826, 0.7717), ("levered3", 656788973, 1.7315)]
)
def test_its_stiffness_is_found_with_the_arms_parameters(
    arm: str, seed: int, magnitude: float, tmp_path: Path
) -> None:
    """That of the plant, 400 N m/rad over the magnitude, within a tenth.

    At parameters that had taken over some of what it does it would be a fifth to two fifths too stiff.
    """
    hidden = Hidden("joint_flexibility", 3, 1.3, magnitude)
    label = make(Case(arm, seed, (hidden,), encoder="joint"), tmp_path)
    described = load(tmp_path / "arms.yaml")["arm"]
    logs = [str(tmp_path / f"{name}.csv") for name in ("train_a", "train_b", "test")]
    found = diagnose(described, records(described, logs[:2], logs[2:], None, USUAL.dataset), experiment=False)
    (cause,) = found.causes
    assert (cause.effect, cause.joint) == ("joint_flexibility", 3)
    assert cause.parameters["stiffness"].value == pytest.approx(400.0 / magnitude, rel=0.1)
    assert found.errors.after[2] < 1.1 * label.floor[2]
    assert found.errors.after[2] < 0.9 * found.errors.before[2]
