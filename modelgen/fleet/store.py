"""The store keeps a folder per unit, which appears whole, with a row that says what it was made from."""

from __future__ import annotations

import hashlib
import json
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from modelgen.dataset.reading.specs import parse
from modelgen.errors import InputError
from modelgen.fleet.units import Unit
from modelgen.version import __version__

FORM = 6  # of the rows: another number makes every unit anew
ROW = "unit.json"
_NEW, _OLD = ".new", ".old"

Row = dict[str, Any]


def folder(out: Path, name: str) -> Path:
    """Return the folder of a unit's files."""
    return out / "units" / name


def fingerprint(unit: Unit) -> str:
    """Hash of all that a unit's result follows from. Raises InputError where a file cannot be read."""
    files = [unit.description, *([unit.mapping] if unit.mapping else [])]
    said = {
        "form": FORM,
        "modelgen": __version__,
        "arm": unit.arm,
        "numbers": [unit.cutoff, unit.period],
        "files": [[text, parse(unit.path(text)).content()] for text in files],
        "train": [[text, parse(unit.path(text)).content()] for text in unit.train],
        "test": [[text, parse(unit.path(text)).content()] for text in unit.test],
    }
    return hashlib.sha256(json.dumps(said).encode()).hexdigest()


def kept(unit: Unit, out: Path) -> Row | None:
    """The unit's row where it has been made of the same files before; None else."""
    found = read(out, unit.name)
    if found is None or found["fingerprint"] is None:
        return None
    try:
        same = found["fingerprint"] == fingerprint(unit)
    except InputError:
        return None
    row: Row = found["row"]
    return row if same else None


def read(out: Path, name: str) -> dict[str, Any] | None:
    """Read a unit's folder; None where it is absent or cannot be read."""
    try:
        found = json.loads((folder(out, name) / ROW).read_text(encoding="utf-8"))
        return found if found["form"] == FORM and {"fingerprint", "row"} <= found.keys() else None
    except (OSError, ValueError, TypeError, KeyError):
        return None


@contextmanager
def written(out: Path, name: str) -> Iterator[Path]:
    """A new folder that takes the place of the unit's when the context ends well. Raises InputError."""
    target = folder(out, name)
    # Two may be at it: a cluster goes on with a job whose call has been interrupted.
    own = uuid.uuid4().hex
    new, old = (target.with_name(f".{name}.{own}{ending}") for ending in (_NEW, _OLD))
    try:
        new.mkdir(parents=True)
        yield new
        if target.exists():
            target.rename(old)
        new.rename(target)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error
    finally:
        for left in (new, old):
            shutil.rmtree(left, ignore_errors=True)


def keep(into: Path, row: Row, made_of: str | None) -> None:
    """Write a unit's row. made_of: its fingerprint, None where it is to be made anew by the next call."""
    text = json.dumps({"form": FORM, "fingerprint": made_of, "row": row}, indent=2, allow_nan=False)
    (into / ROW).write_text(text + "\n", encoding="utf-8", newline="\n")


def swept(out: Path) -> None:
    """Take away what an earlier call was writing when it was killed."""
    for ending in (_NEW, _OLD):
        for left in (out / "units").glob(f".*{ending}"):
            shutil.rmtree(left, ignore_errors=True)
