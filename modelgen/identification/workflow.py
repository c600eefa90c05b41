"""An identification from logs to parameters: whole or streamed, validated on test records or on parts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from modelgen.dataset import (
    Chosen,
    Prepared,
    Record,
    Settings,
    Stream,
    check_separate,
    choose,
    described,
    gather,
    parse,
    prepare,
    read,
    several,
    split,
)
from modelgen.dataset import preset as processing
from modelgen.dataset.inspection import RecordsInspected, inspect_records
from modelgen.dataset.processing.content import check_coarse
from modelgen.dataset.processing.periods import repetition, rows_in, with_whole_rows
from modelgen.dataset.processing.sequence import in_sequence
from modelgen.dataset.processing.splitting import repeats_from
from modelgen.dataset.reading.jumps import check_jumps
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Options, build_model
from modelgen.functions.nominal import payload_base
from modelgen.functions.options import prepared as reduced
from modelgen.identification.beside_noise import beside_noise, lacking
from modelgen.identification.cut_off_streamed import streamed_limits
from modelgen.identification.doubts import worse_on_test
from modelgen.identification.effort_instant import at_instants, effort_instant
from modelgen.identification.folds import Folds, folds
from modelgen.identification.identify import METHODS, Instruments, identify
from modelgen.identification.lack_of_fit import beside_noise_in_motion, lack_of_fit
from modelgen.identification.misread import Asked, disagreeing
from modelgen.identification.noise import with_noise
from modelgen.identification.objects import Identification
from modelgen.identification.output import errors, to_json
from modelgen.identification.payloads import payload_questions, payloads_of, without_cut_off_by_payload
from modelgen.identification.questions import coarse_positions, doubts_of, misread
from modelgen.identification.simulated_instruments import Tracking
from modelgen.identification.streamed import identify_streamed
from modelgen.identification.validation import judged_by
from modelgen.identification.without_drives import Alternative, without_drives
from modelgen.options import IdentificationOptions
from modelgen.progress import Progress, silent
from modelgen.simulation.tables import reference_of

STREAMED = 512 * 1024**2  # bytes of training logs beyond which they are streamed


@dataclass(frozen=True)
class Outcome:
    """others: models beside the identification. first: a training record, for the spectra. chosen: settings
    of the processing. log: facts of the records. folds: parts of the training records held out in turn.
    """

    found: Identification
    others: Sequence[Alternative]
    first: Prepared
    chosen: Chosen
    log: RecordsInspected
    folds: Folds | None = None

    @cached_property
    def data(self) -> dict[str, Any]:
        """identification.json."""
        beside = [{"model": o.name, **errors(o.test)} for o in self.others]
        return (
            to_json(self.found)
            | {"cutoff_hz": self.chosen.cutoff, "processing": self._processing}
            | {"log": self.log.to_json()}
            | ({"without_drives": beside} if beside else {})
            | ({} if self.folds is None else {"folds": self._folds(self.folds)})
        )

    @property
    def _processing(self) -> list[str]:
        return described(self.first, len(self.log.train), self.log.samples)

    @staticmethod
    def _folds(folds: Folds) -> dict[str, Any]:
        return {
            "parts": [{"test": name, **errors(test)} for name, test in folds.parts],
            "rmse": folds.rmse.tolist(),
            "nrmse_percent": folds.nrmse_percent.tolist(),
        }


def identify_logs(
    arm: Arm,
    train: Sequence[Any],
    test: Sequence[Any] = (),
    options: IdentificationOptions | None = None,
    progress: Progress = silent,
) -> Outcome:
    """Base parameters of the arm from training logs, validated on test logs.

    Without test logs a single training record is split in two. Logs above 512 MB are read block by block.
    Raises InputError for options that do not go together, and as `gather` and `identify` do.
    """
    o = options or IdentificationOptions()
    chosen = Options(without=o.without, gains=o.gains)
    _check(chosen, o, test)
    progress("reading", 0, None)
    made = _streamed if o.stream or _size(train) > STREAMED else _whole
    return made(arm, chosen, o, train, test, progress)


def _size(logs: Sequence[Any]) -> int:
    """Bytes of the files among the logs."""
    paths = [parse(log).path for log in logs if isinstance(log, str)]
    return sum(path.stat().st_size for path in paths if path.is_file())


def _check(options: Options, o: IdentificationOptions, test: Sequence[Any]) -> None:
    """Raises InputError for options that make no sense, before the logs are read."""
    if "drives" in options.without:
        raise InputError("--without drives: the input is the drives' own; expected --without effects")
    if o.cutoff is not None and o.preset != "default":
        raise InputError(f"--cutoff {o.cutoff:g}: --preset {o.preset} has its own, expected one of both")
    if o.method not in METHODS:
        raise InputError(f"--method: found '{o.method}', expected {', '.join(METHODS)}")
    if o.bandwidth is not None and not 0 < o.bandwidth < float("inf"):
        raise InputError(f"--bandwidth: found {o.bandwidth:g}, expected more than 0 Hz")
    if o.compare_drives and o.folds is not None and not test:
        raise InputError("--compare-drives: compares errors on test records, expected --test LOG")
    if o.folds is not None and o.payload:
        raise InputError("--folds: parts of a record with a payload, and without; expected no --payload")
    if options.gains == "row_wise" and (o.instrument == "simulated" or o.reference is not None):
        raise InputError("--gains row_wise: rows without a common scale cannot be simulated")


def _settings(o: IdentificationOptions) -> Callable[[float], Settings]:
    """Settings of the processing that the options ask for, at a rate [Hz]."""
    if o.preset == "default":
        return lambda rate: Settings(cutoff=o.cutoff)
    return lambda rate: processing(o.preset, rate)


def _whole(
    arm: Arm,
    options: Options,
    o: IdentificationOptions,
    train: Sequence[Any],
    test: Sequence[Any],
    progress: Progress,
) -> Outcome:
    """All records at once."""
    testing: list[Record] = []
    if test:
        training, testing = gather(train, test, arm, o.mapping)
    else:
        if o.folds is None and len(train) != 1:
            check_separate(train, test)
        training = several(train, arm, o.mapping)
        if o.folds is None:
            one, two = split(training[0])
            training, testing = [one], [two]
    check_jumps([*training, *testing])
    payloads = payloads_of(o.payload, [*train, *test])
    asked = _settings(o)(1 / training[0].step)
    repeated = [repetition(x) for x in training]
    periods = [None if found is None else found[1] for found in repeated]
    training = [
        x if found is None or not found[0] else replace(x, remarks=(*x.remarks, repeats_from(x, found)))
        for x, found in zip(training, repeated, strict=True)
    ]
    chosen = with_whole_rows(choose(training, asked), periods)
    training, testing = without_cut_off_by_payload(training, testing, payloads, chosen, arm)
    instant = effort_instant([r for k, r in enumerate(training) if k not in payloads] or training, arm)
    training, testing = at_instants(training, instant), at_instants(testing, instant)
    coarse: tuple[str, ...] = ()
    if o.cutoff is not None:
        coarse = coarse_positions(training, chosen)
    elif o.preset == "default":
        for record in training:
            check_coarse(record, chosen.cutoff)
    progress("identifying", 0, None)
    every = in_sequence([prepare(x, chosen) for x in [*training, *testing]])
    fitted, held = every[: len(training)], every[len(training) :]
    tracking = Tracking(
        reduced(arm, options),
        o.control,
        None if o.reference is None else reference_of(len(arm.coordinates), o.reference),
        o.bandwidth,
    )

    def identified(train: Sequence[Prepared], test: Sequence[Prepared]) -> Identification:
        return identify(
            train,
            arm,
            options,
            test=test,
            method=o.method,
            physical=o.consistent,
            instruments=Instruments(o.instrument, tracking),
            essential_only=o.essential,
            payloads=payloads,
        )

    model, evaluator = build_model(arm, options.evaluated), Evaluator(reduced(arm, options))
    asked_of = misread(fitted, held, model, evaluator) if options == Options() else Asked()
    found = identified(fitted, held)
    if options == Options():
        apart = [] if payloads else disagreeing(fitted, asked_of.alone, found.solution.sigma)
        carried = [payload_base(model, payloads.get(k, ())) for k in range(len(fitted))]
        about = doubts_of(fitted, found, evaluator, carried if payloads else None)
        found = replace(found, doubts=(*asked_of.questions, *apart, *about), signs_tried=True)
    if instant is not None:
        found = replace(found, doubts=(*found.doubts, *instant.questions()))
    of_payloads = payload_questions(found, fitted, evaluator, payloads, [*train, *test])
    found = replace(found, doubts=(*coarse, *found.doubts, *worse_on_test(found, fitted), *of_payloads))
    found = judged_by(found, held, None if payloads or options != Options() else evaluator)
    if options == Options():
        theta = np.array([e.value for e in found.estimates])
        rows = [rows_in(p, chosen) for p in periods]
        remains = lack_of_fit(fitted, model, evaluator, theta, rows, carried if payloads else None)
        found = replace(found, remains=remains)
        known = None if found.test is None or payloads else beside_noise(found.test)
        if found.test is not None and known is not None and known.lacks:
            moving = beside_noise_in_motion(held, model, evaluator, theta)
            found = replace(found, test=replace(found.test, moving=moving))
    found = replace(found, doubts=(*found.doubts, *lacking(found)))
    found = with_noise(found, options, held, bool(payloads))
    others: tuple[Alternative, ...] = ()
    if o.compare_drives:
        progress("identifying without the drives", 0, None)
        others = without_drives(training, testing, found.arm, chosen, found, payloads)
    parts: Folds | None = None
    if o.folds is not None:
        progress(f"holding out each of {o.folds} parts", 0, None)
        parts = folds(training, o.folds, chosen, identified)
    log = inspect_records(fitted, testing, chosen, periods, instant=instant)
    return Outcome(found, others, fitted[0], chosen, log, parts)


def _streamed(
    arm: Arm,
    options: Options,
    o: IdentificationOptions,
    train: Sequence[Any],
    test: Sequence[Any],
    progress: Progress,
) -> Outcome:
    """Identify block by block; the first block stands for the record in pictures."""
    for name, asked in (
        ("--gains estimated", options.gains == "estimated"),
        ("--payload", o.payload),
        ("--essential", o.essential),
        ("--compare-drives", o.compare_drives),
        ("--folds", o.folds),
        ("--instrument", o.instrument != "auto"),
    ):
        if asked:
            raise InputError(f"{name}: needs all rows at once, found a streamed log; give a part, FILE@t0:t1")
    if not test:
        raise InputError("a streamed log is not split: found no test record, expected --test LOG")
    check_separate(train, test)
    head = Stream(train[0], arm, None, o.mapping)
    first = head.settled(_settings(o)(1 / head.axis.step))
    chosen = first.settings
    streams = [first, *(Stream(spec, arm, chosen, o.mapping) for spec in train[1:])]
    limits = streamed_limits(streams, arm)
    instant = effort_instant([limits.without(first.beginning)], arm)
    tests = at_instants([limits.beyond(read(spec, arm, o.mapping)) for spec in test], instant)
    check_jumps(tests)
    if instant is not None:
        hold = instant.hold if instant.known == "data" else None
        streams = [stream.at_instants(hold, instant.doubt) for stream in streams]
    testing = in_sequence([prepare(record, chosen) for record in tests])
    doing = f"identifying, {sum(s.samples for s in streams):,} samples"
    progress(doing, 0, None)
    found = identify_streamed(
        streams,
        arm,
        options,
        test=testing,
        method=o.method,
        physical=o.consistent,
        limits=limits,
        progress=lambda done, total: progress(doing, done, total),
    )
    begun = [replace(next(stream.records()), name=stream.spec) for stream in streams]
    heads = [prepare(limits.without(record), chosen) for record in begun]
    if options == Options():
        evaluator = Evaluator(reduced(arm, options))
        asked_of = misread(heads, testing, found.model, evaluator)
        apart = disagreeing(heads, asked_of.alone, found.solution.sigma)
        about = (*asked_of.questions, *apart, *doubts_of(heads, found, evaluator))
        found = replace(found, doubts=(*about, *worse_on_test(found, heads)), signs_tried=True)
    if instant is not None:
        found = replace(found, doubts=(*found.doubts, *instant.questions()))
    found = with_noise(found, options, testing, False)
    heads[0] = replace(heads[0], record=limits.remarked(heads[0].record))
    samples = [stream.samples for stream in streams]
    log = inspect_records(heads, tests, chosen, [None] * len(heads), samples, instant)
    return Outcome(found, (), heads[0], chosen, log)
