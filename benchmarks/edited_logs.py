"""Random bytes in a log or its mapping, through `modelgen identify` or `inspect`: an answer, or a plain no.

    python benchmarks/edited_logs.py COUNT [--first 0] [--kind csv] [--command identify] [--results FILE]

A log of 1000 rows as CSV, Parquet or MCAP, or the mapping file of the CSV, gets one to three edits of a few
bytes each, of odd seeds digits for others, which no reader of tables can see. What becomes of it:

    refused    one line
    remarked   a remark, a question or a count of missing readings that is not there without the edits
    right      identify: the same record, or no parameter beyond five of the deviations that it claims of its
               value without the edits; inspect: no column has the readings of another
    wrong      else, without a word

A record that is the same makes the same numbers: parameters are found of the others alone. With --results a
line per case is kept, and a run that was stopped is taken up where it stood. Exit status 1 where a case is
wrong, of several lines, or a fault.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
from deviations import Encoder, arm, log

import modelgen as mg

FAR = 5.0  # deviations
EVERY = 5  # rows of the log of `deviations.py`: 100 Hz
NEAR = 0.02  # of a column's range, to which quantiles of it are the same
PIECES = [b"", b",", b";", b"\n", b"\t", b'"', b"\x00", b"\xff", b"-", b"e", b".", b" ", b"#", b"1", b"9"]
KINDS = ("csv", "parquet", "mcap", "mapping")
COMMANDS = ("identify", "inspect")
FAULTS = ("wrong", "lines", "fault")
MAPPING = """schema: 1
time: {{column: {0}t, unit: s}}
hold: instant
joints:
  - {{position: {{column: {0}q1, unit: rad}}, effort: {{column: {0}i1, unit: A}}}}
  - {{position: {{column: {0}q2, unit: rad}}, effort: {{column: {0}i2, unit: A}}}}
"""


def edited(data: bytes, seed: int) -> bytes:
    """The bytes with one to three pieces put in the place of others, of odd seeds digits alone."""
    random = np.random.default_rng(seed)
    code = np.frombuffer(data, np.uint8)
    digits = np.flatnonzero((code >= ord("0")) & (code <= ord("9"))) if seed % 2 else ()
    for _ in range(random.integers(1, 4)):
        if len(digits):
            place = int(digits[random.integers(len(digits))])
            data = data[:place] + b"%d" % random.integers(10) + data[place + 1 :]
            continue
        place, length = int(random.integers(0, len(data) + 1)), int(random.choice([0, 1, 1, 2, 9]))
        data = data[:place] + PIECES[random.integers(len(PIECES))] + data[place + length :]
    return data


def written(path: Path, table: dict[str, np.ndarray]) -> None:
    """The table as a file of the kind that its name says."""
    if path.suffix == ".csv":
        rows = np.column_stack(list(table.values()))
        np.savetxt(path, rows, fmt="%.7f", delimiter=",", header=",".join(table), comments="")
    elif path.suffix == ".parquet":
        import pyarrow  # noqa: PLC0415 - not needed for the others
        from pyarrow import parquet  # noqa: PLC0415

        parquet.write_table(pyarrow.table(table), path, write_page_checksum=True)
    else:
        from mcap.writer import Writer  # noqa: PLC0415

        with path.open("wb") as stream:
            writer = Writer(stream, chunk_size=8000)
            writer.start()
            schema = writer.register_schema(name="any", encoding="jsonschema", data=b"{}")
            topic = writer.register_channel("/a", "json", schema)
            for row in zip(*table.values(), strict=True):
                message = json.dumps(dict(zip(table, map(float, row), strict=True))).encode()
                writer.add_message(topic, round(1e9 * row[0]), message, round(1e9 * row[0]))
            writer.finish()  # type: ignore[no-untyped-call]


class Subject:
    """A log with its mapping, the bytes that are edited, and what it gives without edits."""

    def __init__(self, folder: Path, kind: str, command: str) -> None:
        self.arm, model = arm(), mg.build_model(arm())
        thin = [{k: x[::EVERY] for k, x in log(model, Encoder(16), seed).items()} for seed in (0, 1)]
        self.log = folder / f"train.{'csv' if kind == 'mapping' else kind}"
        written(self.log, thin[0])
        self.mapping = None if kind in ("csv", "parquet") else folder / "mapping.yaml"
        if self.mapping is not None:
            self.mapping.write_text(MAPPING.format("/a." if kind == "mcap" else ""), encoding="utf-8")
        self.edited = self.mapping if kind == "mapping" and self.mapping is not None else self.log
        self.data = self.edited.read_bytes()
        self.test = mg.read_log(thin[1], self.arm)
        self.judged: Callable[[], str] = self._identified if command == "identify" else self._inspected
        if command == "identify":
            self.record = mg.read_log(str(self.log), self.arm, mapping=self.mapping)
            self.whole = mg.identify(self.arm, [self.record], self.test)
            self.remarks = self._said(self.whole)
        else:
            # of a mapping what it makes of the log, else the log's own columns
            self.read_with = self.mapping if kind == "mapping" else None
            self.seen = mg.inspect_log(str(self.log), mapping=self.read_with)
            self.quantiles = {name: _quantiles(x) for name, x in self.seen.found.columns.items()}

    def verdict(self, seed: int) -> str:
        """What becomes of the log with the edits of a seed, in a word and a sentence."""
        self.edited.write_bytes(edited(self.data, seed))
        try:
            return self.judged()
        except mg.InputError as error:
            return f"refused {error}" if "\n" not in str(error) else f"lines {str(error)!r}"
        except Exception as error:  # whatever is none of ours is a fault
            return f"fault {type(error).__name__}: {' '.join(str(error).split())}"

    def _said(self, found: mg.Identification) -> set[str]:
        """Remarks without the file's name, and doubts."""
        data = found.to_json()
        return {r.replace(str(self.log), "") for r in [*data["log"]["remarks"], *data.get("doubts", [])]}

    def _identified(self) -> str:
        record = mg.read_log(str(self.log), self.arm, mapping=self.mapping)
        if {r.replace(str(self.log), "") for r in record.remarks} - self.remarks:
            return f"remarked {record.remarks[0]}"
        if record.hold == self.record.hold and all(
            np.array_equal(x, self.record.columns[name]) for name, x in record.columns.items()
        ):
            return "right the same record"
        found = mg.identify(self.arm, [record], self.test)
        new = self._said(found) - self.remarks
        far, name = max(
            (abs(e.value - w.value) / np.hypot(e.std, w.std), name)
            for name, e in found.parameters.items()
            if (w := self.whole.parameters[name]).std and e.std
        )
        word = "remarked" if new else "wrong" if far > FAR else "right"
        return f"{word} {name} {far:.2g} deviations away {sorted(new)[:1]}"

    def _inspected(self) -> str:
        found = mg.inspect_log(str(self.log), mapping=self.read_with)
        missing = any(c.missing for c in found.channels)
        if set(found.to_json()["remarks"]) - set(self.seen.to_json()["remarks"]) or missing:
            return "remarked"
        if found.found.without_numbers or found.found.backwards:
            return "remarked columns without numbers, or time that runs backwards"
        for name, values in found.found.columns.items():
            if name in self.quantiles and not _alike(_quantiles(values), self.quantiles[name]):
                other = [o for o, known in self.quantiles.items() if _alike(_quantiles(values), known)]
                return f"wrong {name} has other readings than before, those of {other}"
        return f"right {len(found.channels)} columns"


def _quantiles(values: np.ndarray) -> np.ndarray:
    return np.asarray(np.nanquantile(values, (0.1, 0.5, 0.9)))


def _alike(one: np.ndarray, other: np.ndarray) -> bool:
    return bool((np.abs(one - other) <= NEAR * (other[2] - other[0])).all())


def main() -> int:
    """Exit status 1 where a case is wrong."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kind", choices=KINDS, default="csv")
    parser.add_argument("--command", choices=COMMANDS, default="identify")
    parser.add_argument("--results", type=Path)
    given = parser.parse_args()
    head = f"{given.command} {given.kind}"
    lines = given.results.read_text().splitlines() if given.results and given.results.is_file() else []
    done = {int(x.split(" ", 3)[2]): x.split(" ", 4)[3] for x in lines if x.startswith(f"{head} ")}
    with tempfile.TemporaryDirectory() as folder:
        subject = Subject(Path(folder), given.kind, given.command)
        for seed in range(given.first, given.first + given.count):
            if seed in done:
                continue
            said = subject.verdict(seed)
            done[seed] = said.split(" ", 1)[0]
            if given.results:
                with given.results.open("a", encoding="utf-8", errors="backslashreplace") as stream:
                    stream.write(f"{head} {seed} {said}\n")
            if done[seed] in FAULTS:
                sys.stdout.write(f"{head} {seed}: {said}\n")
    tally = Counter(done.values())
    sys.stdout.write(f"{head}: {len(done)} edits, {dict(sorted(tally.items()))}\n")
    return 1 if any(tally[word] for word in FAULTS) else 0


if __name__ == "__main__":
    sys.exit(main())
