"""What no motion of an arm tells apart."""

from pathlib import Path

import numpy as np
import pytest

from modelgen.description import load
from modelgen.diagnosis.adequacy.distinguishable import aliases
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.effects import CATALOGUE, known_effects
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model

SEARCHED = CATALOGUE["nonlinear_viscous_friction"].searched()


@pytest.mark.parametrize(("name", "same"), [("gravity_link2", ["nonlinear_viscous_friction"]), ("ur10e", [])])
def test_drag_of_a_single_joint_is_friction_with_the_square_of_its_speed(
    checkout: Path, name: str, same: list[str]
) -> None:
    arm = load(checkout / "arms.yaml", known_effects())[name]
    model = build_model(arm)
    pool = [
        Candidate("nonlinear_viscous_friction", 1, {"scale": 1.0}, SEARCHED),
        Candidate("asymmetric_viscous_friction", 1),
        Candidate("fluid_drag", None),
    ]
    base = np.ones(len(model.grouping.base))
    (found,) = aliases(
        [Candidate("fluid_drag", None)], pool, Equations(model, Evaluator(arm), [], [], USUAL), base
    )
    assert [c.effect for c in found] == same
