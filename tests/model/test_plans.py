"""Every way to compute a link's columns of the regressor gives the same columns, chosen or not."""

import numpy as np
import pytest
from witness.arms import ARMS, SEEDS, random_arm
from witness.mechanism import Mechanism, states

from modelgen.description import Arm
from modelgen.graph.evaluate import evaluate
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, base_motion, link_motions
from modelgen.model.regressor import Plan, Regressor

SAMPLES = 3
SLIDING = (32, 62, 81, 140)  # a wrist that carries a sliding joint
SUBJECTS = [*(f"random{seed}" for seed in {*SEEDS, *SLIDING, *range(200, 220)}), "rx90", "wam7", "scara"]


def subject(name: str) -> Arm:
    return random_arm(int(name.removeprefix("random"))) if name.startswith("random") else ARMS[name]


@pytest.mark.parametrize("name", SUBJECTS)
@pytest.mark.parametrize("factored", [False, True])
def test_all_plans_agree_with_the_witness(name: str, factored: bool) -> None:
    equations = Equations(subject(name))
    arm = equations.arm
    frames = equations.frames_factored if factored else equations.frames
    rates = Rates(equations.vector("dq"), equations.vector("ddq"))
    regressor = Regressor(frames, link_motions(frames, rates), base_motion(frames))
    mechanism = Mechanism(arm)
    q, dq, ddq = states(arm, SAMPLES)
    gains = mechanism.gains(q)[:, :, None]
    expected = mechanism.regressor(q, dq, ddq) * gains
    expressions, wanted, labels = [], [], []
    plain = [Plan()] * len(arm.joints)
    for i in range(len(arm.joints)):
        for slid, back in regressor.plans(i):
            for derived in (frozenset[int](), frozenset(regressor.derivable(i))):
                plan = Plan(slid, back, derived)
                table = regressor.columns([*plain[:i], plan, *plain[i + 1 :]])
                for k, column in enumerate(table[i]):
                    for n, expression in column.items():
                        expressions.append(expression)
                        wanted.append(expected[:, n, 10 * i + k])
                        labels.append((arm.joints[i].name, plan, k, n))
    inputs = {"q": q, "dq": dq, "ddq": ddq}
    inputs["geometry"] = np.tile([float(v) for v in arm.symbols.values()], (SAMPLES, 1))
    found = evaluate(expressions, inputs, SAMPLES)
    gaps = np.abs(found - np.stack(wanted, axis=1)).max(axis=0)
    wrong = np.flatnonzero(gaps > 1e-10 * np.abs(expected).max())
    assert not len(wrong), labels[wrong[0]]


def test_the_plans_tried_are_of_every_kind() -> None:
    seen = set()
    for name in SUBJECTS:
        equations = Equations(subject(name))
        regressor = Regressor(equations.frames, [], base_motion(equations.frames))
        for i, joint in enumerate(equations.arm.joints):
            for slid, back in regressor.plans(i):
                seen.add((slid, back, bool(joint.b)))
    assert {(slid, back, False) for slid in (False, True) for back in (0, 1, 2)} <= seen
    assert {(slid, back, True) for slid in (False, True) for back in (0, 1)} <= seen
