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

DECIMAL = re.compile(r"-?\d+(?:\.\d+(?:e-?\d+)?|e-?\d+)")  # what differs in a shortened run; no count


def shown(page_line: str, printed: str) -> bool:
    """Whether a line of the page is one that was printed: the same words and counts, decimals for others."""
    words, found = page_line.split(), printed.split()
    if words[-1] == "...":
        words = words[:-1]
        found = found[: len(words)]
    return len(words) == len(found) and all(
        a == b or bool(DECIMAL.fullmatch(a) and DECIMAL.fullmatch(b))
        for a, b in zip(words, found, strict=True)
    )


def measured(page_line: str, printed: str) -> bool:
    """Whether lines of arm-none-eabi-size have one object and, within 5 %, one flash: it holds values."""
    words, found = page_line.split(), printed.split()
    if not (words[0].isdigit() and found[0].isdigit()):
        return words == found
    return words[-1] == found[-1] and float(found[0]) == pytest.approx(float(words[0]), rel=0.05)


def not_shown(page: str, printed: str) -> list[str]:
    """Lines that the page shows and that were not printed."""
    lines = [line for line in printed.splitlines() if line.strip()]
    asked = [line for line in page.splitlines() if line.strip(" .")]
    same = measured if "filename" in page else shown
    return [line for line in asked if not any(same(line, found) for found in lines)]


def test_a_wrong_count_or_word_of_the_tutorial_is_seen() -> None:
    printed = "digger: The motion separates the 12 base parameters well: condition number 6.1 with columns\n"
    page = "digger: The motion separates the 12 base parameters well: condition number 5.54 ...\n"
    assert not not_shown(page, printed)
    assert not_shown(page.replace("12", "21"), printed)
    assert not_shown(page.replace("motion", "record"), printed)
    table = "text data bss dec hex filename\n 260 0 0 260 104 a.o\n"
    assert not not_shown(table, table.replace("260", "264"))
    assert not_shown(table, table.replace("260", "240"))


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
    assert len(blocks) == 8
    printed = []
    for block in blocks:
        after = text[text.index(block) + len(block) :].split("```sh")[0]
        if "arm-none-eabi-gcc" in block and shutil.which("arm-none-eabi-gcc") is None:
            continue
        short = block.replace("--period 20 --starts 2", "--period 10 --starts 1 --iterations 15 --jobs 1")
        short = short.replace("--no-experiment", "--no-experiment --jobs 1")
        done = subprocess.run(
            ["sh", "-ec", short],
            cwd=tmp_path, env={**os.environ, **where}, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, short + done.stderr
        printed.append(done.stdout)
        for page in re.findall(r"^```text\n(.*?)^```", after, re.DOTALL | re.MULTILINE):
            assert not not_shown(page, done.stdout + done.stderr), done.stdout + done.stderr
    held = next(line for out in printed for line in out.splitlines() if line.startswith("status"))
    assert held in text
    found = json.loads((tmp_path / "identified" / "identification.json").read_text(encoding="utf-8"))
    values = {p["name"]: p["value"] for p in found["parameters"]}
    assert found["log"]["period_s"] == pytest.approx(10)
    assert values["MX1R"] == pytest.approx(5.6 * 0.2 + 0.45 * 2, rel=1e-3)
    assert values["FC2"] == pytest.approx(0.013, rel=1e-2)
