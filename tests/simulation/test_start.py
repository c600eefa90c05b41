"""The start of a free motion is found from noisy positions, and a wrong model does not move it far."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from modelgen.dataset import Record, prepare
from modelgen.description import Arm, EffectUse, Inertial, Joint
from modelgen.numeric import Array
from modelgen.simulation import plant, replay
from modelgen.simulation.start import nearest_start
from modelgen.simulation.windows import simulated_release

MASS, LENGTH, INERTIA, DAMPING = 1.5, 0.2, 0.03, 0.02
NOISE, RATE = 1e-3, 100.0


def _arm(damping: float) -> Arm:
    joint = Joint("shoulder", "revolute", effects=(EffectUse("viscous_friction", {"coefficient": damping}),))
    rod = Inertial(MASS, (LENGTH, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, INERTIA))
    return Arm("rod", (joint,), (rod,), gravity=(9.81, 0.0, 0.0))


def _swing(seed: int) -> Record:
    """A rod that is let go at 1.5 rad/s, by its own equation."""
    whole = INERTIA + MASS * LENGTH**2

    def rates(t: float, y: Array) -> list[float]:
        return [y[1], -(MASS * 9.81 * LENGTH * np.sin(y[0]) + DAMPING * y[1]) / whole]

    t = np.arange(600) / RATE
    q = solve_ivp(rates, (0.0, t[-1]), [0.6, 1.5], t_eval=t, rtol=1e-10, atol=1e-12).y[:1].T
    read = q + NOISE * np.random.default_rng(seed).normal(size=q.shape)
    return Record("swing", t, read, read, motor_side=(False,), arm=_arm(DAMPING))


@pytest.mark.parametrize("seed", range(4))
def test_a_right_model_leaves_the_noise_alone(seed: int) -> None:
    """Both ways of simulating a free motion; from a filter's speed several times as much is left."""
    record = _swing(seed)
    made, p = plant(record.arm), prepare(record)
    assert replay(made, p).scores.rmse[0] < 1.15 * NOISE
    unfitted = replay(made, p, start=(p.q[0], p.dq[0])).scores.rmse[0]
    assert unfitted > 2.0 * NOISE
    whole = simulated_release(made.model, made.base, None, replace(p, q=record.q), 0, 600)
    assert whole is not None
    assert whole.rmse[0] < 1.15 * NOISE


def test_a_wrong_model_begins_where_the_arm_was() -> None:
    """Three times the damping: its swing dies away, which no start may make up for."""
    record = _swing(0)
    wrong, p = plant(_arm(3.0 * DAMPING)), prepare(record)
    found = replay(wrong, p)
    ran = np.flatnonzero(np.isfinite(found.simulated[:, 0]))
    assert abs(found.simulated[ran[0], 0] - record.q[ran[0], 0]) < 0.06
    assert found.scores.f_gof[0] < 70.0


def test_two_joints_are_found_together() -> None:
    """Two coupled oscillators, in closed form: the start that made the motion, to the noise over root N."""
    t = np.arange(100) / RATE
    shapes, frequencies = np.array([[0.8, 0.6], [-0.6, 0.8]]), np.array([5.0, 11.0])

    def motions(q: Array, dq: Array, samples: int) -> Array:
        at = t[None, :samples, None] * frequencies
        modes = (q @ shapes.T)[:, None] * np.cos(at) + (dq @ shapes.T)[:, None] * np.sin(at) / frequencies
        return np.asarray(modes @ shapes)

    q, dq = np.array([0.3, -0.2]), np.array([1.0, 0.4])
    measured = motions(q[None], dq[None], 100)[0]
    found = nearest_start(motions, measured, 1 / RATE, q + 0.02, dq - 0.3)
    np.testing.assert_allclose(np.concatenate(found), np.concatenate([q, dq]), atol=1e-6)


def test_a_motion_that_does_not_run_keeps_its_start() -> None:
    q, dq = np.zeros(1), np.ones(1)
    found = nearest_start(
        lambda q, dq, samples: np.full((len(q), samples, 1), np.nan), np.ones((50, 1)), 0.01, q, dq
    )
    assert (found[0] == q).all()
    assert (found[1] == dq).all()
