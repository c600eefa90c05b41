"""A first joint's drive and link show one inertia; behind a spring or in a gap each has its own."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS, standard_vector
from hidden.cases import Case, Hidden, make, seal
from hidden.judging import FOUND
from hidden.running import diagnose, diagnosed_here, judged

from modelgen.backends.numpy import NumpyFunction
from modelgen.description import EffectUse, load
from modelgen.effects import known_effects
from modelgen.functions import build_model
from modelgen.functions.nominal import base_matrix

INERTIA = 3e-4


@pytest.mark.parametrize(("name", "index"), [("scara", 0), ("rx90", 1)])
@pytest.mark.parametrize(
    "compliant",
    [
        EffectUse("joint_flexibility", {"stiffness": 900.0, "damping": 4.0}),
        EffectUse("backlash", {"play": 0.004, "stiffness": 4000.0, "damping": 6.0}),
    ],
    ids=lambda use: use.name,
)
def test_base_parameters_move_an_elastic_joint_as_standard_ones_do(
    compliant: EffectUse, name: str, index: int
) -> None:
    """The standard functions know nothing of a grouping."""
    arm = ARMS[name]
    joints = list(arm.joints)
    drive = EffectUse("drive_inertia", {"inertia": INERTIA})
    joints[index] = replace(joints[index], effects=(drive, compliant))
    model = build_model(replace(arm, joints=tuple(joints)))
    (contained,) = (d for d in model.grouping.drives if d.joint == index)
    random = np.random.default_rng(4)
    standard = standard_vector(model, random)
    standard[[p.name for p in model.standard].index(contained.name)] = INERTIA
    base = base_matrix(model) @ standard
    n = len(arm.coordinates)
    known = {
        "q": random.uniform(-0.5, 0.5, n),
        "dq": random.uniform(-1.0, 1.0, n),
        "ddq": random.uniform(-3.0, 3.0, n),
        "input": random.uniform(-1.0, 1.0, n),
        "state": np.array([0.004, -0.02]),
        "dt": np.array([0.001]),
    }
    functions = {f.name: NumpyFunction(f) for f in model.functions}
    for which in ("inverse_dynamics", "forward_dynamics", "mass_matrix", "effects_step"):
        found = []
        for suffix, parameters in (("", base), ("_standard", standard)):
            call = functions[which + suffix]
            given = {**known, "parameters": parameters}
            found.append(np.asarray(call(**{a.name: given[a.name] for a in call.function.arguments})))
        assert np.isfinite(found[0]).all()
        assert np.allclose(found[0], found[1], rtol=1e-9, atol=1e-11), which


@pytest.mark.parametrize("encoder", ["joint", "motor"])
def test_stiffness_of_a_first_joint_is_that_of_its_spring(encoder: str, tmp_path: Path) -> None:
    """Taken with the inertia of drive and link together it is too large by half and more."""
    magnitude = 0.1508572733
    case = Case("direct2", 863385758, (Hidden("joint_flexibility", 1, 1.3, magnitude),), encoder)
    seal(make(case, tmp_path / "case"), tmp_path / "case.sealed")
    answer, _ = diagnose(tmp_path / "case", case.name)
    outcome, _ = judged(case, tmp_path / "case", answer)
    assert outcome.result == FOUND, outcome
    assert outcome.recovered is not None
    assert outcome.recovered > 0.5
    (cause,) = answer["causes"]
    assert (cause["effect"], cause["joint"]) == ("joint_flexibility", 1)
    truth = 400.0 / magnitude  # N m/rad, as the plant has it
    assert cause["parameters"]["stiffness"]["value"] == pytest.approx(truth, rel=0.2)
    (taken,) = answer["drive_inertias"]
    file = tmp_path / "case" / "diagnosis" / f"{case.name}_extended.yaml"
    extended = load(file, known_effects())[case.name]
    (given,) = (u.values["inertia"] for u in extended.joints[0].effects if u.name == "drive_inertia")
    assert given == pytest.approx(taken["value"], rel=1e-5)
    # what is generated accelerates: its self-test has something to compare
    program = (file.parent / "generated" / case.name / "examples" / "self_test" / "main.c").read_text()
    assert f"{case.name}_forward_dynamics_identified(" in program
    assert len(answer["simulation"]["after"]["rmse"]) == 2


def test_play_of_a_first_joint_behind_its_links_own_position(tmp_path: Path) -> None:
    """Found without a stiffness. With the inertia of drive and link together it is six times too wide, and
    the model that has it predicts no better than one without.
    """
    magnitude = 0.24637446999324616
    case = Case("direct3", 2786900864, (Hidden("backlash", 1, 1.3, magnitude),), "joint")
    make(case, tmp_path / "case")
    answer = diagnosed_here(tmp_path / "case", case.name)
    (cause,) = answer["causes"]
    assert (cause["effect"], cause["joint"]) == ("backlash", 1)
    assert answer["drive_inertias"]
    truth = 0.004 * magnitude  # rad, as the plant has it
    assert truth < cause["parameters"]["play"]["value"] < 4.0 * truth
    assert answer["error"]["gain_percent"][0] > 5.0
    assert len(answer["simulation"]["after"]["rmse"]) == 3
