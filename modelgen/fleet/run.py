"""A fleet from its units to one table and one page, which goes on where it was interrupted."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from modelgen.api.results import Shown, Table
from modelgen.errors import InputError
from modelgen.fleet import store
from modelgen.fleet.diagnosing import Job, crashed, done
from modelgen.fleet.overview import causes, first_step, overview, verdicts
from modelgen.fleet.store import Row
from modelgen.fleet.table import NAME, library, write_table
from modelgen.fleet.unit_table import WORDS
from modelgen.fleet.units import Unit
from modelgen.jobs import Where, run
from modelgen.report.call import command
from modelgen.report.parts import steps

PAGE = "overview.html"
SHOWN = 10  # failures and causes that are printed
CODE = "generated"  # the folder that --code adds to a unit's
Progress = Callable[[int, int], None]


@dataclass(frozen=True, repr=False)
class Fleet(Shown):
    """rows: one per unit, in their order. kept: how many of them are of an earlier call. out: the folder.
    again: the command that makes what failed anew, empty where no file has the fleet.
    """

    rows: list[Row]
    kept: int
    out: Path
    again: str = ""

    def next_steps(self) -> Sequence[tuple[str, str]]:
        """What to do first, as on the page: sentences, each with its command, which may be empty."""
        return steps([*first_step(self.rows, self.again)])

    def to_json(self) -> dict[str, Any]:
        """Counts, failures, and where table and page are."""
        counts = verdicts(self.rows)
        named = sorted(causes(self.rows).items(), key=lambda item: (-item[1], item[0][0], item[0][1] or 0))
        return {
            "units": len(self.rows),
            "kept": self.kept,
            "verdicts": {key: counts[key] for key in WORDS},
            "causes": [
                {"effect": effect, "joint": joint, "joint_name": name or None, "units": n}
                for (effect, joint, name), n in named
            ],
            "failed": [{"unit": r["unit"], "error": r["error"]} for r in self.rows if r.get("error")],
            "cpu_seconds": round(sum(r.get("cpu_seconds") or 0.0 for r in self.rows), 1),
            "table": str(self.out / NAME),
            "overview": str(self.out / PAGE),
        }

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen fleet`."""
        said = self.to_json()
        rows = [
            [c["effect"], c["joint_name"] or "the whole arm", str(c["units"])] for c in said["causes"][:SHOWN]
        ]
        columns = {"cause": "left", "joint": "left", "units": "right"}
        left = len(said["causes"]) - len(rows)
        tables: list[str | Table] = [Table("", columns, rows)] if rows else []
        tables += [f"{left} more cause{'' if left == 1 else 's'}: see the overview"] if left else []
        return [repr(self), *tables, f"table: {said['table']}", f"overview: {said['overview']}"]

    def __repr__(self) -> str:
        said = self.to_json()
        kept = f", {said['kept']} of them from before" if said["kept"] else ""
        counts = ", ".join(f"{n} {_with(key, n)}" for key, n in said["verdicts"].items() if n)
        units = "1 unit" if said["units"] == 1 else f"{said['units']} units"
        return f"{units}{kept}: {counts}"


def _with(key: str, units: int) -> str:
    """A verdict after the number of its units."""
    words = WORDS[key]
    return words.replace("cause ", "causes ") if units > 1 else words


def diagnose_fleet(
    units: Sequence[Unit],
    out: Path,
    where: Where,
    *,
    again: bool = False,
    code: bool = False,
    progress: Progress | None = None,
    file: Path | None = None,
) -> Fleet:
    """Diagnose what is not there yet, then write fleet.parquet and overview.html into `out`.

    A unit that cannot be diagnosed gets a row with its error. A unit is there where an earlier call has made
    it of the same files with the same settings. again: make the units that failed anew. code: write the
    extended model's code of every unit. file: which has the units, for the command on the page. Raises
    InputError where nothing can be written, or the cluster is not reached or lost.
    """
    library()  # before the long work, not after it
    _prepare(out)
    try:
        found = replace(_diagnosed(units, out, where, again, code, progress), again=_again(file, out, code))
        write_table(found.rows, out / NAME)
        _write(out / PAGE, overview(found.rows, found.again))
        return found
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
    jobs = [Job(u, str(out.absolute()), code, str(out)) for u in units if u.name not in rows]
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
    return Fleet(ordered, kept, out)


def _again(file: Path | None, out: Path, code: bool) -> str:
    """The command that makes what failed anew; empty where no file has the fleet."""
    if file is None:
        return ""
    more = ["--code"] if code else []
    return command("fleet", file, "", "--out", str(out), "--again", *more)


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
