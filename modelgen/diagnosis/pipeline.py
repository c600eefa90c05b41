"""A diagnosis from records to verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from modelgen.dataset import DatasetThresholds, Record, check_separate, last_quarter_out, read, several, split
from modelgen.description import Arm
from modelgen.diagnosis.candidates import check_one_arm
from modelgen.diagnosis.decision import Decision, Progress, decide
from modelgen.diagnosis.equations import Study, bands, check_efforts, study_of
from modelgen.diagnosis.experiment import Experiment, next_experiment, setup
from modelgen.diagnosis.extended import Extension, extend
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.result import Diagnosis, reported
from modelgen.errors import InputError
from modelgen.identification.misread import check_reading
from modelgen.identification.signs import check_signs
from modelgen.jobs import one_thread


@one_thread()
def diagnose(
    arm: Arm,
    found: Sequence[Record],
    options: Options | None = None,
    *,
    progress: Progress | None = None,
    **changes: Any,
) -> Diagnosis:
    """Name what the model of `arm` gets wrong in the records, and measure on the last one what naming it
    gains.

    options: by default the usual ones. changes: fields of the options by name. Raises InputError where the
    records cannot answer.
    """
    options = replace(options or Options(), **changes)
    study = study_of(arm, found, options)
    decision = decided(study, options, progress)
    instant = decision.instant()
    if instant is not None:
        study = study.at(instant)
        decision = decided(study, options, progress)
    extension = extend(arm, decision.selection, decision.band.equations)
    result = reported(study, decision, extension, options)
    if options.experiment and result.verdict == "named":
        result = replace(result, next_experiment=proposed(result, study, extension, options, progress))
    return result


def decided(study: Study, options: Options, progress: Progress | None = None) -> Decision:
    """The decision in the widest band that can tell, else in the narrowest.

    Raises InputError where the records cannot answer.
    """
    for band in bands(study):
        check_reading([r.prepared for r in band.equations.rows], study.model, study.evaluator)
        check_efforts(band.equations)
        check_signs([r.prepared for r in band.equations.rows], study.model, study.evaluator)
        check_one_arm(band)
        decision = decide(band, options, progress)
        if decision.verdict != "cannot_tell":
            break
    return decision


def proposed(
    result: Diagnosis,
    study: Study,
    extension: Extension,
    options: Options,
    progress: Progress | None = None,
) -> Experiment | None:
    """An experiment that separates the named causes from their rivals, None where nothing rivals them."""
    equations, selection = extension.equations, extension.selection
    plan = None if equations.free else setup(result.arm, equations, extension.base)
    shortest = min((round(p) for p in study.lengths if p is not None), default=None)
    return next_experiment(
        result.causes, selection.causes, plan, selection.system, shortest, progress, options.where
    )


def records(
    arm: Arm,
    train: Sequence[str],
    test: Sequence[str],
    mapping: Path | str | None,
    thresholds: DatasetThresholds,
    period: float | None = None,
) -> list[Record]:
    """Training records, the last is the test record; a single training record gives two. period: of it [s].

    Raises InputError where records overlap, are missing, or do not fit the arm.
    """
    if not test:
        raise InputError(
            "found no test record: the gain cannot be measured on what was fitted; record the arm once more, "
            f"or hold its last quarter out: {last_quarter_out(read(train[0], arm, mapping, thresholds))}"
        )
    check_separate(train, test)
    if len(test) != 1:
        raise InputError(f"found {len(test)} test records, expected one: --test LOG")
    found = several(train, arm, mapping, thresholds)
    if len(found) == 1:
        if found[0].input is None:
            raise InputError(
                f"{found[0].name}: found one release to train on, expected two or more, each with its "
                "--train: the end of a swing has little of its begin"
            )
        found = split(found[0], period, thresholds)
    return [*found, read(test[0], arm, mapping, thresholds)]
