"""TEST_MINUTES: minutes after which no further slow test begins, for a job that is ended at a fixed time.

Fast tests come first then. Those that do not begin are skipped, and the summary counts them; without the
variable every test runs.
"""

from __future__ import annotations

import os
import time

import pytest

BEGAN = time.monotonic()


def minutes() -> float | None:
    """The minutes that are given, None without."""
    given = os.environ.get("TEST_MINUTES")
    return float(given) if given else None


@pytest.hookimpl(trylast=True)  # once the slow tests are marked
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Fast tests first, in their order."""
    if minutes() is not None:
        items.sort(key=lambda item: item.get_closest_marker("slow") is not None)


@pytest.hookimpl(tryfirst=True)  # before fixtures are made
def pytest_runtest_setup(item: pytest.Item) -> None:
    """No slow test begins after the time."""
    given = minutes()
    if given is None or time.monotonic() < BEGAN + 60.0 * given:
        return
    if item.get_closest_marker("slow") is not None:
        pytest.skip(f"not begun within TEST_MINUTES={given:g}")
