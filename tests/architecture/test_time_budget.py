"""A job that is ended at a fixed time runs the fast tests first, and says which slow ones it left out."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = """
import pytest

@pytest.mark.slow
def test_first(): pass

def test_second(): pass
"""
SUPPORT = Path(__file__).resolve().parents[1] / "support"


@pytest.mark.parametrize(
    ("given", "order"),
    [
        ({}, "test_first PASSED test_second PASSED"),
        ({"TEST_MINUTES": "0"}, "test_second PASSED test_first SKIPPED"),
    ],
)
def test_slow_tests_after_the_time_are_skipped(given: dict[str, str], order: str, tmp_path: Path) -> None:
    (tmp_path / "test_two.py").write_text(TESTS)
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = slow\n")
    own = {name: value for name, value in os.environ.items() if not name.startswith(("TEST_M", "PYTEST"))}
    ended = subprocess.run(
        [sys.executable, "-m", "pytest", "-v", "-p", "time_budget", "-p", "no:cacheprovider", "."],
        cwd=tmp_path,
        env={**own, "PYTHONPATH": str(SUPPORT), **given},
        capture_output=True,
        text=True,
        check=True,
    )
    lines = [line.split("::")[1].split() for line in ended.stdout.splitlines() if "::" in line]
    assert " ".join(" ".join(words[:2]) for words in lines) == order
