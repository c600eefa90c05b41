"""The descriptions that a user may begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ruamel.yaml import YAML
from typer.testing import CliRunner

import modelgen as mg
from modelgen.cli.app import app
from modelgen.description import loads
from modelgen.description.starter import STARTERS
from modelgen.drawing import start
from modelgen.effects import known_effects

# Where the origins are at q = 0, by what the comments of the files say of that pose [m].
HOME: dict[str, dict[str, tuple[float, float, float]]] = {
    "levered": {"elbow": (0.116 + 0.45, 0.0, 0.0)},
    "direct": {"shoulder": (0.05, 0.0, 0.3), "flange": (0.05 + 0.35 + 0.3, 0.0, 0.3)},
    "industrial6": {"j3": (0.15, 0.0, 0.4 + 0.6), "flange": (0.15 + 0.62 + 0.1, 0.0, 0.4 + 0.6 + 0.12)},
    "scara": {"gripper": (0.325 + 0.275, 0.0, 0.4 - 0.08)},
    "tree": {
        "left_hand": (0.0, 0.2, 0.6 + 0.35 - 0.3 - 0.28),
        "right_hand": (0.0, -0.2, 0.6 + 0.35 - 0.3 - 0.28),
    },
}


@pytest.mark.parametrize("kind", STARTERS)
def test_a_starter_loads_without_a_remark(kind: str) -> None:
    text = mg.starter("null", kind)
    arms = loads(text, "arms.yaml", known_effects())
    assert list(arms) == ["null"]  # YAML reads the bare word as a value
    assert arms["null"].notes == ()
    assert None not in arms["null"].links
    assert max(map(len, text.splitlines())) <= 120


def test_every_starter_has_its_pose_tested() -> None:
    assert set(HOME) == set(STARTERS)


@pytest.mark.parametrize("kind", STARTERS)
def test_a_starter_stands_where_its_comments_say_and_can_be_simulated(kind: str) -> None:
    (arm,) = loads(mg.starter("arm", kind), "arms.yaml", known_effects()).values()
    model = mg.build_model(arm)
    names = [*(joint.name for joint in arm.joints), *(tool.name for tool in arm.tools)]
    poses = model.functions["forward_kinematics"](np.zeros((1, len(arm.coordinates))))
    found = {name: pose[0, :3, 3] for name, pose in zip(names, poses, strict=True)}
    for name, place in HOME[kind].items():
        np.testing.assert_allclose(found[name], place, atol=1e-12)
    limits = [arm.joints[i].limits for i in arm.coordinates]
    assert all(x.position is not None and x.velocity is not None for x in limits)  # a motion can be sought
    motion = mg.simulate(arm, q0=start(arm), duration=0.1, rate=200)
    assert motion.ended == ""


def test_the_schema_knows_every_starter() -> None:
    jsonschema: Any = pytest.importorskip("jsonschema")
    schema = mg.description.json_schema(known_effects())
    for kind in STARTERS:
        jsonschema.validate(YAML(typ="safe").load(mg.starter("arm", kind)), schema)


def test_init_offers_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["init", "picker", "--from", "scara"])
    assert done.exit_code == 0, done.output
    assert Path("arms.yaml").read_text(encoding="utf-8") == mg.starter("picker", "scara")
    done = CliRunner().invoke(app, ["init", "picker", "--from", "skara", "--out", "other.yaml"])
    assert done.exit_code == 2
    assert done.stderr.startswith("--from: there is no 'skara', did you mean 'scara'?")
    assert not Path("other.yaml").exists()
    shown = CliRunner().invoke(app, ["init", "--help"]).stdout
    assert all(kind in shown for kind in STARTERS)
