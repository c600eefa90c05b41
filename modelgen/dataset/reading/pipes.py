"""What comes through a pipe, kept in a file: a log is read more than once, a pipe only once."""

from __future__ import annotations

import os
import stat
import tempfile
from pathlib import Path
from typing import IO

_kept: dict[tuple[int, int, str], IO[bytes]] = {}


def plain_file(path: Path) -> Path:
    """The file itself, or one that holds all that its pipe gives. Raises OSError, ValueError."""
    known = path.stat()
    if not (stat.S_ISFIFO(known.st_mode) or stat.S_ISSOCK(known.st_mode)):
        return path
    key = known.st_dev, known.st_ino, os.fspath(path)
    if key not in _kept:
        file = tempfile.NamedTemporaryFile(prefix="modelgen_")  # noqa: SIM115 - as long as the process
        with path.open("rb") as stream:
            while piece := stream.read(1 << 20):
                file.write(piece)
        file.flush()
        _kept[key] = file
    return Path(_kept[key].name)
