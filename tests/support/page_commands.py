"""The commands of the pages, as a shell reads them: blocks are run with programs that only note their call.

Which of them a test runs in earnest, and why others are only parsed, stands here and nowhere else.
"""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Programs that blocks of the pages call. A block of shell that is indented begins with one of them.
PROGRAMS = (
    "modelgen", "python", "python3", "pip", "make", "cc", "sed", "awk", "dask", "frama-c",
    "arm-none-eabi-gcc", "arm-none-eabi-size", "xacro",
)  # fmt: skip
# Made by the commands of a page, and called by it.
MADE = ("self_test", "hold", "examples/mpc/build/c/loop")

# Pages whose commands a test of their own runs as they are, with what they print.
ELSEWHERE = {
    "docs/tutorial.md": "tests/docs/test_tutorial.py",
    "docs/mpc.md": "tests/docs/test_mpc_page.py",
    "docs/from-a-urdf.md": "tests/docs/test_from_a_urdf.py",
    "docs/importing.md": "tests/docs/test_importing_page.py",
    "docs/exporting.md": "tests/docs/test_exporting_page.py",
    "docs/howto/backend.md": "tests/docs/test_howto.py",
    "docs/howto/drive.md": "tests/docs/test_howto.py",
    "docs/howto/effect.md": "tests/docs/test_howto.py",
}
# Commands that are parsed and not run: page, a piece of the command, the reason.
PARSED = (
    (
        "docs/case-studies.md",
        "diagnose",
        "needs logs of others; tests/diagnosis/test_case_studies.py has them",
    ),
    ("docs/case-studies.md", "identify", "follows on a diagnosis of logs of others"),
    ("README.md", "fleet", "a diagnosis for each arm; tests/fleet runs one"),
    ("docs/fleet.md", "fleet", "a diagnosis for each arm; tests/fleet runs one"),
    ("docs/packaging.md", "--max-flash", "compiles every function; tests/packaging/test_budget.py runs it"),
    ("examples/gravity_test/README.md", "refine", "needs what gravity_run.py makes; tests/examples run it"),
    ("examples/diagnosis/README.md", "diagnose", "the command of docs/diagnosing.md"),
    ("docs/simulation.md", "refine --arm my_arm", "as README.md has it"),
    ("CONTRIBUTING.md", "--check", "all arms; tests/generation/test_generation.py holds them"),
)
# Options that make a command of the pages quick, by its name.
SHORT = {
    "excite": ("--period", "5", "--starts", "1", "--iterations", "5", "--jobs", "1"),
    "diagnose": ("--effect", "load_dependent_friction", "--no-experiment", "--jobs", "1"),
}

_NOTE = """#!/bin/sh
{{ printf '%s\\0' "$(basename "$0")" "$@"; printf '\\n\\0'; }} >> '{calls}'
"""


@dataclass(frozen=True)
class Call:
    """A command of a page: its words as the shell splits them, and what the page says that it prints."""

    page: str
    words: tuple[str, ...]
    printed: str = ""

    @property
    def reason(self) -> str:
        """Why it is parsed and not run; empty where it is run."""
        line = " ".join(self.words)
        return next((why for page, piece, why in PARSED if page == self.page and piece in line), "")


def pages() -> list[str]:
    """Paths of all pages below the project, but for what the changes were."""
    found = [*(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").glob("*/README.md")]
    return ["README.md", "CONTRIBUTING.md", *sorted(p.relative_to(ROOT).as_posix() for p in found)]


def blocks(page: str) -> list[tuple[str, str]]:
    """Blocks of shell of a page, fenced or indented, each with the block of text that follows it or ''."""
    text = (ROOT / page).read_text(encoding="utf-8")
    fence = r"^```sh\n(?P<sh>.*?)^```\n(?:\n*(?:[^\n`#].*\n)?\n*^```text\n(?P<out>.*?)^```)?"
    found = [(m["sh"], m["out"] or "") for m in re.finditer(fence, text, re.DOTALL | re.MULTILINE)]
    rest = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    for indented in re.findall(r"(?:^    \S.*\n(?:^ {4}.*\n)*)", rest, re.MULTILINE):
        lines = "\n".join(line[4:] for line in indented.splitlines())
        first = re.sub(r"^(\w+=\S+\s+)+", "", lines).split()[0]
        if first.removeprefix(".venv/bin/") in PROGRAMS or first == "mkdir":
            found.append((lines, ""))
    return found


def calls(page: str, folder: Path) -> list[Call]:
    """The commands of a page, by a shell in a folder whose programs only note how they were called."""
    noted, stubs = folder / "calls", folder / "stubs"
    stubs.mkdir()
    note = _NOTE.format(calls=noted)
    for program in (*PROGRAMS, *(Path(made).name for made in MADE)):
        (stubs / program).write_text(note, encoding="utf-8")
        (stubs / program).chmod(0o755)
    work = folder / "work"
    for place in (".venv/bin", "examples/mpc/build/c", "tests"):
        (work / place).mkdir(parents=True)
    (work / ".venv/bin/activate").touch()
    (work / "parameters").touch()
    for name in ("modelgen", "python", "pip"):
        (work / ".venv/bin" / name).symlink_to(stubs / name)
    for made in MADE:
        (work / made).symlink_to(stubs / Path(made).name)
    found = []
    for sh, printed in blocks(page):
        noted.write_bytes(b"")
        environment = {"PATH": f"{stubs}{os.pathsep}{os.environ['PATH']}", "S": "$S", "D": "$D"}
        done = subprocess.run(
            ["sh", "-euc", sh], cwd=work, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{page}: {sh}{done.stderr}"
        every = [part.split("\0") for part in noted.read_text(encoding="utf-8").split("\0\n\0") if part]
        made_here = [Call(page, tuple(words)) for words in every]
        found += [*made_here[:-1], Call(page, made_here[-1].words, printed)] if made_here else []
    return found


def lines(text: str) -> Sequence[str]:
    """Lines of what a page shows as printed, without those that only say that there is more."""
    return [line.rstrip() for line in text.splitlines() if line.strip().strip(".")]
