"""The Python on the pages and in the notebook runs as it stands, and does what the text says."""

from __future__ import annotations

import ast
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
NOTEBOOK = ROOT / "examples" / "notebook.ipynb"


def blocks(text: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def run(code: str, folder: Path) -> str:
    """What a program prints that runs in a folder."""
    (folder / "program.py").write_text(code, encoding="utf-8")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    done = subprocess.run(
        [sys.executable, "program.py"],
        cwd=folder, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


def test_the_page_goes_from_a_data_frame_to_c_code(tmp_path: Path) -> None:
    (described,) = blocks(PAGE, "yaml")
    (tmp_path / "arms.yaml").write_text(described, encoding="utf-8")
    checks = """
(cause,) = diagnosis.causes
assert diagnosis.verdict == "named" and (cause.effect, cause.joint) == ("spring", 2)
stiffness = cause.parameters["stiffness"]
assert abs(stiffness.value - 8) < 4 * stiffness.std
assert found.test.nrmse_percent[1] > 10 and diagnosis.found.errors.gain[1] > 90
assert abs(diagnosis.parameters["MX1R"].value - 1.7) < 4 * diagnosis.parameters["MX1R"].std
"""
    printed = run("\n".join([*blocks(PAGE, "python"), checks]), tmp_path)
    for text in blocks(PAGE, "text"):
        assert text in printed
    header = (tmp_path / "generated" / "digger" / "include" / "digger.h").read_text(encoding="utf-8")
    assert "digger_inverse_dynamics_identified(" in header
    assert json.loads((tmp_path / "diagnosis" / "diagnosis.json").read_text("utf-8"))["verdict"] == "named"


def test_the_python_of_the_readme_runs(tmp_path: Path) -> None:
    (code,) = blocks((ROOT / "README.md").read_text(encoding="utf-8"), "python")
    # The experiment that would come next takes most of the time, and the text does not speak of it.
    code = code.replace('test.csv")', 'test.csv", experiment=False)')
    assert "experiment" in code
    shutil.copytree(ROOT / "examples" / "diagnosis", tmp_path / "examples" / "diagnosis")
    (said,) = re.findall(r"print\(found\)  # (.*) \.\.\.", code)
    assert "load_dependent_friction at stick" in said
    assert said in run(code, tmp_path)
    assert (tmp_path / "build" / "digger" / "report.html").exists()


def cells() -> list[dict[str, object]]:
    found = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    return [cell for cell in found["cells"] if cell["cell_type"] == "code"]


def test_the_notebook_runs_and_shows_tables(tmp_path: Path) -> None:
    # Its cells one after the other, the last expression shown as a notebook shows it: no kernel is needed.
    programs = []
    for cell in cells():
        tree = ast.parse("".join(cell["source"]))  # type: ignore[arg-type]
        if isinstance(tree.body[-1], ast.Expr):
            tree.body[-1] = ast.parse(f"shown({ast.unparse(tree.body[-1])})").body[0]
        programs.append(ast.unparse(tree))
    show = "def shown(x):\n    print(x._repr_html_() if hasattr(x, '_repr_html_') else repr(x))\n"
    folder = tmp_path / "examples"
    shutil.copytree(ROOT / "examples" / "diagnosis", folder / "diagnosis")
    printed = run("\n".join([show, *programs]), folder)
    assert printed.count("<table>") >= 4


def test_the_notebook_holds_no_outputs_and_no_date() -> None:
    found = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells())
    assert set(found["metadata"]) <= {"kernelspec", "language_info"}
    assert not re.search(
        r"/(home|root|tmp|Users)\b|\b20\d\d-\d\d-\d\d\b", NOTEBOOK.read_text(encoding="utf-8")
    )
    assert found["nbformat"] == 4


def test_the_blocks_of_the_page_are_formatted(tmp_path: Path) -> None:
    for number, block in enumerate(blocks(PAGE, "python")):
        (tmp_path / f"block_{number}.py").write_text(block, encoding="utf-8")
    call = [sys.executable, "-m", "ruff", "format", "--check", "--no-cache", "--line-length", "110"]
    done = subprocess.run([*call, str(tmp_path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
