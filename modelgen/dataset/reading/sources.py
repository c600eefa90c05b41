"""A log that is open: its columns by the names of docs/logs.md, and how its time and efforts are meant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from modelgen.dataset.drives import NumericDrive, drives_of
from modelgen.dataset.mapping.columns import MappedReader
from modelgen.dataset.mapping.files import listed, load_mapping
from modelgen.dataset.objects import Layout, Reader, Record, Wanted
from modelgen.dataset.reading.bags import BagReader
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.renamed import by_contract
from modelgen.dataset.reading.shape import other_unit, unit_word
from modelgen.dataset.reading.signals import Signals, by_names, find_signals, is_signal
from modelgen.dataset.reading.specs import Spec, parse
from modelgen.dataset.reading.tables import open_table
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array

BLOCK = 65_536  # rows read at a time

# Seconds since 1970 that a log can have begun at: from September 2001 to October 2096. No clock that counts
# from its own start comes so far.
_EPOCH = (1e9, 4e9)


@dataclass(frozen=True)
class Source:
    """The part of a log that a specification names.

    hold: "following", "previous", "instant", or the delay [s] of the effort's samples. rate: of the uniform
    axis [Hz]; gap: longest time without a sample [s]; None: by default. effort_units: by column, where
    they are not those of its name. thresholds: by which the log is refused or resampled. stated: whether
    the mapping says `hold`; timed: whether it says the unit of the stamps, or how many there are per second.
    """

    spec: Spec
    reader: Reader
    signals: Signals
    drives: tuple[NumericDrive, ...]
    hold: str | float = "following"
    rate: float | None = None
    gap: float | None = None
    effort_units: dict[str, str] = field(default_factory=dict)
    thresholds: DatasetThresholds = USUAL
    stated: bool = False
    timed: bool = False

    @property
    def remarks(self) -> tuple[str, ...]:
        """For the user, as far as the log has been read."""
        return self.reader.remarks

    @property
    def in_turn(self) -> bool:
        """Whether some rows may hold none of the columns: messages of a bag, or blank cells."""
        inner = self.reader
        while (within := getattr(inner, "reader", None)) is not None:
            inner = within
        return isinstance(inner, BagReader) or bool(getattr(inner, "sparse", ()))

    @property
    def wanted(self) -> tuple[str, ...]:
        """Names of the columns that are read, the time first."""
        return tuple(dict.fromkeys(self.signals.wanted))

    def blocks(self, rows: int = BLOCK, *, time_alone: bool = False) -> Iterator[Array]:
        """The wanted columns of the part in blocks of `rows`; rows without a time are kept for refusal."""
        signals = self.signals
        efforts = frozenset(name for name in signals.effort if name is not None)
        wanted = Wanted(self.wanted, frozenset(signals.position), efforts)
        if time_alone:
            wanted = Wanted(self.wanted[:1])
        waiting: list[Array] = []
        for block in self.reader.blocks(wanted, rows):
            t = block[:, 0]
            inside = ((t >= self.spec.begin) & (t < self.spec.end)) | np.isnan(t)
            if not waiting and len(block) == rows and inside.all():
                yield block
                continue
            waiting.append(block if inside.all() else block[inside])
            while sum(map(len, waiting)) >= rows:
                whole = np.concatenate(waiting)
                yield whole[:rows]
                waiting = [whole[rows:]]
        rest = np.concatenate(waiting) if waiting else np.empty((0, len(wanted.names)))
        if len(rest):
            yield rest


def open_source(
    log: Log,
    arm: Arm,
    mapping: Path | str | None = None,
    thresholds: DatasetThresholds = USUAL,
) -> Source:
    """The log that `FILE` or `FILE@t0:t1` names, or a table of columns, opened. Raises InputError."""
    spec = parse(log)
    drives = drives_of(arm)
    if mapping is None:
        reader = _named(spec)
        signals = find_signals(spec.text, reader.names, arm, drives)
        check_units(spec.text, getattr(reader, "units", {}), signals, arm, drives)
        timed = "t" in getattr(reader, "units", {})
        return Source(spec, reader, signals, drives, thresholds=thresholds, timed=timed)
    foreign = load_mapping(mapping)
    by_name = foreign.joints is None
    logged = _named(spec, foreign.layout) if by_name else opened(spec, foreign.layout)
    time = foreign.document.time
    named = [name for name in logged.names if name not in ("t", time.column) and is_signal(name)]
    mapped = MappedReader(foreign, logged, arm, drives, named)
    signals = find_signals(spec.text, mapped.names, arm, drives, mapped=not by_name)
    declared = "unit" in time.model_fields_set or foreign.document.rate is not None
    if by_name:
        said: dict[str, str] = dict(getattr(logged, "units", {}))
        if "unit" in time.model_fields_set:
            said.pop("t", None)
        check_units(spec.text, said, signals, arm, drives)
        declared |= "t" in said
    return Source(
        spec,
        mapped,
        signals,
        drives,
        foreign.hold,
        foreign.positive(time.resample, ["time", "resample"]),
        foreign.positive(time.largest_gap, ["time", "largest_gap"]),
        mapped.effort_units,
        thresholds,
        "hold" in foreign.document.model_fields_set,
        declared or time.column in getattr(logged, "instants", ()),
    )


def _named(spec: Spec, layout: Layout | None = None) -> Reader:
    """The log, under the names of docs/logs.md as far as it has them. Raises InputError for a bag."""
    reader = by_contract(opened(spec, layout))
    if isinstance(reader, BagReader):
        raise InputError(
            f"{spec.text}: a bag needs a mapping file (--mapping) that names its columns: "
            + listed(reader.names)
        )
    return reader


def check_units(
    file: str, said: Mapping[str, str], signals: Signals, arm: Arm, drives: Sequence[NumericDrive]
) -> None:
    """Units that the file itself says, by column, must be those of docs/logs.md. Raises InputError."""
    for name in signals.wanted:
        if name not in said:
            continue
        kind = name.rstrip("0123456789")
        expected = "s" if name == "t" else "A" if kind == "i" else None
        if kind == "qm" and (unit := drives[int(name.removeprefix(kind)) - 1].unit) in ("rad", "m"):
            expected = unit
        if expected is None and kind in ("q", "dq", "ddq", "tau"):
            prismatic = arm.joints[arm.coordinates[int(name.removeprefix(kind)) - 1]].type == "prismatic"
            base = ("N" if prismatic else "N m") if kind == "tau" else ("m" if prismatic else "rad")
            expected = base + {"dq": "/s", "ddq": "/s^2"}.get(kind, "")
        if expected is not None and other_unit(said[name], expected):
            raise InputError(
                f"{file}: the file says that {name} is in {unit_word(said[name])}, expected {expected}; "
                "declare `unit: ...` in a mapping file (--mapping)"
            )


def opened(spec: Spec, layout: Layout | None = None) -> Reader:
    """The reader for a log. Raises InputError, also for a record, which has been read."""
    if spec.held is None:
        return open_table(spec.path, layout)
    if isinstance(spec.held, Record):
        raise InputError(f"{spec.text}: found a record, expected a log as it was recorded")
    return spec.held


def read_columns(log: Log, names: Sequence[str]) -> dict[str, Array]:
    """Columns of a log by their own names, each (N,), without any check but that they are there.

    For logs that hold more than one arm's record does: motor counts and joint angles side by side, say.
    Raises InputError.
    """
    return dated_columns(log, names)[0]


def dated_columns(log: Log, names: Sequence[str]) -> tuple[dict[str, Array], float | None]:
    """As `read_columns`, and the first stamp in seconds since 1970, as `since_1970`. Raises InputError."""
    spec = parse(log)
    reader = by_contract(opened(spec))
    wanted = tuple(dict.fromkeys(("t", *names)))
    absent = [name for name in wanted if name not in reader.names]
    if absent:
        raise InputError(f"{spec.text}: the column {absent[0]} is missing (found {', '.join(reader.names)})")
    parts = []
    for block in reader.blocks(by_names(wanted), BLOCK):
        inside = (block[:, 0] >= spec.begin) & (block[:, 0] < spec.end)
        parts.append(block[inside])
    table = np.concatenate(parts) if parts else np.empty((0, len(wanted)))
    begins = since_1970(reader, float(table[0, 0])) if len(table) else None
    return {name: table[:, k] for k, name in enumerate(wanted)}, begins


def since_1970(reader: object, first: float) -> float | None:
    """First stamp in seconds since 1970; None where it is too small or too large to count from then."""
    stamp = float(getattr(reader, "origin", 0.0)) + first
    return stamp if _EPOCH[0] <= stamp < _EPOCH[1] else None
