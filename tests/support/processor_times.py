"""--processor-times FILE: seconds of processor time that each part of each test took, its commands included.

Time on the clock says how busy the machine is; a list of slow tests must not depend on it. Every thread
counts, and a command counts once it has ended. A fixture that tests share counts in equal parts for all of
them, not for the first.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any, TypeAlias

import pytest

KEY = "processor_s"

# A fixture of a wider scope than a test, and the value of its parameter.
Shared: TypeAlias = tuple[int, str]


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


def shared(item: pytest.Item) -> Iterator[Shared]:
    """What a test shares with others."""
    given = item.callspec.params if hasattr(item, "callspec") else {}
    info = getattr(item, "_fixtureinfo", None)
    for name, found in info.name2fixturedefs.items() if info else ():
        if found[-1].scope != "function":
            yield id(found[-1]), repr(given.get(name))


class Measured:
    """Adds to each report what was spent since the one before."""

    def __init__(self) -> None:
        self.before = 0.0
        self.within = 0.0  # of it for what is shared
        self.costs: dict[Shared, float] = {}
        self.users: Counter[Shared] = Counter()

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.users.update(key for item in session.items for key in shared(item))

    def pytest_runtest_logstart(self) -> None:
        self.before, self.within = spent(), 0.0

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[Any], request: pytest.FixtureRequest
    ) -> Generator[None, object, object]:
        if fixturedef.scope == "function":
            return (yield)
        begin, before = spent(), self.within
        self.within = 0.0
        try:
            return (yield)
        finally:
            whole = spent() - begin
            self.costs[id(fixturedef), repr(getattr(request, "param", None))] = whole - self.within
            self.within = before + whole

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        now = spent()
        own = now - self.before - self.within
        if report.when == "setup":
            own += sum(self.costs.get(key, 0.0) / self.users[key] for key in shared(item))
        report.user_properties = [(KEY, own)]
        self.before, self.within = now, 0.0
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
