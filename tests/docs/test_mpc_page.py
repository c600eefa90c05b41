"""The page about MPC shows what its commands and its Python print, and its plan holds for the model."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "mpc.md").read_text(encoding="utf-8")

# The plan of the page against SciPy's integrator and the NumPy functions, which CasADi has no part in.
CHECKS = """
import modelgen as mg
from scipy.integrate import solve_ivp

model = mg.build_model(mg.load_arms("smooth.yaml")["digger"])
dynamics = model.functions["forward_dynamics"]
nominal = np.array(digger.NOMINAL_PARAMETERS)
state = begin
for held in currents.T:
    def rates(t, x):
        given = {"q": x[None, :2], "dq": x[None, 2:], "input": held[None]}
        return np.concatenate([x[2:], np.asarray(dynamics(**given, parameters=nominal)).ravel()])

    state = solve_ivp(rates, (0, h), state, rtol=1e-8, atol=1e-9).y[:, -1]
assert abs(state - goal).max() < 0.01, state
assert abs(states[:, 0] - goal).max() > 0.19
assert abs(currents).max() <= 3 + 1e-6
assert plan.stats()["success"]
"""


def blocks(language: str) -> list[str]:
    """The page's blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


def run(folder: Path, *words: str) -> str:
    """What a program prints that runs in a folder with this modelgen."""
    paths = [str(ROOT), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    environment["PATH"] = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


def test_the_page_goes_from_a_description_to_a_plan(tmp_path: Path) -> None:
    (tmp_path / "bin").mkdir()
    command = tmp_path / "bin" / "modelgen"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m modelgen "$@"\n', encoding="utf-8")
    command.chmod(0o755)
    run(tmp_path, "sh", "-ec", blocks("sh")[0])
    code = "\n".join([*blocks("python"), CHECKS])
    (tmp_path / "program.py").write_text(code, encoding="utf-8")
    assert run(tmp_path, sys.executable, "program.py") == "".join(blocks("text"))


def test_the_blocks_of_the_page_are_formatted(tmp_path: Path) -> None:
    for number, block in enumerate(blocks("python")):
        (tmp_path / f"block_{number}.py").write_text(block, encoding="utf-8")
    run(
        tmp_path, sys.executable, "-m", "ruff", "format", "--check", "--no-cache", "--line-length", "110", "."
    )
