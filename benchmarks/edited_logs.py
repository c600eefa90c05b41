"""Random bytes in a log, through `modelgen identify`: refused, remarked on, or the numbers as they were.

    python benchmarks/edited_logs.py COUNT [--first 0] [--kind csv] [--results FILE]

The log of `deviations.py` as CSV or Parquet gets one to three edits of a few bytes each, with odd seeds of
one digit for another, which no reader of tables can see. Numbers are wrong
where one is more than five deviations from what the log gives without edits, and no remark is new. With
--results a line per case is kept, and a run that was stopped is taken up where it stood. Exit status 1 where
a case is wrong or ends in anything but an answer or one line.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np
from deviations import Encoder, arm, log

import modelgen as mg

FAR = 5.0  # deviations
PIECES = [b"", b",", b";", b"\n", b"\t", b'"', b"\x00", b"\xff", b"-", b"e", b".", b" ", b"#", b"1", b"9"]
KINDS = ("csv", "parquet")


def edited(data: bytes, seed: int) -> bytes:
    """The bytes with one to three pieces put in the place of others, of odd seeds digits alone."""
    random = np.random.default_rng(seed)
    digits = [k for k, byte in enumerate(data) if 48 <= byte < 58] if seed % 2 else []
    for _ in range(random.integers(1, 4)):
        if digits:
            place = digits[random.integers(len(digits))]
            data = data[:place] + b"%d" % random.integers(10) + data[place + 1 :]
            continue
        place, length = int(random.integers(0, len(data) + 1)), int(random.choice([0, 1, 1, 2, 9]))
        data = data[:place] + PIECES[random.integers(len(PIECES))] + data[place + length :]
    return data


class Subject:
    """A log, its bytes, and what it gives."""

    def __init__(self, folder: Path, kind: str) -> None:
        self.arm, model = arm(), mg.build_model(arm())
        self.train, self.test = folder / f"train.{kind}", log(model, Encoder(16), 1)
        table = log(model, Encoder(16), 0)
        if kind == "csv":
            rows = np.column_stack(list(table.values()))
            np.savetxt(self.train, rows, fmt="%.7f", delimiter=",", header=",".join(table), comments="")
        else:
            import pyarrow  # noqa: PLC0415 - not needed for tables of text
            from pyarrow import parquet  # noqa: PLC0415

            parquet.write_table(pyarrow.table(table), self.train, write_page_checksum=True)
        self.data, self.folder, self.kind = self.train.read_bytes(), folder, kind
        self.whole = mg.identify(self.arm, [str(self.train)], self.test)
        self.remarks = self.said(self.whole, self.train)

    @staticmethod
    def said(found: mg.Identification, file: Path) -> set[str]:
        """Remarks without the file's name, and doubts."""
        data = found.to_json()
        return {r.replace(str(file), "") for r in [*data["log"]["remarks"], *data.get("doubts", [])]}

    def verdict(self, seed: int) -> str:
        """What becomes of the log with the edits of a seed, in a word and a sentence."""
        file = self.folder / f"edited.{self.kind}"
        file.write_bytes(edited(self.data, seed))
        try:
            found = mg.identify(self.arm, [str(file)], self.test)
        except mg.InputError as error:
            return f"refused {error}" if "\n" not in str(error) else f"lines {str(error)!r}"
        except Exception as error:  # whatever is none of ours is a fault
            return f"fault {type(error).__name__}: {str(error).splitlines()[0]}"
        new = self.said(found, file) - self.remarks
        far, name = max(
            (abs(e.value - w.value) / w.std, name)
            for name, e in found.parameters.items()
            if (w := self.whole.parameters[name]).std
        )
        word = "remarked" if new else "wrong" if far > FAR else "right"
        return f"{word} {name} {far:.2g} deviations away {sorted(new)[:1]}"


def main() -> int:
    """Exit status 1 where a case is wrong."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kind", choices=KINDS, default="csv")
    parser.add_argument("--results", type=Path)
    given = parser.parse_args()
    lines = given.results.read_text().splitlines() if given.results and given.results.is_file() else []
    done = {
        int(line.split(" ", 2)[1]): line.split(" ", 3)[2] for line in lines if line.startswith(given.kind)
    }
    with tempfile.TemporaryDirectory() as folder:
        subject = Subject(Path(folder), given.kind)
        for seed in range(given.first, given.first + given.count):
            if seed in done:
                continue
            said = subject.verdict(seed)
            done[seed] = said.split(" ", 1)[0]
            if given.results:
                with given.results.open("a") as stream:
                    stream.write(f"{given.kind} {seed} {said}\n")
            if done[seed] in ("wrong", "lines", "fault"):
                sys.stdout.write(f"{given.kind} {seed}: {said}\n")
    tally = Counter(done.values())
    sys.stdout.write(f"{given.kind}: {len(done)} edits, {dict(sorted(tally.items()))}\n")
    return 1 if tally["wrong"] + tally["lines"] + tally["fault"] else 0


if __name__ == "__main__":
    sys.exit(main())
