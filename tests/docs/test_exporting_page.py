"""The page about exports shows what the command prints."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from command_support import called

PAGE = (Path(__file__).parents[2] / "docs" / "exporting.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    """The page's one block of a language."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    return str(found)


def test_the_page_shows_what_the_command_prints(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = called(*block("sh").split()[1:])
    assert done.returncode == 0, done.stderr
    assert done.stdout == block("text")
    written = Path("gravity_arm.xml").read_text(encoding="utf-8")
    scope: dict[str, object] = {}
    exec(block("python"), scope)  # noqa: S102 - the page is ours
    assert Path("gravity_arm.xml").read_text(encoding="utf-8") == written


def test_the_page_names_every_option() -> None:
    help_text = called("export", "--help").stdout
    for option in ("--to", "--out", "--parameters", "--json"):
        assert option in help_text
        assert f"`{option}" in PAGE
