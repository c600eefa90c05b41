"""A law that acts on several joints is named where they agree about its size."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from blind.cases import Entry

import modelgen as mg


def answer(kind: str, folder: Path) -> dict[str, Any]:
    """To the logs of an arm of family C with a viscous friction between its joints of 1.3 times the error."""
    Entry("c", 11362493000, kind, 1.30, "two").make().write(folder)
    arm = next(iter(mg.load_arms(folder / "arms.yaml").values()))
    logs = {name: [str(p) for p in sorted(folder.glob(f"{name}*.csv"))] for name in ("train", "test")}
    found = mg.diagnose(arm, logs["train"], logs["test"], mapping=folder / "mapping.yaml", experiment=False)
    result: dict[str, Any] = found.to_json()
    return result


def form_of(cause: dict[str, Any]) -> dict[str, Any]:
    return next(check for check in cause["checks"] if check["name"] == "form")


def test_friction_of_one_joint_by_the_speed_of_another_is_no_coupling(tmp_path: Path) -> None:
    found = answer("outside:dragged_along", tmp_path)
    assert found["causes"] == []
    (suspect,) = found["suspects"]
    assert suspect["effect"] == "transmission_coupling"
    form = form_of(suspect)
    assert form["passed"] is False
    assert form["text"].startswith("a free function of the joint's speed and that of j1 explains more")


@pytest.mark.parametrize(("kind", "joint"), [("transmission_coupling", 2), ("base_tilt", None)])
def test_what_acts_on_several_joints_keeps_its_name(kind: str, joint: int | None, tmp_path: Path) -> None:
    (cause,) = answer(kind, tmp_path)["causes"]
    assert (cause["effect"], cause["joint"]) == (kind, joint)
    form = form_of(cause)
    assert form["passed"] is True
    assert form["value"] < 0.0
