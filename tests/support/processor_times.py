"""--processor-times FILE: seconds of processor time that each part of each test took, its commands included.

Time on the clock says how busy the machine is; a list of slow tests must not depend on it. Every thread
counts, and a command counts once it has ended.
"""

from __future__ import annotations

import os
from collections.abc import Generator
from pathlib import Path

import pytest

KEY = "processor_s"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--processor-times", metavar="FILE", help="write the processor time of each test into FILE"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Every process measures; the one that the user called writes."""
    if file := config.getoption("--processor-times"):
        config.pluginmanager.register(Measured())
        if not hasattr(config, "workerinput"):
            config.pluginmanager.register(Written(Path(file)))


def spent() -> float:
    """Seconds that this process and the commands that it waited for have taken."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Measured:
    """Adds to each report what was spent since the one before."""

    def __init__(self) -> None:
        self.before = 0.0

    def pytest_runtest_logstart(self) -> None:
        self.before = spent()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        now = spent()
        report.user_properties = [(KEY, now - self.before)]
        self.before = now
        return report


class Written:
    """Keeps what the reports say, and writes it when the run ends, the dearest first."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.rows: list[tuple[float, str, str]] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.rows += [
            (value, report.when, report.nodeid) for key, value in report.user_properties if key == KEY
        ]

    def pytest_sessionfinish(self) -> None:
        self.file.parent.mkdir(parents=True, exist_ok=True)
        rows = sorted(self.rows, reverse=True)
        self.file.write_text("".join(f"{t:.2f}s {when} {node}\n" for t, when, node in rows), encoding="utf-8")
