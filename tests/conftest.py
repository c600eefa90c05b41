"""Settings that every test shares: one thread per worker, and the same examples in every run."""

import os
from pathlib import Path

import hypothesis
import pytest

# pytest-xdist already fills the cores. NumPy's libraries read this when they are loaded, after this file.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

# A command that is slow on a busy machine says no more than on an idle one.
os.environ.setdefault("MODELGEN_PROGRESS", "0")

hypothesis.settings.register_profile("reproducible", derandomize=True, deadline=None)
hypothesis.settings.load_profile("reproducible")


@pytest.fixture(scope="session")
def checkout() -> Path:
    """The folder that holds pyproject.toml."""
    return Path(__file__).resolve().parent.parent
