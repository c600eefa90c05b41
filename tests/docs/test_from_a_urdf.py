"""The way from a URDF to a simulator works as its page says, shortened, and ends at the robot it measured."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from modelgen.cli.app import app

TEXT = (Path(__file__).resolve().parents[2] / "docs" / "from-a-urdf.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE)


def done(line: str) -> str:
    """What a command prints."""
    if line.startswith("modelgen"):
        short = line.replace("--starts 1", "--starts 1 --iterations 10 --jobs 1")
        called = CliRunner().invoke(app, shlex.split(short)[1:])
        assert called.exit_code == 0, line + called.output
        return called.stdout
    ran = subprocess.run(["sh", "-ec", line], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, line + ran.stderr
    return ran.stdout


def test_the_way_leads_from_a_urdf_to_a_simulator_that_moves_as_the_robot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if shutil.which("cc") is None or shutil.which("sh") is None:
        pytest.skip("needs a shell and a C compiler")
    monkeypatch.chdir(tmp_path)
    (source,) = blocks("xml")
    Path("picker.urdf").write_text(source, encoding="utf-8")
    printed = {line: done(line) for block in blocks("sh") for line in block.splitlines()}
    imported, _, exported, _ = blocks("text")
    assert next(out for line, out in printed.items() if "import" in line) == imported
    assert exported in next(out for line, out in printed.items() if "mjcf" in line)
    found = json.loads(Path("identified/identification.json").read_text(encoding="utf-8"))
    values = {p["name"]: p["value"] for p in found["parameters"]}
    assert values["MX3"] == pytest.approx(2.6 * (1.6 * 0.14 + 0.6 * 0.33) / 2.2, rel=1e-3)
    assert values["FC3"] == pytest.approx(0.02, rel=1e-2)
    scope: dict[str, Any] = {}
    exec(blocks("python")[0].partition("\n\nfor file")[0], scope)  # noqa: S102 - the page is ours
    assert scope["deviation"]("picker.xml", 1500) < 0.3
    assert scope["deviation"]("drawn.xml", 1500) > 10
