"""The example of MPC: its description, its plant, and that what it plans is what happens."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpc_arm import ControlledArm, described, perturbed, smallest_eigenvalue
from mpc_horizon import Horizon, Solution
from mpc_loop import closed_loop, reference
from mpc_plant import Plant
from mpc_support import example

from modelgen.description import LeveredDrive

pytestmark = pytest.mark.xdist_group("mpc")

START = np.concatenate([reference(np.zeros(1))[0, :3], np.zeros(3)])


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> ControlledArm:
    return example(tmp_path_factory).arm


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return example(tmp_path_factory).library


@pytest.fixture(scope="module")
def horizon(arm: ControlledArm) -> Horizon:
    return Horizon(arm, "inverse", "fatrop")


def ahead(t: float) -> np.ndarray:
    return reference(t + 0.05 * np.arange(21))


def test_the_description_differs_from_the_shipped_one_where_it_says(checkout: Path) -> None:
    shipped = described(checkout / "arms.yaml", "ariane4")
    own = described(checkout / "examples" / "mpc" / "arms.yaml", "ariane4_mpc")
    joints = []
    for joint in own.joints:
        effects = tuple(
            replace(e, values={k: v for k, v in e.values.items() if k != "smoothing"}) for e in joint.effects
        )
        drive = joint.drive
        if isinstance(drive, LeveredDrive):
            assert any("smoothing" in effect.values for effect in joint.effects)
            assert drive.limits.current is not None
            drive = replace(drive, limits=replace(drive.limits, current=None))
        joints.append(replace(joint, effects=effects, drive=drive))
    assert own.monitor == ()
    same = {"name": shipped.name, "source": shipped.source, "monitor": shipped.monitor}
    assert replace(own, joints=tuple(joints), **same) == shipped


def test_wrong_parameters_are_wrong_by_up_to_a_tenth_and_physical(arm: ControlledArm) -> None:
    wrong = perturbed(arm, 1)
    share = abs(wrong / arm.parameters - 1)
    assert share.max() <= 0.1
    assert (share > 0.001).sum() > 20
    assert np.array_equal(wrong, perturbed(arm, 1))
    assert smallest_eigenvalue(arm, wrong) > 0.1
    with pytest.raises(ValueError, match="seed 3: the mass matrix has the eigenvalue -"):
        perturbed(arm, 3, share=20)


def test_the_plant_refuses_to_leave_the_stroke(arm: ControlledArm, library: Path) -> None:
    plant = Plant(library, "ariane4", arm.parameters, 3)
    with pytest.raises(RuntimeError, match="a lever has left its stroke"):
        plant.acceleration(np.array([1.0, 1.0, 3.0]), np.zeros(3), np.zeros(3))


def test_the_plant_keeps_its_energy_without_friction(arm: ControlledArm, library: Path) -> None:
    parameters = arm.parameters.copy()
    parameters[[15, 16, 18, 19, 21, 22]] = 0  # FV and FC
    plant = Plant(library, "ariane4", parameters, 3)
    energy = arm.functions["energy"]
    state = np.array([0.0, 0.9, 3.0, 0.1, 0.3, -0.4])

    def total(x: np.ndarray) -> float:
        return float(sum(float(e) for e in energy(x[:3], x[3:], parameters)))

    moved = plant.advance(state, np.zeros(3), 0.2)
    kinetic = float(energy(moved[:3], moved[3:], parameters)[0])
    assert abs(moved[:3] - state[:3]).max() > 0.02
    assert total(moved) == pytest.approx(total(state), abs=1e-8 * kinetic)


def test_both_solvers_find_the_same_plan(arm: ControlledArm, horizon: Horizon) -> None:
    one = horizon.solve(START, ahead(3.0))
    other = Horizon(arm, "inverse", "ipopt").solve(START, ahead(3.0))
    assert one.success
    assert other.success
    assert one.cost == pytest.approx(other.cost, rel=1e-5)
    np.testing.assert_allclose(one.states, other.states, atol=2e-4)


def test_both_formulations_plan_the_same_motion(arm: ControlledArm, horizon: Horizon) -> None:
    """Far from dry friction's smoothed step, where holding the input is not holding the acceleration."""
    state = reference(np.array([6.0]))[0]
    inverse = horizon.solve(state, ahead(6.0))
    forward = Horizon(arm, "forward", "ipopt").solve(state, ahead(6.0))
    assert forward.success
    # Not the last speeds: what the last control costs differs.
    np.testing.assert_allclose(inverse.states[:-1], forward.states[:-1], atol=2e-3)
    np.testing.assert_allclose(inverse.inputs, forward.inputs, atol=0.03)


def test_compiled_and_evaluated_plans_agree(arm: ControlledArm, horizon: Horizon, tmp_path: Path) -> None:
    fast = Horizon(arm, "inverse", "fatrop", compiled_in=tmp_path, flags=("-O0",)).solve(START, ahead(3.0))
    slow = horizon.solve(START, ahead(3.0))
    assert fast.iterations == slow.iterations
    np.testing.assert_allclose(fast.states, slow.states, atol=1e-7)


def needed(arm: ControlledArm, plan: Solution) -> np.ndarray:
    """Inputs in the middle of every interval of a plan, from its states alone: 20 × 3."""
    q, dq = plan.states[:, :3], plan.states[:, 3:]
    ddq = np.diff(dq, axis=0) / 0.05
    middle = q[:-1] + 0.025 * dq[:-1] + 0.025**2 / 2 * ddq, dq[:-1] + 0.025 * ddq
    inverse = arm.functions["inverse_dynamics"]
    return np.array([inverse(*row, arm.parameters).full().ravel() for row in zip(*middle, ddq, strict=True)])


def test_a_far_reference_meets_the_limits_of_current(arm: ControlledArm) -> None:
    plan = Horizon(arm, "inverse", "ipopt").solve(START, ahead(6.0))
    inputs = needed(arm, plan)
    assert plan.success
    assert (abs(inputs) <= arm.effort + 1e-4).all()
    assert np.isclose(abs(inputs), arm.effort, rtol=1e-3).any(axis=0).all(), "every motor at its limit"
    np.testing.assert_allclose(plan.inputs, inputs[0], atol=1e-6)


def test_a_reference_beyond_the_stroke_stops_before_its_end(arm: ControlledArm, horizon: Horizon) -> None:
    assert arm.drives is not None
    beyond = reference(np.array([18.0]))[0] * np.array([1, 1, 1, 0, 0, 0])
    start = beyond - np.array([0.15, 0, 0, 0, 0, 0])
    plan = horizon.solve(start, np.tile(beyond, (21, 1)))
    motor = arm.functions["motor_from_joint"]
    place = [float(motor(x[:3], x[3:], np.zeros(3))[0][0]) for x in plan.states[:-1]]
    assert plan.success
    assert np.rad2deg(beyond[0]) > 32
    assert max(place) == pytest.approx(0.99 * arm.drives.high[0], rel=1e-4)


def test_the_arm_goes_where_the_plan_says(arm: ControlledArm, horizon: Horizon, library: Path) -> None:
    """In motion, where dry friction smoothed is nearly dry friction."""
    state = reference(np.array([6.0]))[0]
    plan = horizon.solve(state, ahead(6.0))
    right = Plant(library, "ariane4", arm.parameters, 3).advance(state, plan.inputs, 0.05)
    moved = abs(right - state)[:3]
    assert (moved > 0.003).all()
    assert (abs(right - plan.states[1])[:3] < 0.1 * moved).all()


def test_the_loop_tracks_a_wrong_plant(arm: ControlledArm, horizon: Horizon, library: Path) -> None:
    plant = Plant(library, "ariane4", perturbed(arm, 1), 3)
    run = closed_loop(horizon, plant, 2.0)
    assert run.failures == 0
    assert (abs(run.inputs) <= arm.effort).all()
    assert np.rad2deg(abs(run.error)).max() < 0.5
    moved = np.rad2deg(abs(run.reference[-1] - run.reference[0])[:3])
    assert (moved > 1).all(), "the reference moves by more than the error that is allowed"


def test_unknown_names_are_refused(arm: ControlledArm) -> None:
    with pytest.raises(ValueError, match="formulation 'lagrange', expected one of inverse, forward"):
        Horizon(arm, "lagrange", "ipopt")
    with pytest.raises(ValueError, match="no solver 'snapt', expected one of ipopt, fatrop"):
        Horizon(arm, "inverse", "snapt")
