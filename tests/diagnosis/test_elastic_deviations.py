"""An elastic joint is as stiff as it is, within its deviation: where its link rings as the records begin, and
where the inertia of its drive is described wrongly.
"""

from __future__ import annotations

import numpy as np
import pytest
from belt_rig import STIFFNESS, log, rig

import modelgen as mg
from modelgen.diagnosis.extended import NamedCause

DAMPING = 0.15  # N m s/rad: it rings for two seconds


def found(rotor: float = 1.0, *, fallen: bool = False, counts: int = 0) -> NamedCause:
    """counts: of the encoder, in a turn of the motor; 0: it rounds nothing."""
    logs = [log(seed, damping=DAMPING, fallen=fallen) for seed in range(3)]
    for table in logs if counts else ():
        step = 2.0 * np.pi / counts
        table["qm1"] = step * np.rint(table["qm1"] / step)
    effects = ["joint_flexibility"]
    (cause,) = mg.diagnose(rig(rotor=rotor), logs[:2], logs[2], effects=effects, experiment=False).causes
    return cause


@pytest.mark.parametrize("fallen", [False, True])
def test_a_link_that_rings_as_a_record_begins_is_no_other_stiffness(fallen: bool) -> None:
    stiffness, damping = (found(fallen=fallen).parameters[name] for name in ("stiffness", "damping"))
    assert abs(stiffness.value - STIFFNESS) < 0.01 * STIFFNESS
    assert abs(stiffness.value - STIFFNESS) < 2.5 * stiffness.std < 0.1 * STIFFNESS
    assert abs(damping.value - DAMPING) < min(3.0 * damping.std, 0.1 * DAMPING)


@pytest.mark.parametrize("rotor", [0.85, 1.15])
def test_a_stiffness_holds_what_the_rotor_may_be_off_by(rotor: float) -> None:
    stiffness = found(rotor).parameters["stiffness"]
    assert abs(stiffness.value - STIFFNESS) < 2.5 * stiffness.std < 0.3 * STIFFNESS


@pytest.mark.parametrize("counts", [2000, 16000])
def test_a_damping_holds_what_rounded_positions_hide(counts: int) -> None:
    """They make the link ring as the efforts do not, and leave open when these were read."""
    damping = found(counts=counts).parameters["damping"]
    assert abs(damping.value - DAMPING) < 3.0 * damping.std
