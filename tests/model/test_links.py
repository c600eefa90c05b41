"""Links without drives against Pinocchio: every shipped arm, and random chains and trees of all joints."""

from collections.abc import Callable

import numpy as np
import pytest
from witness.arms import ARMS, RANDOM_LINKS, SEEDS, SHIPPED_LINKS, Emitted, build, random_arm
from witness.bodies import random_bodies
from witness.compare import agree
from witness.geometry import poses
from witness.mechanism import states
from witness.rigid_bodies import RigidBodies

from modelgen.functions import Options

Array = np.ndarray
SAMPLES = 6
SUFFIXES = ("", "_standard")

each_arm = pytest.mark.parametrize("make", [*SHIPPED_LINKS, *RANDOM_LINKS])


class Case:
    """One arm with random bodies at random states."""

    def __init__(self, make: Callable[[], Emitted]) -> None:
        self.emitted = make()
        arm = self.emitted.arm
        self.bodies = random_bodies(arm, np.random.default_rng(3))
        self.witness = RigidBodies(arm, self.bodies)
        self.q, self.dq, self.ddq = states(arm, SAMPLES)
        self.samples = list(zip(self.q, self.dq, self.ddq, strict=True))

    def parameters(self, suffix: str) -> Array:
        standard = np.concatenate([body.ten for body in self.bodies])
        return standard if suffix else self.emitted.base(standard)


@each_arm
def test_inverse_dynamics(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    effort = [case.witness.effort(*sample) for sample in case.samples]
    for suffix in SUFFIXES:
        name = f"inverse_dynamics{suffix}"
        agree(case.emitted(name, case.q, case.dq, case.ddq, case.parameters(suffix)), effort)


@each_arm
def test_gravity_and_bias(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    still = np.zeros(case.q.shape[1])
    gravity = [case.witness.effort(q, still, still) for q in case.q]
    bias = [case.witness.effort(q, dq, still) for q, dq, _ in case.samples]
    scale = [case.witness.effort(*sample) for sample in case.samples]
    for suffix in SUFFIXES:
        parameters = case.parameters(suffix)
        # beside the whole effort: a planar arm's gravity, say, is nothing but rounding
        agree(case.emitted(f"gravity{suffix}", case.q, parameters) + scale, np.add(gravity, scale))
        agree(case.emitted(f"bias{suffix}", case.q, case.dq, parameters) + scale, np.add(bias, scale))


@each_arm
def test_mass_matrix(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    mass = [case.witness.mass_matrix(q) for q in case.q]
    for suffix in SUFFIXES:
        agree(case.emitted(f"mass_matrix{suffix}", case.q, case.parameters(suffix)), mass)


@each_arm
def test_forward_dynamics(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    effort = 10 * case.ddq
    acceleration = [
        case.witness.acceleration(*sample) for sample in zip(case.q, case.dq, effort, strict=True)
    ]
    for suffix in SUFFIXES:
        name = f"forward_dynamics{suffix}"
        agree(case.emitted(name, case.q, case.dq, effort, case.parameters(suffix)), acceleration)


@each_arm
def test_standard_regressor(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    apart = RigidBodies(case.emitted.arm, case.bodies, every_joint=True)
    columns = [apart.regressor(*sample) for sample in case.samples]
    agree(case.emitted("regressor_standard", case.q, case.dq, case.ddq), columns)


@each_arm
def test_poses_of_all_links(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    found = case.emitted("forward_kinematics", case.q)
    found = np.stack(found, axis=1) if isinstance(found, tuple) else found[:, None]
    agree(found, [case.witness.poses(q) for q in case.q], 1e-12)
    agree(found, [poses(case.emitted.arm, q) for q in case.q], 1e-12)


@each_arm
def test_jacobian_of_the_last_link(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    last = len(case.emitted.arm.joints) - 1
    agree(case.emitted("jacobian", case.q), [case.witness.jacobian(q, last) for q in case.q], 1e-12)


@each_arm
def test_energy(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    energy = np.array([case.witness.energy(q, dq) for q, dq, _ in case.samples])
    # potential energy has no natural zero: differences, beside what it takes to lift the arm by a metre
    metre = 9.81 * sum(body.mass for body in case.bodies)
    for suffix in SUFFIXES:
        kinetic, potential = case.emitted(f"energy{suffix}", case.q, case.dq, case.parameters(suffix))
        agree(kinetic[:, 0], energy[:, 0])
        agree(potential[:, 0] - potential[0] + metre, energy[:, 1] - energy[0, 1] + metre)


def test_jacobian_of_any_link() -> None:
    arm = ARMS["two_fingers"]
    bodies = random_bodies(arm, np.random.default_rng(3))
    witness = RigidBodies(arm, bodies)
    q = states(arm, SAMPLES)[0]
    for i, joint in enumerate(arm.joints):
        found = build(arm, Options(jacobian_link=joint.name))("jacobian", q)
        agree(found, [witness.jacobian(x, i) for x in q], 1e-12)


def test_the_random_arms_leave_nothing_out() -> None:
    """What the tests above claim to cover is there."""
    arms = [random_arm(seed) for seed in SEEDS]
    joints = [joint for arm in arms for joint in arm.joints]
    assert {joint.type for joint in joints} == {"revolute", "prismatic", "fixed"}
    assert {joint.type for joint in joints if joint.locked is not None} == {"revolute", "prismatic"}
    assert any(joint.gamma and joint.b for joint in joints)
    assert any(abs(np.sin(2 * joint.alpha)) > 0.1 for joint in joints)
    assert any(arm.symbols for arm in arms)
    assert {len(arm.coordinates) for arm in arms} >= {2, 3, 4, 5, 6}
    assert any(np.count_nonzero(arm.gravity) == 3 for arm in arms)
    antecedents = [[joint.antecedent for joint in arm.joints] for arm in arms]
    assert any(a is not None and a > i for chain in antecedents for i, a in enumerate(chain))  # file order
    assert any(chain.count(a) > 1 for chain in antecedents for a in chain)  # branches
