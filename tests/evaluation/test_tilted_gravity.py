"""A tilted base shows what an upright arm hides of its links: held against Pinocchio with gravity turned."""

from dataclasses import replace

import numpy as np
import pytest
from evaluation_support import motion
from witness.arms import ARMS, shipped
from witness.bodies import Body
from witness.rigid_bodies import RigidBodies

from modelgen.description import Arm
from modelgen.effects import described
from modelgen.effects.laws.environment import BaseTilt
from modelgen.evaluation import Evaluator, with_effect
from modelgen.functions.nominal import grouped, nominal_links

TILT = {"x": 0.03, "y": -0.05}


def bodies(arm: Arm) -> list[Body]:
    found = []
    for link in arm.links:
        assert link is not None
        tensor = np.zeros((3, 3))
        tensor[np.triu_indices(3)] = link.inertia
        found.append(Body(link.mass, np.array(link.com), tensor + np.triu(tensor, 1).T))
    return found


@pytest.mark.parametrize("name", ["ur10e", "ariane4", "scara", "two_fingers", "gravity_arm"])
def test_a_tilt_weighs_all_of_the_links(name: str) -> None:
    arm, model = ARMS[name], shipped(name).model
    known = nominal_links(model.arm)
    base = np.array(list(grouped(model, [known.get(p.name, 0.0) for p in model.standard]).values()))
    m, evaluator = motion(name), Evaluator(arm)
    found = evaluator.contribution("base_tilt", None, m, TILT, base) * shipped(name)("drive_gain", m.q)
    leaning = described(with_effect(arm, "base_tilt", None, TILT))
    made = [RigidBodies(a, bodies(a)) for a in (leaning, arm)]
    still = np.zeros(m.q.shape[1])
    expected = [made[0].effort(q, still, still) - made[1].effort(q, still, still) for q in m.q]
    np.testing.assert_allclose(found, expected, atol=1e-8 * np.abs(expected).max())


def test_without_nominal_links_it_weighs_what_the_records_tell() -> None:
    arm = replace(ARMS["ur10e"], links=(None, *ARMS["ur10e"].links[1:]))
    m = motion("ur10e")
    base = np.ones(len(Evaluator(arm).base.base))
    known = Evaluator(ARMS["ur10e"]).contribution("base_tilt", None, m, TILT, base)
    told = Evaluator(arm).contribution("base_tilt", None, m, TILT, base)
    assert np.isfinite(told).all()
    # the first link hangs on the first joint alone, and all that others carry weighs there as well
    assert np.abs((known - told)[:, 0]).max() > 1e-3 * np.abs(known).max()


@pytest.mark.parametrize("seed", range(20))
def test_the_turns_that_are_estimated_lean_gravity_in_two_directions(seed: int) -> None:
    """Wherever it points: the third turn would add none, since gravity turns about itself (e x g)."""
    gravity = 9.81 * np.random.default_rng(seed).normal(size=3)
    (names,) = BaseTilt.subsets(replace(ARMS["ur10e"], gravity=tuple(gravity)), None)
    first, second = (np.cross(np.eye(3)["xyz".index(name)], gravity) for name in names)
    spanned = np.linalg.norm(np.cross(first, second)) / (gravity @ gravity)
    assert spanned > 0.57  # 1 / sqrt(3) where gravity lies between all three axes
