"""What comes through a pipe, or compressed, kept in a file: a log is read more than once, a pipe once."""

from __future__ import annotations

import gzip
import os
import stat
import tempfile
import zlib
from pathlib import Path
from typing import IO

_kept: dict[tuple[int, int, int, str], IO[bytes]] = {}


def plain_file(path: Path) -> Path:
    """The file itself, or one that holds all that its pipe gives, or what is compressed in it (.gz).

    Raises OSError, ValueError.
    """
    known = path.stat()
    piped = stat.S_ISFIFO(known.st_mode) or stat.S_ISSOCK(known.st_mode)
    packed = path.suffix.lower() == ".gz" and not piped
    if not piped and not packed:
        return path
    key = known.st_dev, known.st_ino, 0 if piped else known.st_mtime_ns, os.fspath(path)
    if key not in _kept:
        file = tempfile.NamedTemporaryFile(prefix="modelgen_")  # noqa: SIM115 - as long as the process
        with gzip.open(path) if packed else path.open("rb") as stream:
            try:
                while piece := stream.read(1 << 20):
                    file.write(piece)
            except (EOFError, zlib.error):
                raise ValueError("the compressed file ends too early, or is damaged") from None
        file.flush()
        _kept[key] = file
    return Path(_kept[key].name)
