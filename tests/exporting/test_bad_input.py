"""What cannot be exported is refused in one line, and nothing is written."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from command_support import called

import modelgen as mg

ARMS = Path(__file__).parents[2] / "arms.yaml"
ARM = mg.load_arms(ARMS)["gravity_arm"]


def test_a_link_without_inertials_is_named_with_what_to_do() -> None:
    bare = replace(ARM, links=(ARM.links[0], None))
    with pytest.raises(mg.InputError, match=r"link j2 has no mass.*`links`.*--parameters"):
        mg.export(bare, to="mjcf")


def test_an_inertia_that_mujoco_refuses_is_named() -> None:
    link = ARM.links[1]
    assert link is not None
    impossible = replace(ARM, links=(ARM.links[0], replace(link, inertia=(0.01, 0, 0, 0.01, 0, 0.5))))
    with pytest.raises(mg.InputError, match="link j2: its largest principal moment"):
        mg.export(impossible, to="mjcf")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--to", "mjfc", "--out", "x.xml"), "did you mean 'mjcf'?"),
        (("--to", "mjcf", "--out", "x.xml", "--fmi", "3.0"), "only --to fmu has a version of FMI"),
        (("--to", "fmu", "--out", "x.xml", "--fmi", "1.0"), "expected 2.0 or 3.0"),
        (("--to", "mjcf", "--out", "none/x.xml"), "there is no folder none"),
        (("--to", "mjcf", "--out", "."), "found a folder"),
        (("--to", "mjcf", "--out", "x.xml", "--parameters", "none.yaml"), "no such file"),
        (("--to", "mjcf", "--out", "x.xml", "--parameters", "other.yaml"), "belongs to the arm 'other'"),
        (("--to", "mjcf", "--out", "x.xml", "--parameters", "few.yaml"), "is missing"),
    ],
)
def test_the_command_says_what_is_wrong(
    words: tuple[str, ...], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "other.yaml").write_text("schema: 1\narm: other\nparameters: {A: 1}\n", encoding="utf-8")
    (tmp_path / "few.yaml").write_text(
        "schema: 1\narm: gravity_arm\nparameters: {FV1: 1}\n", encoding="utf-8"
    )
    result = called("export", str(ARMS), "--arm", "gravity_arm", *words)
    assert result.returncode == 2
    assert message in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "x.xml").exists()


def test_the_command_writes_what_the_function_gives(tmp_path: Path) -> None:
    out = tmp_path / "arm.xml"
    result = called("export", str(ARMS), "--arm", "gravity_arm", "--to", "mjcf", "--out", str(out), "--json")
    assert result.returncode == 0
    found = mg.export(ARM, to="mjcf")
    assert out.read_text(encoding="utf-8") == found.text
    assert json.loads(result.stdout) == json.loads(json.dumps(found.to_json()))
