"""The page about imports shows what the command writes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import modelgen as mg
from modelgen.cli.app import app

PAGE = (Path(__file__).parents[2] / "docs" / "importing.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    """The page's one block of a language."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    return str(found)


def test_the_page_shows_what_the_command_writes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("loader.urdf").write_text(block("xml"), encoding="utf-8")
    done = CliRunner().invoke(app, block("sh").split()[1:])
    assert done.exit_code == 0, done.output
    assert done.stdout == block("text")
    assert Path("arms.yaml").read_text(encoding="utf-8") == block("yaml")
    scope: dict[str, object] = {}
    exec(block("python"), scope)  # noqa: S102 - the page is ours
    assert scope["joint"] == "reach"
    assert mg.build_model(mg.load_arms()["loader"]).nominal is not None


def test_the_page_names_every_option() -> None:
    help_text = CliRunner().invoke(app, ["import", "--help"]).stdout
    for option in ("--root", "--tip", "--lock", "--name", "--exact"):
        assert option in help_text
        assert f"`{option}" in PAGE
