"""Many short windows at once move as one simulation does that locates every stop and every start."""

from types import SimpleNamespace

import numpy as np
import pytest

from modelgen.description import Arm, EffectUse, Inertial, Joint
from modelgen.functions import build_model
from modelgen.simulation import plant, simulate
from modelgen.simulation.windows import simulated_windows

RATE, LENGTH = 500.0, 125
DRY = EffectUse("coulomb_friction", {"magnitude": 1.5})
VISCOUS = EffectUse("viscous_friction", {"coefficient": 0.4})
DRIVE = EffectUse("drive_inertia", {"inertia": 0.02})
ELASTIC = EffectUse("joint_flexibility", {"stiffness": 300.0, "damping": 0.5})
PLAY = EffectUse("backlash", {"play": 0.01, "stiffness": 3000.0, "damping": 5.0})
ROD = Inertial(1.5, (0.2, 0.0, 0.0), (0.001, 0.0, 0.0, 0.03, 0.0, 0.03))
SECOND = Joint("elbow", "revolute", d=0.4, antecedent=0, effects=(DRIVE, DRY, VISCOUS))


def _arm(*effects: EffectUse) -> Arm:
    """Two rods that swing about level axes. effects: at the first joint, beside friction."""
    first = Joint("shoulder", "revolute", effects=(DRIVE, DRY, VISCOUS, *effects))
    return Arm("two", (first, SECOND), (ROD, ROD), gravity=(9.81, 0.0, 0.0))


@pytest.mark.parametrize("effects", [(), (ELASTIC,), (PLAY,)], ids=["rigid", "elastic", "play"])
def test_joints_that_stop_and_start_do_so_in_windows(effects: tuple[EffectUse, ...]) -> None:
    """A drive that dithers about rest is let loose by its own steps, and its joint leaves too early."""
    arm = _arm(*effects)
    made = plant(arm)
    t = np.arange(round(8.0 * RATE)) / RATE
    force = np.stack([3.5 * np.sin(1.9 * t), 2.6 * np.sin(2.7 * t)], axis=1)
    truth = simulate(made, [0.0, 0.0], [0.0, 0.0], t[-1], RATE, force, method="fixed", step=2e-5)
    still = truth.dq == 0.0
    turns = still[1:] & ~still[:-1]
    assert (turns.sum(axis=0) >= 4).all()
    assert still[:, 0].mean() > 0.1
    record = SimpleNamespace(step=1.0 / RATE)
    p = SimpleNamespace(record=record, q=truth.q, dq=truth.dq, input=truth.input, time=truth.t)
    starts = np.arange(0, len(t) - LENGTH, LENGTH)
    found = simulated_windows(build_model(arm), made.base, truth.states, p, starts, LENGTH)
    assert found is not None
    assert len(found.t) == len(starts)
    moved = np.std(found.measured - found.measured[:, :1], axis=(0, 1))
    assert (found.rmse < 0.02 * moved).all()
