"""The extended description: what several joints share stays as it was for the others."""

from pathlib import Path

import pytest

from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.effects.editing import extended_yaml

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
