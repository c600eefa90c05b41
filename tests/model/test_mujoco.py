"""Links with geared motors, viscous friction and springs against MuJoCo."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from witness.arms import ARMS, Emitted, build
from witness.bodies import random_bodies
from witness.compare import agree
from witness.geometry import moving
from witness.mechanism import Mechanism, states
from witness.multi_body import MultiBody

from modelgen.description import Arm, EffectUse
from modelgen.functions import Options

NAMES = ("rx90", "wam7", "scara", "two_fingers", "screw_axis")
USES = ("viscous_friction", "drive_inertia", "spring")
PARAMETERS = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in NAMES]


def sprung(arm: Arm) -> Arm:
    """The arm with what MuJoCo has too, and nothing else."""
    effects = tuple(EffectUse(name) for name in USES)
    joints = tuple(replace(joint, effects=effects if joint.moving else ()) for joint in arm.joints)
    return replace(arm, joints=joints)


@functools.cache
def built(name: str) -> Emitted:
    return build(sprung(ARMS[name]), Options())


@pytest.mark.parametrize("name", PARAMETERS)
def test_motors_and_springs_are_mujocos_armature_damping_and_stiffness(name: str) -> None:
    emitted = built(name)
    arm = emitted.arm
    rng = np.random.default_rng(5)
    bodies = random_bodies(arm, rng)
    mechanism = Mechanism(arm)
    standard = mechanism.standard(bodies, rng)
    value = dict(zip(mechanism.names(), standard, strict=True))
    attributes = []
    for k, i in enumerate(moving(arm)):
        ratio, n = float(mechanism.drives[k].k1(0.0)), i + 1
        attributes.append(
            {
                "armature": value[f"IA{n}"] * ratio**2,
                "damping": value[f"FV{n}"] * ratio**2,
                "stiffness": value[f"KS{n}"],
                "springref": -value[f"KO{n}"] / value[f"KS{n}"],
            }
        )
    witness = MultiBody(arm, bodies, attributes)
    q, dq, ddq = states(arm, 6)
    gains = mechanism.gains(q)
    samples = list(zip(q, dq, ddq, strict=True))
    effort = np.array([witness.effort(*sample) for sample in samples])
    acceleration = [witness.acceleration(*sample) for sample in zip(q, dq, 10 * ddq, strict=True)]
    mass = [witness.mass_matrix(x) for x in q]
    for suffix, parameters in (("", emitted.base(standard)), ("_standard", standard)):
        given = emitted(f"inverse_dynamics{suffix}", q, dq, ddq, parameters)
        agree(given * gains, effort)
        agree(
            emitted(f"forward_dynamics{suffix}", q, dq, 10 * ddq / gains, parameters),
            acceleration,
        )
        agree(emitted(f"mass_matrix{suffix}", q, parameters), mass)
