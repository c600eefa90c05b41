"""Libraries that some kinds of logs need, and how to install them from where the user stands."""

from __future__ import annotations

from modelgen.errors import InputError

# As in pyproject.toml, where a test holds them; the names alone are on an index, modelgen may not be.
NEEDED = {"mcap": "mcap>=1.1,<2", "pyarrow": "pyarrow>=15", "rosbags": "rosbags>=0.10"}


def missing(what: str, library: str) -> InputError:
    """The message for a library that is not installed. what: "PATH: Parquet needs"."""
    base = library.partition(".")[0]
    return InputError(f"{what} {base}: pip install '{NEEDED.get(base, base)}'")
