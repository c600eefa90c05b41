"""The how-tos are true: what each says is done in a copy of the project, and its tests pass there."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HOW_TO = ROOT / "docs" / "howto"
STEP = re.compile(
    r'<!-- (append|write|before "(?P<mark>[^"]+)"|after "(?P<anchor>[^"]+)"): (?P<file>\S+) -->\n'
    r"```\w+\n(?P<text>.*?)```",
    re.DOTALL,
)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A copy of what the how-tos touch and need."""
    for folder in ("modelgen", "templates", "tests", "cmake", "docs", "benchmarks"):
        shutil.copytree(
            ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__", "*.csv")
        )
    for file in ("pyproject.toml", "arms.yaml"):
        shutil.copy(ROOT / file, tmp_path / file)
    return tmp_path


def follow(page: str, project: Path) -> int:
    """Do what the page says; the number of its steps."""
    steps = list(STEP.finditer((HOW_TO / f"{page}.md").read_text(encoding="utf-8")))
    for step in steps:
        path, text = project / step["file"], step["text"]
        before = path.read_text(encoding="utf-8") if path.exists() else ""
        if step["mark"]:
            assert before.count(step["mark"]) == 1
            text = before.replace(step["mark"], f"{text}\n\n{step['mark']}")
        elif step["anchor"]:
            assert before.count(f"{step['anchor']}\n") == 1
            text = before.replace(f"{step['anchor']}\n", f"{step['anchor']}\n{text}")
        elif step[1] == "append":
            text = f"{before}\n\n{text}"
        else:
            assert not before
        path.write_text(text, encoding="utf-8")
    return len(steps)


def commands(page: str) -> Iterator[list[str]]:
    """What its blocks of shell say."""
    text = (HOW_TO / f"{page}.md").read_text(encoding="utf-8")
    for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
        for line in block.splitlines():
            yield line.split()


@pytest.mark.parametrize("page", [p.stem for p in sorted(HOW_TO.glob("*.md"))])
def test_what_a_how_to_says_works(page: str, project: Path) -> None:
    assert follow(page, project) > 1
    plain = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}
    environment = {**plain, "PYTHONPATH": str(project), "PYTHONDONTWRITEBYTECODE": "1"}
    count = 0
    for words in commands(page):
        module = words[2:] if words[0] == "python" else ["modelgen", *words[1:]]
        assert words[0] in ("python", "modelgen")
        more = ["-p", "no:cacheprovider"] if module[0] == "pytest" else []
        call = [sys.executable, "-m", *module, *more]
        done = subprocess.run(call, cwd=project, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, " ".join(call) + "\n" + done.stdout[-3000:] + done.stderr[-2000:]
        if module[0] == "pytest":
            assert int(re.findall(r"(\d+) passed", done.stdout)[0]) > 1
        count += 1
    assert count
    linted = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--no-cache", "modelgen", "tests"],
        cwd=project, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert linted.returncode == 0, linted.stdout[-3000:]
