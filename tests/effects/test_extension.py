"""The extended description: what several joints share stays as it was for the others."""

from pathlib import Path

import pytest

from modelgen.description import Arm, Joint, load
from modelgen.effects import known_effects
from modelgen.effects.editing import extended_yaml
from modelgen.errors import InputError

TEXT = """schema: 1
convention: khalil_kleinfinger
arms:
  a:
    joints:
      - {name: j1, effects: &shared [viscous_friction, coulomb_friction]}
      - {name: j2, d: 0.3, effects: *shared}
      - {name: j3, d: 0.3, effects: *shared}
"""


@pytest.mark.parametrize("joint", [1, 2, 3])
def test_a_list_of_effects_that_joints_share(tmp_path: Path, joint: int) -> None:
    file = tmp_path / "arms.yaml"
    file.write_text(TEXT, encoding="utf-8")
    (arm,) = load(file, known_effects()).values()
    cause = ("spring", joint, {"stiffness": 2.0, "preload": 0.1})
    file.write_text(extended_yaml(arm, [cause]), encoding="utf-8")
    (again,) = load(file, known_effects()).values()
    found = [[use.name for use in j.effects] for j in again.joints]
    plain = ["viscous_friction", "coulomb_friction"]
    assert found == [[*plain, "spring"] if n == joint else plain for n in (1, 2, 3)]


def test_an_arm_without_a_description_has_nowhere_to_write_it() -> None:
    with pytest.raises(InputError, match=r"arm without the text of a description.*load_arms"):
        extended_yaml(Arm("bare", (Joint("j1", "revolute"),), (None,)), [("spring", 1, {"stiffness": 1.0})])
