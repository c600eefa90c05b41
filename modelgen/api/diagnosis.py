"""What a model lacks, from logs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isnan
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm, joint_number
from modelgen.api.logs import Log, listed
from modelgen.api.results import Named, Shown, Table
from modelgen.charts import apart
from modelgen.dataset import split_said
from modelgen.description import Arm, loads
from modelgen.diagnosis.extended import Estimate, NamedCause
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose as diagnose_records
from modelgen.diagnosis.pipeline import records
from modelgen.diagnosis.result import Diagnosis as Found
from modelgen.effects import known_effects
from modelgen.effects.editing import extended_yaml
from modelgen.effects.placement import titled
from modelgen.jobs import Where
from modelgen.options import DiagnosisOptions, changed
from modelgen.progress import Progress, silent
from modelgen.report.call import Call, given
from modelgen.report.diagnosis_sentences import (
    assumptions,
    compared,
    harms,
    headline,
    interval,
)
from modelgen.report.experiment import followed
from modelgen.report.following import proposed, whole_json
from modelgen.report.opening import opening
from modelgen.report.others import suspicions
from modelgen.report.words import joint_name, legible, place_of, value_said
from modelgen.report.writing import write


class Diagnosis(Shown):
    """What the model of an arm gets wrong in logs, and the model extended by it.

    Parameters
    ----------
    found : modelgen.diagnosis.result.Diagnosis
        What the diagnosis gives back.
    call : modelgen.report.call.Call, optional
        How it was asked for, which the commands on the page need.

    Attributes
    ----------
    arm : Arm
        The arm as described.
    verdict : str
        "named", "suspected", "nothing_missing", "outside_catalogue" or "cannot_tell".
    reason : str
        Why, in words.
    causes : tuple of NamedCause
        What is named: effect, joint (from 1; None for the whole arm), parameters, evidence.
    suspects : tuple
        What has evidence and failed a check that decides, in the same form.
    parameters : Named of Estimate
        Base parameters (p,) of the extended arm by name: value, std, unit.
    """

    def __init__(self, found: Found, call: Call | None = None) -> None:
        self.found, self.call = found, call or Call(found.arm)
        self.arm: Arm = found.arm
        self.verdict, self.reason = found.verdict, found.reason
        self.causes: tuple[NamedCause, ...] = found.causes
        self.suspects: tuple[NamedCause, ...] = found.suspects
        self.parameters: Named[Estimate] = Named(found.parameters)

    @property
    def extended_arm(self) -> Arm:
        """The arm with the causes, as <arm>_extended.yaml describes it."""
        d = self.found
        text = extended_yaml(d.arm, d.added)
        return loads(text, f"{d.arm.name}_extended.yaml", known_effects())[d.arm.name]

    def to_json(self) -> dict[str, Any]:
        """Plain data: diagnosis.json.

        Returns
        -------
        dict
            Verdict, causes, lack of fit, errors on the test log, next experiment; paths of a command in it
            are those of the folder of the last `write`, else of the current one.
        """
        return whole_json(self.found, self.call)

    def next_steps(self, folder: Path | str | None = None) -> Sequence[tuple[str, str]]:
        """What is to be done next.

        Parameters
        ----------
        folder : Path or str, optional
            Where the files are, which the commands need. Default: that of the last `write`.

        Returns
        -------
        sequence of tuple of str
            Each a sentence and the command for it, empty where there is none.
        """
        call = self.call if folder is None else replace(self.call, folder=Path(folder))
        return [(step.text, step.command) for step in proposed(self.found, call)]

    def write(self, folder: Path | str, *, code: bool = True) -> None:
        """Write the files of `modelgen diagnose` into a folder, all of them or none.

        Parameters
        ----------
        folder : Path or str
            It gets diagnosis.json, report.html with its pictures, <arm>_extended.yaml with the values of its
            parameters in <arm>_parameters.yaml, and the extended model's code in `generated`; where causes
            make the test record worse, <arm>_reduced.yaml without them.
        code : bool
            False leaves the code out.

        Raises
        ------
        InputError
            Where the folder cannot be written.
        """
        write(self.found, Path(folder), code=code, call=self.call)
        self.call = replace(self.call, folder=Path(folder))

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen diagnose`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        d = self.found
        parts: list[str | Table] = [opening(d)]
        rows = [_row(d.arm, c) for c in d.causes]
        if rows:
            headings = (
                "cause",
                "joint",
                "parameters",
                "delta BIC",
                "unseen %",
                "on test %",
                "or perhaps",
                "the same as",
            )
            parts.append(Table("", dict.fromkeys(headings, "left"), rows, ("cause",)))
        parts.append(_errors(d))
        parts += [
            *suspicions(d),
            *harms(d),
            *assumptions(d),
            *compared(d),
            *(f"log: {line}" for line in d.log.brief()[0]),
        ]
        if d.next_experiment is not None:
            parts.append(f"next: {followed(d.next_experiment)}")
        return parts

    def details(self) -> Sequence[str]:
        """Remarks on the logs that `shown` leaves out, as `modelgen diagnose --verbose` prints them.

        Returns
        -------
        sequence of str
            A line each.
        """
        return [f"log: {line}" for line in self.found.log.brief()[1]]

    def __repr__(self) -> str:
        return f"Diagnosis of {self.arm.name}: {self.verdict}. {headline(self.found)}"


def _errors(d: Found) -> Table:
    """Errors of the test record by joint; what changed, where something is named."""
    e, names = d.errors, [joint_name(d.arm, j + 1) for j in range(len(d.errors.before))]
    title = f"error on the test record [{e.unit}]"
    if not d.causes:
        rows = [[name, f"{x:z.4g}"] for name, x in zip(names, e.before, strict=True)]
        return Table(title, dict.fromkeys(("joint", "error"), "right"), rows)
    rows = [
        [name, *apart(e.before[j], e.after[j], 4), f"{e.gain[j]:z.1f}", interval(e.low[j], e.high[j])]
        for j, name in enumerate(names)
    ]
    return Table(title, dict.fromkeys(("joint", "before", "after", "less %", "95 %"), "right"), rows)


def diagnose(
    arm: Arm,
    train: Log | Sequence[Log],
    test: Log | Sequence[Log],
    options: DiagnosisOptions | None = None,
    *,
    progress: Progress = silent,
    **changes: Any,
) -> Diagnosis:
    """Name what the model gets wrong in logs, extend it by the cause, and measure the gain.

    Parameters
    ----------
    arm : Arm
        An arm with n coordinates and p base parameters.
    train : log or sequence of logs
        Training logs: paths, "FILE@t0:t1" [s], records, or tables of columns. A single one is split in two.
    test : log
        The log that nothing but the final errors looks at.
    options : DiagnosisOptions, optional
        Band, period, effects to ask for, thresholds.
    progress : callable, optional
        It is called with what is done, how much of it, and of how much.
    **changes
        Fields of the options, by name.

    Returns
    -------
    Diagnosis
        Verdict, causes, extended arm; errors by joint (n,) in the unit of the logs' efforts.

    Raises
    ------
    InputError
        For logs that cannot be read, overlap or cannot answer, and for a threshold that there is not.

    References
    ----------
    The sources of each step are in docs/diagnosis_method.md.
    """
    an_arm(arm)
    chosen = changed(options or DiagnosisOptions(), changes)
    return diagnosed(arm, listed(train, "train"), listed(test, "test"), chosen, progress)


def diagnosed(
    arm: Arm,
    train: Sequence[Log],
    test: Sequence[Log],
    options: DiagnosisOptions,
    progress: Progress = silent,
) -> Diagnosis:
    """The same of lists of logs. Raises InputError."""
    wanted = [_place(arm, text) for text in options.effects]
    thresholds = USUAL.with_values(options.thresholds)
    progress("reading", 0, None)
    with split_said(train):
        found = diagnose_records(
            arm,
            records(arm, train, test, options.mapping, thresholds.dataset, options.period),
            cutoff=options.cutoff,
            period=options.period,
            progress=progress,
            experiment=options.experiment,
            thresholds=thresholds,
            effects=wanted,
            where=Where(options.processes),
        )
    return Diagnosis(found, given(arm, train, test, options))


def _place(arm: Arm, text: str) -> tuple[str, int | None]:
    """Effect and joint of NAME or NAME:JOINT, the joint by its name or number. Raises InputError."""
    name, colon, joint = text.partition(":")
    return name, joint_number(arm, joint, f"--effect {text}") if colon else None


def _row(arm: Arm, c: NamedCause) -> list[str]:
    values = ", ".join(f"{n} {value_said(arm, c.effect, n, e)}" for n, e in legible(c.parameters).items())
    rivals = ", ".join(titled(arm, e, j) for e, j, _ in c.ambiguous_with)
    same = ", ".join(titled(arm, e, j) for e, j in c.aliases)
    gains = f"{c.cross_gain:z.1f}", "" if isnan(c.share.gain) else f"{c.share.gain:z.1f}"
    return [c.effect, place_of(arm, c.joint), values, f"{c.delta_bic:z.1f}", *gains, rivals, same]
