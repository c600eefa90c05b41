"""A fleet from its units to one table and one page, taken up again where it was left."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from modelgen.errors import InputError
from modelgen.fleet import store
from modelgen.fleet.diagnosing import Job, crashed, done
from modelgen.fleet.overview import overview
from modelgen.fleet.store import Row
from modelgen.fleet.table import NAME, library, write_table
from modelgen.fleet.units import Unit
from modelgen.jobs import Where, run

PAGE = "overview.html"
CODE = "generated"  # the folder that --code adds to a unit's
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Fleet:
    """rows: one per unit, in their order. kept: how many of them are of an earlier call."""

    rows: list[Row]
    kept: int


def diagnose_fleet(
    units: Sequence[Unit],
    out: Path,
    where: Where,
    *,
    again: bool = False,
    code: bool = False,
    progress: Progress | None = None,
) -> Fleet:
    """Diagnose what is not there yet, then write fleet.parquet and overview.html into `out`.

    A unit that cannot be diagnosed gets a row with its error. A unit is there where an earlier call has made
    it of the same files with the same settings. again: make the units that failed anew. code: write the
    extended model's code of every unit. Raises InputError where nothing can be written, or the cluster is
    not reached or lost.
    """
    library()  # before the long work, not after it
    _prepare(out)
    try:
        return _diagnosed(units, out, where, again, code, progress)
    finally:
        store.swept(out)  # of processes that were ended by an interruption
        for left in (out / "units", out):  # where nothing came of it
            with contextlib.suppress(OSError):
                left.rmdir()


def _diagnosed(
    units: Sequence[Unit], out: Path, where: Where, again: bool, code: bool, progress: Progress | None
) -> Fleet:
    found = {u.name: store.kept(u, out) for u in units}
    rows = {
        name: row
        for name, row in found.items()
        if row and (not again if row.get("error") else not code or (store.folder(out, name) / CODE).is_dir())
    }
    kept = len(rows)
    jobs = [Job(u, str(out.absolute()), code) for u in units if u.name not in rows]
    if progress:
        progress(kept, len(units))
    for _, row in run(done, jobs, where, crashed):
        name = row["unit"]
        made = store.read(out, name)
        if made is None or made["row"] != row:
            raise InputError(
                f"{store.folder(out, name)}: not there, though a worker has written it; the workers of a "
                "cluster must see the same folders"
            )
        rows[name] = row
        if progress:
            progress(len(rows), len(units))
    ordered = [rows[u.name] for u in units]
    write_table(ordered, out / NAME)
    _write(out / PAGE, overview(ordered))
    return Fleet(ordered, kept)


def _prepare(out: Path) -> None:
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    try:
        (out / "units").mkdir(parents=True, exist_ok=True)
        store.swept(out)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error


def _write(path: Path, text: str) -> None:
    new = path.with_name(f".{path.name}.new")
    try:
        new.write_text(text, encoding="utf-8", newline="\n")
        new.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error
