"""The list of slow tests: every name in it is a test, and what is in it is marked."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from slow_tests import function_of, listed, slow, without_a_test


def test_every_name_in_the_list_is_a_test(checkout: Path) -> None:
    names = listed()
    assert names
    stale = without_a_test(names, checkout)
    assert not stale, f"take out of tests/slow.txt, or rename there: {stale}"


def test_a_name_without_a_test_is_seen(tmp_path: Path) -> None:
    folder = tmp_path / "tests"
    folder.mkdir()
    (folder / "test_a.py").write_text("def test_here() -> None: ...\n", encoding="utf-8")
    there, gone, nowhere = (
        "tests/test_a.py::test_here",
        "tests/test_a.py::test_gone",
        "tests/test_b.py::test_here",
    )
    assert without_a_test([there, gone, nowhere], tmp_path) == [gone, nowhere]


def test_the_dearest_case_decides_with_its_set_up() -> None:
    first = """
0.30s call tests/test_a.py::test_two_parts[x y]@group
0.20s setup tests/test_a.py::test_two_parts[x y]@group
0.30s call tests/test_a.py::test_many[0]
0.30s call tests/test_a.py::test_many[1]
0.30s call tests/test_a.py::test_another_run_pays@group
"""
    second = "0.41s setup tests/test_a.py::test_another_run_pays@group\n"
    assert slow([first], 0.4) == ["tests/test_a.py::test_two_parts"]
    assert slow([first, second], 0.4) == [
        "tests/test_a.py::test_another_run_pays",
        "tests/test_a.py::test_two_parts",
    ]


def test_what_is_listed_is_marked(request: pytest.FixtureRequest) -> None:
    """Of the tests of this run; this one is not."""
    names = listed()
    marked = {item.nodeid for item in request.session.items if item.get_closest_marker("slow")}
    assert {i.nodeid for i in request.session.items if function_of(i.nodeid) in names} <= marked
    assert request.node.nodeid not in marked


SHARING = """
import time
import pytest


def burn(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


@pytest.fixture(scope="module")
def inner():
    burn(0.6)


@pytest.fixture(scope="module")
def outer(inner):
    burn(0.3)


@pytest.mark.parametrize("k", range(3))
def test_three_share_both(k, outer):
    burn(0.3)


def test_one_more_shares_the_inner(inner):
    pass
"""


def test_what_is_shared_counts_in_equal_parts(checkout: Path, tmp_path: Path) -> None:
    (tmp_path / "test_sharing.py").write_text(SHARING, encoding="utf-8")
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}
    environment["PYTHONPATH"] = str(checkout / "tests" / "support")
    options = ["-p", "processor_times", "-p", "no:cacheprovider", "--processor-times", "times.txt"]
    command = [sys.executable, "-m", "pytest", "-q", *options, "test_sharing.py"]
    subprocess.run(command, cwd=tmp_path, env=environment, check=True, capture_output=True)
    rows = (line.split() for line in (tmp_path / "times.txt").read_text(encoding="utf-8").splitlines())
    found = {(when, node.partition("::test_")[2]): float(time.removesuffix("s")) for time, when, node in rows}
    for k in range(3):
        assert found["setup", f"three_share_both[{k}]"] == pytest.approx(0.6 / 4 + 0.3 / 3, abs=0.05)
        assert found["call", f"three_share_both[{k}]"] == pytest.approx(0.3, abs=0.05)
    assert found["setup", "one_more_shares_the_inner"] == pytest.approx(0.6 / 4, abs=0.05)
