"""Parameters of links that could exist, where plain least squares gives such that could not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from arms_support import ARMS
from identification_support import RATE, bare, tapering
from witness.bodies import Body, random_bodies
from witness.geometry import moving
from witness.rigid_bodies import RigidBodies

from modelgen.dataset import Record, prepare
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions.nominal import base_matrix
from modelgen.identification import identify
from modelgen.identification.bodies import plain, violations


def record(arm: Arm, bodies: list[Body], noise: float, seed: int) -> Record:
    """Efforts of Pinocchio's links along a motion of several frequencies; noise as a part of their RMS."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(10 * RATE)) / RATE
    n = len(moving(arm))
    q = np.zeros((len(t), n))
    dq, ddq = np.zeros_like(q), np.zeros_like(q)
    for k in range(1, 5):
        a, b = rng.uniform(-0.4, 0.4, (2, n))
        w = 2 * np.pi * 0.2 * k
        s, c = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q += a * s + b * c
        dq += w * (a * c - b * s)
        ddq += w * w * (-a * s - b * c)
    links = RigidBodies(arm, bodies)
    effort = np.array([links.effort(*x) for x in zip(q, dq, ddq, strict=True)])
    effort += noise * np.sqrt(np.mean(effort**2, axis=0)) * rng.normal(size=effort.shape)
    ones = np.ones_like(effort)
    return Record("simulated", t, q, q, input=effort, gain=ones, effort_unit=("N m",) * n, arm=arm)


@pytest.mark.parametrize("seed", [1, 2])
def test_with_thirty_percent_noise_links_stay_possible(seed: int) -> None:
    bodies = tapering(100 + seed)
    arm = bare("rx90", bodies)
    prepared = prepare(record(arm, bodies, 0.3, seed).part(0, 800))
    least = identify([prepared], arm)
    found = identify([prepared], arm, physical=True)
    assert found.consistent is not None
    wrong = violations(found.model, plain(found.model, least.solution.theta))
    assert any("mass -" in text for text in wrong)  # negative masses
    assert wrong == found.consistent.violated
    standard = found.consistent.standard
    for i in range(len(arm.joints)):
        xx, xy, xz, yy, yz, zz, mx, my, mz, m = standard[10 * i : 10 * i + 10]
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        com = np.array([mx, my, mz]) / m
        central = tensor - m * (com @ com * np.eye(3) - np.outer(com, com))
        moments = np.linalg.eigvalsh(central)
        assert m > 0
        assert moments[0] > 0
        assert moments[0] + moments[1] > moments[2] * (1 - 1e-9)
    # The data are still heeded: less than two standard deviations away from them on average.
    assert found.consistent.distance < 4
    truth = base_matrix(found.model) @ np.concatenate([b.ten for b in bodies])
    estimate = np.array([e.value for e in found.estimates])
    size = np.sqrt(np.diag(least.solution.covariance))
    plain_error = np.linalg.norm((least.solution.theta - truth) / size)
    assert np.linalg.norm((estimate - truth) / size) < plain_error


def test_without_noise_the_truth_is_consistent_already() -> None:
    bodies = random_bodies(ARMS["rx90"], np.random.default_rng(5))
    arm = bare("rx90", bodies)
    found = identify([prepare(record(arm, bodies, 0.001, 5))], arm, physical=True)
    assert found.consistent is not None
    assert found.consistent.distance < 0.5
    truth = base_matrix(found.model) @ np.concatenate([b.ten for b in bodies])
    estimate = np.array([e.value for e in found.estimates])
    np.testing.assert_allclose(estimate, truth, atol=0.02 * np.abs(truth).max())


def test_a_fluid_is_refused() -> None:
    bodies = random_bodies(ARMS["rx90"], np.random.default_rng(5))
    arm = bare("rx90", bodies)
    wet = replace(arm, fluid_density=1000.0)
    with pytest.raises(InputError, match="buoyancy"):
        identify([prepare(record(arm, bodies, 0.01, 5))], wet, physical=True)
