"""Libraries that only some tasks need, and how to install them from where the user stands."""

from __future__ import annotations

from modelgen.errors import InputError

# As in pyproject.toml, where a test holds them; the names alone are on an index, modelgen may not be.
LOGS = {"mcap": "mcap>=1.1,<2", "pyarrow": "pyarrow>=15", "rosbags": "rosbags>=0.10"}
DASK = {"distributed": "dask[distributed]>=2024.1"}
_NEEDED = LOGS | DASK


def missing(what: str, library: str) -> InputError:
    """The message for a library that is not installed. what: "PATH: Parquet needs"."""
    base = library.partition(".")[0]
    return InputError(f"{what} {base}: pip install '{_NEEDED.get(base, base)}'")
