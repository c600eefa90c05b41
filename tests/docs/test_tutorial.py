"""The tutorial's commands work, shortened, and find what its simulated arm hides."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "tutorial.md"


def test_the_tutorial_leads_from_a_description_to_firmware(tmp_path: Path) -> None:
    if shutil.which("cc") is None or shutil.which("sh") is None:
        pytest.skip("needs a shell and a C compiler")
    text = PAGE.read_text(encoding="utf-8")
    (tmp_path / "hold.c").write_text(re.findall(r"```c\n(.*?)```", text, re.DOTALL)[0], encoding="utf-8")
    commands = tmp_path / "bin"
    commands.mkdir()
    (commands / "modelgen").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m modelgen "$@"\n')
    (commands / "modelgen").chmod(0o755)
    where = {
        "PATH": f"{commands}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join([str(PAGE.parents[1]), os.environ.get("PYTHONPATH", "")]),
    }
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 7
    printed = []
    for block in blocks:
        if "arm-none-eabi-gcc" in block and shutil.which("arm-none-eabi-gcc") is None:
            continue
        short = block.replace("--period 20 --starts 2", "--period 10 --starts 1 --iterations 15 --jobs 1")
        done = subprocess.run(
            ["sh", "-ec", short],
            cwd=tmp_path, env={**os.environ, **where}, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, short + done.stderr
        printed.append(done.stdout)
    held = next(line for out in printed for line in out.splitlines() if line.startswith("status"))
    assert held in text
    found = json.loads((tmp_path / "identified" / "identification.json").read_text(encoding="utf-8"))
    values = {p["name"]: p["value"] for p in found["parameters"]}
    assert values["MX1R"] == pytest.approx(5.6 * 0.2 + 0.45 * 2, rel=1e-3)
    assert values["FC2"] == pytest.approx(0.013, rel=1e-2)
