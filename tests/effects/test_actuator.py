"""A linear actuator that swings on the link before: against point masses between base and lever's end."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from witness.arms import Emitted, build
from witness.bodies import random_bodies
from witness.compare import agree
from witness.mechanism import states
from witness.rigid_bodies import RigidBodies

from modelgen.description import Arm, DirectDrive, EffectUse, Joint, LeveredDrive
from modelgen.functions import Options

BASE_ANGLE = -0.7
LEVER = LeveredDrive(0.32, 0.07, (0.26, 0.38), (100.0, 9000.0), -1, 0.8, 4e-3)
# along the actuator, across it [m], kg; what lies across cancels but for its first moment
POINTS = ((0.08, 0.0, 2.0), (0.21, 0.0, 1.5), (0.0, 0.05, 3.0), (0.0, -0.05, -3.0))
SIXTH = ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60))


def arm_with(joint: int, *, spatial: bool) -> Arm:
    """Three joints; `joint` (from 0) is moved by an actuator that has a mass."""
    use = EffectUse("actuator_mass", {"base_angle": BASE_ANGLE})
    alpha = (0.2, 1.3, -0.4) if spatial else (0.0, 0.0, 0.0)
    joints = [
        Joint(
            f"j{k + 1}",
            "revolute",
            alpha=alpha[k],
            theta=0.3 * (k + 1) * spatial,
            d=0.4 * (k > 0),
            r=0.15 * k,
            antecedent=k - 1 if k else None,
        )
        for k in range(3)
    ]
    joints = [replace(j, drive=DirectDrive(80.0, 0.05)) for j in joints]
    joints[joint] = replace(joints[joint], drive=LEVER, effects=(use,))
    return Arm("crane", tuple(joints), (None, None, None), (1.0, 2.0, -9.81))


def slope(function: Callable[[np.ndarray], np.ndarray], x: np.ndarray, h: float = 1e-3) -> np.ndarray:
    """By each coordinate, by differences of sixth order; the last axis is the coordinate."""
    parts = []
    for along in np.eye(len(x)):
        terms = [(function(x + k * h * along) - function(x - k * h * along)) * c for k, c in SIXTH]
        parts.append(np.asarray(sum(terms)) / h)
    return np.stack(parts, axis=-1)


class Actuator:
    """Point masses less the whole mass at the base, which is a part of the link before."""

    def __init__(self, arm: Arm, joint: int) -> None:
        self.arm, self.joint = arm, joint
        self.links = RigidBodies(arm, random_bodies(arm, np.random.default_rng(0)), every_joint=True)
        masses = [m for _, _, m in POINTS]
        self.masses = np.array([*masses, -sum(masses)])

    def places(self, q: np.ndarray) -> np.ndarray:
        """(5, 3) in the base's frame, the base of the actuator last."""
        still = q.copy()
        still[self.joint] = -float(self.arm.joints[self.joint].theta)
        pose = np.array(self.links.poses(still))[self.joint]

        def there(radius: float, angle: float) -> np.ndarray:
            return np.asarray(
                pose[:3, :3] @ [radius * np.cos(angle), radius * np.sin(angle), 0] + pose[:3, 3]
            )

        base = there(LEVER.l1, BASE_ANGLE)
        end = there(LEVER.l2, BASE_ANGLE + q[self.joint] - LEVER.offset)
        along = (end - base) / np.linalg.norm(end - base)
        across = np.cross(pose[:3, 2], along)
        return np.array([*(base + x * along + y * across for x, y, _ in POINTS), base])

    def inertia(self, q: np.ndarray) -> np.ndarray:
        jacobian = slope(self.places, q)
        return np.asarray(np.einsum("p,pxi,pxj->ij", self.masses, jacobian, jacobian))

    def stored(self, q: np.ndarray) -> np.ndarray:
        return np.asarray(-(self.masses @ self.places(q)) @ self.arm.gravity)

    def effort(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Lagrange's."""
        change = slope(self.inertia, q)
        rate = change @ dq
        return np.asarray(
            self.inertia(q) @ ddq
            + rate @ dq
            - 0.5 * np.einsum("ijk,i,j->k", change, dq, dq)
            + slope(self.stored, q)
        )


def standard(emitted: Emitted) -> np.ndarray:
    """Physical links; inertia and moments of the points."""
    links = np.concatenate([b.ten for b in random_bodies(emitted.arm, np.random.default_rng(3))])
    found = np.concatenate([links, np.zeros(len(emitted.model.standard) - len(links))])
    names = [p.name for p in emitted.model.standard]
    number = next(name.removeprefix("JS") for name in names if name.startswith("JS"))
    found[names.index(f"JS{number}")] = sum(m * x**2 for x, _, m in POINTS)
    found[names.index(f"SX{number}")] = sum(m * x for x, _, m in POINTS)
    found[names.index(f"SY{number}")] = sum(m * y for _, y, m in POINTS)
    return found


CASES = [(0, True), (1, True), (2, True), (2, False)]


@pytest.mark.parametrize(("joint", "spatial"), CASES)
def test_it_moves_as_its_masses_do(joint: int, spatial: bool) -> None:
    arm = arm_with(joint, spatial=spatial)
    emitted, actuator = build(arm, Options()), Actuator(arm, joint)
    q, dq, ddq = states(emitted.arm, 5)
    theta = standard(emitted)
    without = np.where(np.arange(len(theta)) < 30, theta, 0.0)
    gain = emitted("drive_gain", q)
    given = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    extra = (given - emitted("inverse_dynamics_standard", q, dq, ddq, without)) * gain
    agree(extra, [actuator.effort(*x) for x in zip(q, dq, ddq, strict=True)], 1e-7)
    assert (np.abs(extra[:, : joint + 1]).max(axis=0) > 0.01 * np.abs(extra).max()).all()  # all that carry it
    more = emitted("mass_matrix_standard", q, theta) - emitted("mass_matrix_standard", q, without)
    agree(more, [actuator.inertia(x) for x in q], 1e-8)
    agree(emitted("forward_dynamics_standard", q, dq, given, theta), ddq)
    columns = emitted("regressor_standard", q, dq, ddq)
    agree(columns @ theta, given)
    agree(emitted("regressor", q, dq, ddq) @ emitted.base(theta), given)


@pytest.mark.parametrize(("joint", "spatial"), CASES)
def test_its_coriolis_matrix_is_passive_and_its_weight_a_slope(joint: int, spatial: bool) -> None:
    """dM/dt - 2 C is skew-symmetric; dU/dq is the weight at every joint."""
    arm = arm_with(joint, spatial=spatial)
    emitted = build(arm, Options())
    theta = standard(emitted)
    base = emitted.base(theta)
    q, dq, _ = states(emitted.arm, 3)
    gain = emitted("drive_gain", q)
    for at in range(len(q)):
        x, v = q[at], dq[at]

        def effort(reference: np.ndarray, x: np.ndarray = x, v: np.ndarray = v, at: int = at) -> np.ndarray:
            return np.squeeze(emitted("slotine_li_regressor", x, v, reference, 0 * x) @ base * gain[at])

        coriolis = np.stack([effort(unit) - effort(0 * x) for unit in np.eye(3)], axis=1)
        rate = slope(lambda y: np.squeeze(emitted("mass_matrix", y, base)), x) @ v
        skew = rate - 2 * coriolis
        assert np.abs(skew + skew.T).max() <= 1e-7 * np.abs(rate).max()
        weight = slope(lambda y: np.squeeze(emitted("energy_standard", y, 0 * y, theta)[1]), x)
        agree(weight, np.squeeze(emitted("gravity_standard", x, theta)) * gain[at], 1e-7)
