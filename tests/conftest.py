"""Settings that every test shares: one thread per worker, and the same examples in every run."""

import gc
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest
from slow_tests import function_of, listed

from modelgen.cli.collection import collect_rarely

pytest_plugins = ["processor_times", "time_budget"]

# pytest-xdist already fills the cores. NumPy's libraries read this when they are loaded, after this file.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

# A command that is slow on a busy machine says no more than on an idle one.
os.environ.setdefault("MODELGEN_PROGRESS", "0")

# Models and imports are objects by the hundred thousand that stay: Python looks for cycles among them
# as rarely as in a command.
collect_rarely()

hypothesis.settings.register_profile("reproducible", derandomize=True, deadline=None)
hypothesis.settings.load_profile("reproducible")


@pytest.hookimpl(tryfirst=True)  # before pytest chooses by mark and pytest-xdist adds groups to the ids
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What tests/slow.txt lists is marked slow."""
    names = listed()
    for item in items:
        if function_of(item.nodeid) in names:
            item.add_marker(pytest.mark.slow)


def pytest_collection_finish() -> None:
    """What is imported and collected stays, and is not looked through again."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session")
def checkout() -> Path:
    """The folder that holds pyproject.toml."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture(autouse=True)
def _no_width(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a command prints does not depend on the terminal that the tests run in."""
    monkeypatch.delenv("COLUMNS", raising=False)


@pytest.fixture(scope="module", autouse=True)
def _closed_browser() -> Iterator[None]:
    """The tests of a module share a browser, and none stays open for the next module."""
    yield
    if support := sys.modules.get("browser_support"):
        support.close()
