"""A fluid drags on links of different thickness by different coefficients, and each is found."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from hidden import arms, effects
from hidden.cases import Case, Hidden, make
from hidden.native import Plant
from hidden.running import diagnosed_here

# N s^2/m^3 at a magnitude of one
APART = {"thick": (60.0, 400.0, 60.0), "last": (0.0, 0.0, 60.0), "alike": (60.0, 60.0, 60.0)}


def answer(which: str, seed: int, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict:
    def drag(p: Plant, _: effects.Site, magnitude: float) -> None:
        p["drag"][:3] = magnitude * np.array(APART[which])

    monkeypatch.setitem(effects.EFFECTS, "fluid_drag", effects.Effect(drag, "outer", whole=True))
    case = Case("mixed3", seed, (Hidden("fluid_drag", 3, 2.0),))
    make(case, folder)
    description = folder / "arms.yaml"
    read = yaml.safe_load(description.read_text(encoding="utf-8"))
    (arm,) = read["arms"].values()
    # Where the arm ends is twice as far as there: as long as it is.
    arm["links"]["j3"]["com"] = [arms.STICK.length / 2, 0.0, 0.0]
    description.write_text(yaml.safe_dump(read), encoding="utf-8")
    return diagnosed_here(folder, case.name)


@pytest.mark.parametrize("seed", [822, 823])
@pytest.mark.parametrize("which", APART)
def test_a_fluid_drags_where_it_does(
    which: str, seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    causes = answer(which, seed, tmp_path / "case", monkeypatch)["causes"]
    assert {cause["effect"] for cause in causes} == {"fluid_drag"}
    size = {cause["joint"]: cause["parameters"]["coefficient"]["value"] for cause in causes}
    # One of the whole arm is that of every link, to which those of single links add.
    found = [size.get(None, 0.0) + size.get(joint, 0.0) for joint in (1, 2, 3)]
    assert found[1:] == pytest.approx(found[2] * np.array(APART[which])[1:] / APART[which][2], rel=0.2)
    if which != "thick":
        assert len(causes) == 1
