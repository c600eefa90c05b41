"""Simulated motions against other people's mechanics, each other, and energy."""

from __future__ import annotations

import numpy as np
import pytest
from arms_support import ARMS, EVERY_ARM
from simulation_support import middle, pendulum, shipped, with_bodies
from witness.bodies import random_bodies
from witness.geometry import moving
from witness.levers import Drive
from witness.moving import trajectory
from witness.rigid_bodies import RigidBodies

from modelgen.backends import NumpyFunction
from modelgen.description import EffectUse
from modelgen.simulation import Plant, Trajectory, plant, simulate

group = {name: pytest.mark.xdist_group(name) for name in ARMS}
WITNESSED = [pytest.param(name, marks=group[name]) for name in ("ariane4", "ur10e", "wam7")]


@pytest.mark.parametrize("engine", ["pinocchio", "mujoco"])
@pytest.mark.parametrize("name", WITNESSED)
def test_ten_seconds_as_pinocchio_and_mujoco_move(name: str, engine: str) -> None:
    """Currents of several frequencies against rotors, viscous friction and gravity: one motion, 1e-7."""
    arm = ARMS[name]
    rng = np.random.default_rng(7)
    bodies = random_bodies(arm, rng)
    n = len(moving(arm))
    drives = [Drive(arm, i) for i in moving(arm)]
    probe = shipped(name)
    q0 = middle(probe)
    k1 = np.array([d.k1(q) for d, q in zip(drives, q0, strict=True)])
    # Rotors of the links' size, and friction that damps within a second: nothing grows chaotic.
    inertia = rng.uniform(0.5, 1.5, n) * 3.0 / k1**2
    viscous = rng.uniform(0.8, 1.2, n) * 60.0 / k1**2
    constant = np.array([d.constant for d in drives])
    phase = rng.uniform(0, 6, n)

    hold = RigidBodies(arm, bodies).effort(q0, 0 * q0, 0 * q0) / (k1 * constant)

    def current(t: float) -> np.ndarray:
        return hold + (8.0 if name == "ariane4" else 20.0) / (k1 * constant) * np.sin(
            2 * np.pi * np.linspace(0.3, 1.1, n) * t + phase
        )

    made = with_bodies(
        arm, bodies, {"IA": inertia, "FV": viscous, "FC": np.zeros(n), "KS": np.zeros(n), "FO": np.zeros(n)}
    )
    times = np.arange(1001) / 100
    currents = np.array([current(t) for t in times])
    theirs = trajectory(arm, bodies, {"inertia": inertia, "viscous": viscous}, q0, currents, times, engine)
    ours = simulate(made, q0, 0.0, 10.0, 100.0, currents, method="fixed", step=5e-4)
    assert not ours.ended
    assert np.ptp(theirs, axis=0).min() > 0.005
    np.testing.assert_allclose(ours.q, theirs, rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", EVERY_ARM)
def test_fixed_and_variable_steps_agree(name: str) -> None:
    """Compiled C and CasADi's functions, two integrators, two ways of finding where friction changes."""
    made = shipped(name)
    q0 = middle(made)
    ours = [
        simulate(
            made,
            q0,
            0.1,
            1.0,
            500.0,
            method=m,
            step=2.5e-4 if m == "fixed" else None,
            rtol=1e-11,
            atol=1e-12,
        )
        for m in ("fixed", "DOP853", "cvodes")
    ]
    length = min(len(x.t) for x in ours)
    assert length > 50
    for other, tolerance in ((ours[1], 1e-7), (ours[2], 1e-5)):
        np.testing.assert_allclose(ours[0].q[:length], other.q[:length], rtol=0, atol=tolerance)
    assert len({x.ended.split(" left")[0] for x in ours}) == 1


def energy(made: Plant, found: Trajectory) -> np.ndarray:
    function = NumpyFunction(next(f for f in made.model.functions if f.name == "energy"))
    kinetic, potential = function(found.q, found.dq, made.base)
    return np.asarray(kinetic[:, 0] + potential[:, 0])


@pytest.mark.parametrize("name", ["gravity_arm", "wam7"])
def test_energy_is_conserved_without_friction(name: str) -> None:
    arm = ARMS[name]
    made = plant(arm.without_effects())
    found = simulate(made, np.linspace(0.5, 1.0, made.n), 0.0, 3.0, 100.0)
    total = energy(made, found)
    moved = np.ptp(total - total[0] - _potential(made, found))
    assert moved > 1.0  # joules have changed their kind
    assert np.ptp(total) < 1e-7 * moved


def _potential(made: Plant, found: Trajectory) -> np.ndarray:
    function = NumpyFunction(next(f for f in made.model.functions if f.name == "energy"))
    return np.asarray(function(found.q, found.dq, made.base)[1][:, 0])


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=group[n]) for n in ("ariane4", "rx90", "scara", "two_fingers")]
)
@pytest.mark.parametrize("method", ["fixed", "DOP853"])
def test_friction_creates_no_energy(name: str, method: str) -> None:
    made = shipped(name)
    found = simulate(made, middle(made), 0.2, 1.0, 500.0, method=method)
    total = energy(made, found)
    scale = np.ptp(total)
    assert scale > 0
    assert np.diff(total).max() <= 1e-9 * scale


def test_a_payload_swings_as_a_heavier_pendulum() -> None:
    carried = plant(pendulum(mass=2.0), payload=[1.5, 0.4, 0.0, 0.0])
    heavy = plant(pendulum(mass=3.5))
    one, two = (simulate(p, 1.0, 0.0, 2.0, 100.0) for p in (carried, heavy))
    np.testing.assert_allclose(one.q, two.q, rtol=0, atol=1e-9)
    lighter = simulate(
        plant(pendulum(EffectUse("spring", {"stiffness": 1.0, "rest": 0.0}))), 1.0, 0.0, 2.0, 100.0
    )
    assert np.abs(lighter.q - one.q).max() > 0.01


def test_a_locked_joint_leaves_the_motion_of_the_rest() -> None:
    """gravity_link1_loaded is gravity_arm with its second joint held at 0."""
    held = plant(ARMS["gravity_arm"], lock={"j2": 0.0})
    loaded = plant(ARMS["gravity_link1_loaded"])
    one, two = (simulate(p, np.deg2rad(30), 0.0, 3.0, 100.0) for p in (held, loaded))
    np.testing.assert_allclose(one.q, two.q, rtol=0, atol=1e-9)
