"""A soft actuator behind a lever, of another plant: named, and the extended arm's own model explains it."""

from pathlib import Path

import numpy as np
from hidden.cases import Case, Hidden, make
from hidden.recovery import reachable

from modelgen.description import load
from modelgen.diagnosis.equations.rows import motion_of
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose, records
from modelgen.evaluation import Evaluator

SOFT = Case("levered2", 1740050650, (Hidden("joint_flexibility", 2, 1.3, 1.98645),))


def test_the_extended_arm_recovers_what_the_joint_costs(tmp_path: Path) -> None:
    make(SOFT, tmp_path)
    arm = load(tmp_path / "arms.yaml")["arm"]
    train, test = [str(tmp_path / f"train_{x}.csv") for x in "ab"], str(tmp_path / "test.csv")
    found = diagnose(arm, records(arm, train, [test], None, USUAL.dataset), experiment=False)
    assert [(c.effect, c.joint) for c in found.causes] == [("joint_flexibility", 2)]
    before, after = found.errors.before[1], found.errors.after[1]
    floor = reachable(SOFT, tmp_path)[1]
    assert before > 1.3 * floor
    assert before - after > 0.9 * (before - floor)
    # the emitted description with the fitted parameters gives the measured currents by itself
    extended = found.after
    left = []
    for rows in extended.rows:
        motion = motion_of(rows.prepared)
        given = Evaluator(extended.arm).inputs(motion, extended.parameters)
        difference = np.asarray(rows.prepared.parallel(np.asarray(rows.prepared.input) - given))
        left.append(difference[rows.moving[:, 1], 1])
    own = found.before.rows
    alone = [(r.effort - r.columns @ found.before.theta)[r.moving[:, 1], 1] for r in own]
    assert np.std(np.concatenate(left)) < 0.95 * np.std(np.concatenate(alone))
