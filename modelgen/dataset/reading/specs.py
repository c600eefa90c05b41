"""FILE@t0:t1: which part of which file, and that nothing is used for training and testing at once."""

from __future__ import annotations

import hashlib
import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from modelgen.dataset.objects import Record
from modelgen.dataset.reading.column_table import ColumnTable, Log
from modelgen.dataset.reading.pipes import plain_file
from modelgen.errors import InputError

_PART = re.compile(r"(?P<file>.+)@(?P<begin>[^@:]*):(?P<end>[^@:]*)")


@dataclass(frozen=True)
class Spec:
    """A file, or those of its samples with begin <= t < end [s]; or a log in memory, under its name."""

    text: str
    path: Path
    begin: float = -math.inf
    end: float = math.inf
    held: Record | ColumnTable | None = None

    def content(self) -> str:
        """Hash of the bytes, of a folder's files. Raises InputError where it cannot be read."""
        if isinstance(self.held, ColumnTable):
            return self.held.content()
        digest = hashlib.sha256()
        if self.held is not None:
            for values in (self.held.t, self.held.q, self.held.input):
                digest.update(b"" if values is None else values.tobytes())
            return digest.hexdigest()
        files = sorted(p for p in self.path.rglob("*") if p.is_file()) if self.path.is_dir() else [self.path]
        for file in files:
            try:
                with plain_file(file).open("rb") as stream:
                    digest.update(hashlib.file_digest(stream, "sha256").digest())
            except (OSError, ValueError) as error:
                raise unreadable(self.path, error) from None
        return digest.hexdigest()


def parse(log: Log) -> Spec:
    """`FILE` or `FILE@t0:t1`; t0 or t1 may be left out. Raises InputError.

    A file whose own name has the form FILE@a:b is a file. A log in memory is whole.
    """
    if isinstance(log, Record | ColumnTable):
        return Spec(log.name, Path(log.name), held=log)
    text = os.fspath(log)
    match = _PART.fullmatch(text)
    if match is None or _exists(text):
        return Spec(text, Path(text))
    begin = _time(text, match["begin"], -math.inf)
    end = _time(text, match["end"], math.inf)
    if begin >= end:
        raise InputError(f"{text}: found the part {begin:g} s to {end:g} s, expected FILE@t0:t1 with t0 < t1")
    return Spec(text, Path(match["file"]), begin, end)


def _exists(text: str) -> bool:
    try:
        return Path(text).exists()
    except (OSError, ValueError):
        return False  # no name of a file at all


def _time(text: str, word: str, default: float) -> float:
    try:
        value = float(word) if word.strip() else default
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise InputError(f"{text}: found '{word}' as a time, expected FILE@t0:t1 with numbers in seconds")
    return value


def unreadable(path: Path, error: OSError | ValueError) -> InputError:
    """The message for a file that cannot be opened, with the names that come near."""
    if isinstance(error, FileNotFoundError):
        folder = path.parent
        names = sorted(p.name for p in folder.iterdir() if p.is_file()) if folder.is_dir() else []
        near = [n for n in names if n.lower().startswith(path.stem[:4].lower())][:5]
        return InputError(f"{path}: there is no such log" + (f"; near: {', '.join(near)}" if near else ""))
    if isinstance(error, IsADirectoryError):
        return InputError(f"{path}: found a folder, expected a log")
    reason = " ".join(str(getattr(error, "strerror", None) or error).split())[:160]
    return InputError(f"{path}: cannot be read: {reason}")


def check_separate(train: Sequence[Log], test: Sequence[Log]) -> None:
    """Nothing may be trained on and tested on. Raises InputError.

    Two specifications overlap where their files are one, or have the same content, and their parts share
    samples. Records of the same kind (training among themselves) may not overlap either.
    """
    if not train or not test:
        raise InputError(
            f"found no {'test' if train else 'training'} record, expected one; {_advice(train or test)}"
        )
    chosen = [("train", parse(t)) for t in train] + [("test", parse(t)) for t in test]
    contents = [spec.content() for _, spec in chosen]
    for i, (role, spec) in enumerate(chosen):
        for j in range(i):
            other_role, other = chosen[j]
            if contents[i] != contents[j] or not _overlap(spec, other):
                continue
            whose = "files" if spec.held is None and other.held is None else "logs"
            same = "" if spec.path == other.path else f" (the {whose} have the same content)"
            raise InputError(
                f"--{other_role} {other.text} and --{role} {spec.text} share samples{same}; "
                + _advice([other.text])
            )


def _overlap(a: Spec, b: Spec) -> bool:
    return max(a.begin, b.begin) < min(a.end, b.end)


def _advice(texts: Sequence[Log]) -> str:
    file = parse(texts[0]).path if texts else Path("LOG")
    return (
        "one file can serve for both in parts that do not overlap, the last quarter held out, say: "
        f"{_parts(file, at='T')}, T in seconds"
    )


def last_quarter_out(record: Record) -> str:
    """Options by which a record serves for both."""
    spec, t = parse(record.name), record.t
    begin, end = (_instant(x, record.step) if math.isfinite(x) else "" for x in (spec.begin, spec.end))
    return _parts(spec.path, begin, _instant(t[0] + 0.75 * (t[-1] - t[0]), record.step), end)


def _parts(file: Path, begin: str = "", at: str = "", end: str = "") -> str:
    return f"--train {file}@{begin}:{at} --test {file}@{at}:{end}"


def _instant(t: float, step: float) -> str:
    """A time [s] in so many digits that samples a step apart are told apart."""
    digits = max(6, math.ceil(math.log10(max(abs(t), 1e-300) / step)) + 2)
    return f"{t:.{min(digits, 17)}g}"


def cut(record: Record, begin: int, end: int) -> Record:
    """Samples begin to end (exclusive) of a record, named after their times, FILE@t0:t1."""
    first, last = record.t[begin], record.t[end - 1] + record.step
    name = f"{parse(record.name).path}@{_instant(first, record.step)}:{_instant(last, record.step)}"
    return record.part(begin, end, name)
