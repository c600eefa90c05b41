"""modelgen identify: from logs to an identification, with progress."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

from modelgen.cli.identified import Outcome, show, write
from modelgen.cli.simulating import reference_of
from modelgen.dataset import (
    Prepared,
    Record,
    Settings,
    Stream,
    check_separate,
    choose,
    gather,
    parse,
    prepare,
    read,
    split,
)
from modelgen.dataset import preset as processing
from modelgen.dataset.processing.periods import period_of, with_whole_rows
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.functions.options import prepared as reduced
from modelgen.identification import METHODS, Identification, Instruments, identify, identify_streamed
from modelgen.identification.folds import Folds, folds
from modelgen.identification.simulated_instruments import Tracking
from modelgen.identification.without_drives import Alternative, without_drives
from modelgen.simulation.values import numbers

STREAMED = 512 * 1024**2  # bytes of training logs beyond which they are streamed


@dataclass(frozen=True)
class Request:
    """What the user asked for, as the options have it. file: the description."""

    file: Path
    train: Sequence[str]
    test: Sequence[str]
    out: Path
    mapping: Path | None
    cutoff: float | None
    preset: str
    method: str
    instrument: str
    control: str
    reference: Path | None
    bandwidth: float | None
    payload: Sequence[str]
    essential: bool
    compare: bool
    folds: int | None
    consistent: bool
    stream: bool
    as_json: bool


def run(arm: Arm, options: Options, r: Request) -> None:
    """Identify and write everything into `out`. Raises InputError."""
    _check(options, r)
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=None)
        size = sum(Path(parse(s).path).stat().st_size for s in r.train if Path(parse(s).path).is_file())
        made = _streamed if r.stream or size > STREAMED else _whole
        outcome = made(arm, options, r, bar, task)
    write(outcome, r.file, r.out)
    show(outcome, as_json=r.as_json)


def _check(options: Options, r: Request) -> None:
    """Raises InputError for options that make no sense, before the logs are read."""
    if r.out.exists() and not r.out.is_dir():
        raise InputError(f"--out {r.out}: found a file, expected a folder")
    if "drives" in options.without:
        raise InputError("--without drives: the input is the drives' own; expected --without effects")
    if r.cutoff is not None and r.preset != "default":
        raise InputError(f"--cutoff {r.cutoff:g}: --preset {r.preset} has its own, expected one of both")
    if r.method not in METHODS:
        raise InputError(f"--method: found '{r.method}', expected {', '.join(METHODS)}")
    if r.bandwidth is not None and not 0 < r.bandwidth < float("inf"):
        raise InputError(f"--bandwidth: found {r.bandwidth:g}, expected more than 0 Hz")
    if r.compare and r.folds is not None and not r.test:
        raise InputError("--compare-drives: compares errors on test records, expected --test LOG")
    if r.folds is not None and r.payload:
        raise InputError("--folds: parts of a record with a payload, and without; expected no --payload")
    if options.gains == "row_wise" and (r.instrument == "simulated" or r.reference is not None):
        raise InputError("--gains row_wise: rows without a common scale cannot be simulated")


def _settings(r: Request) -> Callable[[float], Settings]:
    """What the options ask of the processing, for a rate [Hz]."""
    if r.preset == "default":
        return lambda rate: Settings(cutoff=r.cutoff)
    return lambda rate: processing(r.preset, rate)


def _whole(arm: Arm, options: Options, r: Request, bar: Progress, task: TaskID) -> Outcome:
    """All records at once."""
    if r.folds is not None and not r.test:
        training = [read(spec, arm, r.mapping) for spec in r.train]
        testing: list[Record] = []
    else:
        training, testing = gather(r.train, r.test, arm, r.mapping)
    if not testing and r.folds is None:
        if len(training) > 1:
            raise InputError("found no test record, expected one: --test LOG")
        one, two = split(training[0])
        training, testing = [one], [two]
    asked = _settings(r)(1 / training[0].step)
    chosen = with_whole_rows(choose(training, asked), [period_of(x, None) for x in training])
    bar.update(task, description="identifying")
    train, test = [[prepare(x, chosen) for x in part] for part in (training, testing)]
    payloads = _payloads(r)
    tracking = Tracking(
        reduced(arm, options),
        r.control,
        None if r.reference is None else reference_of(len(arm.coordinates), r.reference),
        r.bandwidth,
    )

    def identified(train: Sequence[Prepared], test: Sequence[Prepared]) -> Identification:
        return identify(
            train,
            arm,
            options,
            test=test,
            method=r.method,
            physical=r.consistent,
            instruments=Instruments(r.instrument, tracking),
            essential_only=r.essential,
            payloads=payloads,
        )

    found = identified(train, test)
    others: tuple[Alternative, ...] = ()
    if r.compare:
        bar.update(task, description="identifying without the drives")
        others = without_drives(training, testing, found.arm, chosen, found, payloads)
    parts: Folds | None = None
    if r.folds is not None:
        bar.update(task, description=f"holding out each of {r.folds} parts")
        parts = folds(training, r.folds, chosen, identified)
    return Outcome(found, others, train[0], chosen, parts)


def _payloads(r: Request) -> dict[int, list[float]]:
    """--payload LOG=M[,X,Y,Z] by number of the log, training logs first."""
    logs = [*r.train, *r.test]
    found: dict[int, list[float]] = {}
    for text in r.payload:
        log, equals, values = text.rpartition("=")
        places = [k for k, name in enumerate(logs) if log in (name, parse(name).path)]
        if not equals or not places:
            raise InputError(
                f"--payload {text}: expected LOG=KG or LOG=KG,X,Y,Z with one of the logs {', '.join(logs)}"
            )
        given = numbers("--payload", values)
        if not given or given[0] <= 0:
            raise InputError(f"--payload {text}: expected a mass above 0 kg")
        found |= dict.fromkeys(places, given)
    return found


def _streamed(arm: Arm, options: Options, r: Request, bar: Progress, task: TaskID) -> Outcome:
    """The same block by block; the first block stands for the record in pictures."""
    for name, asked in (
        ("--gains estimated", options.gains == "estimated"),
        ("--payload", r.payload),
        ("--essential", r.essential),
        ("--compare-drives", r.compare),
        ("--folds", r.folds),
        ("--instrument", r.instrument != "auto"),
    ):
        if asked:
            raise InputError(f"{name}: needs all rows at once, found a streamed log; give a part, FILE@t0:t1")
    if not r.test:
        raise InputError("a streamed log is not split: found no test record, expected --test LOG")
    check_separate(r.train, r.test)
    head = Stream(r.train[0], arm, None, r.mapping)
    first = head.settled(_settings(r)(1 / head.axis.step))
    chosen = first.settings
    streams = [first, *(Stream(spec, arm, chosen, r.mapping) for spec in r.train[1:])]
    testing: list[Prepared] = [prepare(read(spec, arm, r.mapping), chosen) for spec in r.test]
    bar.update(task, description=f"identifying, {sum(s.samples for s in streams):,} samples")
    found = identify_streamed(
        streams,
        arm,
        options,
        test=testing,
        method=r.method,
        physical=r.consistent,
        progress=lambda done, total: bar.update(task, completed=done, total=total),
    )
    return Outcome(found, (), next(iter(streams[0])), chosen)
