"""A wrong length of a link: effects that no motion tells apart do not explain it together."""

from __future__ import annotations

from pathlib import Path

import made_up_plants as plants
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects


@pytest.mark.parametrize("wrong", [0.9, 1.1])
def test_no_two_causes_say_the_same(wrong: float, tmp_path: Path) -> None:
    text = plants.description(2, "").replace(f"d: {plants.LENGTH}", f"d: {wrong * plants.LENGTH:.4f}")
    arm = loads(text, "arms.yaml", known_effects())["made_up"]
    logs = [str(plants.log(tmp_path / f"{k}.csv", plants.PLAIN[2], 5 + k, periods=6)) for k in range(3)]
    found = mg.diagnose(arm, logs[:2], logs[2], effects=["base_tilt", "encoder_offset"], experiment=False)
    named = [(c.effect, c.joint) for c in found.causes]
    assert not any(alias in named for c in found.causes for alias in c.aliases), found.causes
