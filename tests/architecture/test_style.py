"""What the linters do not see: the length of a module, and traces of somebody's machine."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

LONGEST_MODULE = 320  # lines

# Brackets keep the pattern from finding itself.
MACHINE = re.compile(
    r"/[h]ome/|/[r]oot/|/[w]ork/|/[U]sers/|/opt/[v]env|[A-Z]:\\[U]sers|[l]ocalhost", re.ASCII
)


def test_a_module_has_one_job(checkout: Path) -> None:
    lengths = {
        str(path.relative_to(checkout)): len(path.read_text(encoding="utf-8").splitlines())
        for folder in ("modelgen", "benchmarks")
        for path in (checkout / folder).rglob("*.py")
    }
    assert lengths
    long = {name: lines for name, lines in lengths.items() if lines > LONGEST_MODULE}
    assert not long, f"above {LONGEST_MODULE} lines, split by job: {long}"


def test_no_file_names_a_place_on_one_machine(checkout: Path) -> None:
    if shutil.which("git") is None or not (checkout / ".git").exists():
        pytest.skip("needs git and a clone: the list of tracked files")
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=checkout, check=True, capture_output=True, text=True
    )
    tracked = [checkout / name for name in listed.stdout.split("\0") if name]
    assert checkout / "pyproject.toml" in tracked
    found = [
        f"{path.relative_to(checkout)}:{number}: {line.strip()[:80]}"
        for path in tracked
        if path.is_file()
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
        if MACHINE.search(line)
    ]
    assert not found, "\n".join(found)
