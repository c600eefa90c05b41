"""Parameters from logs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.api.description import an_arm
from modelgen.api.logs import Log, listed
from modelgen.api.results import Named, Result, Table
from modelgen.charts import in_percent, known, number, sheet
from modelgen.dataset import spectra, split_said
from modelgen.description import Arm
from modelgen.effects.editing import with_torque_constants
from modelgen.functions.parameters_file import parameters_yaml
from modelgen.identification import Estimate, Validation
from modelgen.identification.summary import impossible
from modelgen.identification.workflow import Outcome, identify_logs
from modelgen.options import IdentificationOptions, changed
from modelgen.progress import Progress, silent
from modelgen.report.call import Call, files_of
from modelgen.report.identification import following, models, picture, report, table
from modelgen.report.page import Lines, Part
from modelgen.report.parts import steps
from modelgen.report.records import records_table
from modelgen.report.words import joint_name


class Identification(Result):
    """Base parameters with their uncertainty, and how they do on test logs.

    Parameters
    ----------
    outcome : modelgen.identification.workflow.Outcome
        What the identification gives back.
    call : modelgen.report.call.Call
        The arm as described, and what it was asked for with.

    Attributes
    ----------
    arm : Arm
        The arm, with the torque constants that were found where gains are estimated.
    parameters : Named of Estimate
        Base parameters (p,) by name: value, std, unit.
    test : Validation or None
        Errors on the test logs by joint: rmse (n,) in `unit`, nrmse_percent (n,).
    """

    def __init__(self, outcome: Outcome, call: Call) -> None:
        self.outcome, self.call = outcome, call
        self.arm: Arm = outcome.found.arm
        self.parameters: Named[Estimate] = Named({e.name: e for e in outcome.found.estimates})
        self.test: Validation | None = outcome.found.test

    def to_json(self) -> dict[str, Any]:
        """Plain data: identification.json.

        Returns
        -------
        dict
            Parameters, errors on the test logs, condition number, verdict.
        """
        return self.outcome.data

    def files(self, folder: Path | str = "") -> Mapping[str, str]:
        """Text of every file that `modelgen identify` writes.

        Parameters
        ----------
        folder : Path or str
            Where they will be, which the commands on the page need. Default: the current folder.

        Returns
        -------
        mapping of str to str
            Text by name.
        """
        o, found, data = self.outcome, self.outcome.found, self.outcome.data
        name, drawn = found.arm.name, spectra(o.first)
        call = replace(self.call, folder=Path(folder))
        files = {
            "identification.json": json.dumps(data, indent=2, allow_nan=False) + "\n",
            f"{name}_parameters.yaml": parameters_yaml(name, {e.name: e.value for e in found.estimates}),
            "spectra.svg": sheet(drawn, 2),
            "report.html": report(found, o.others, _of_logs(o), drawn, call, self._speeds()),
        }
        if found.test is not None:
            files["test.svg"] = picture(found.test, found.arm.coordinate_names, o.others)
        if found.gains:
            constants = {g.joint: g.value for g in found.gains}
            files[f"{name}_identified.yaml"] = with_torque_constants(found.arm, constants)
        return files

    def next_steps(self, folder: Path | str = "") -> Sequence[tuple[str, str]]:
        """What the page says is to be done next.

        Parameters
        ----------
        folder : Path or str
            Where the files are, which the commands need. Default: the current folder.

        Returns
        -------
        sequence of tuple of str
            Each a sentence and the command for it, empty where there is none.
        """
        call = replace(self.call, folder=Path(folder))
        return steps(following(self.outcome.found, call, self._speeds()))

    def _speeds(self) -> list[float]:
        """The largest speed of every joint (n,) in the first record [rad/s, m/s]."""
        first = self.outcome.first
        largest: list[float] = np.abs(first.picked(first.dq)).max(axis=0).tolist()
        return largest

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen identify`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        o, found = self.outcome, self.outcome.found
        rows = [
            [
                e.name,
                known(e.value, e.std),
                "" if e.std is None else f"{e.std:z.2g}",
                "" if e.relative is None else in_percent(e.relative),
                e.unit,
                "yes" if e.essential else "left out" if e.dropped else "no",
            ]
            for e in found.estimates
        ]
        headings = ("parameter", "value", "std", "std %", "unit", "essential")
        parts: list[str | Table] = [Table("", dict.fromkeys(headings, "right"), rows)]
        if found.gains:
            names = [joint_name(self.arm, g.joint) for g in found.gains]
            rows = [
                [name, number(g.described, 5), known(g.value, g.std), f"{g.std:z.2g}"]
                for name, g in zip(names, found.gains, strict=True)
            ]
            columns = dict.fromkeys(("joint", "described", "found", "std"), "right")
            parts.append(Table("torque constants", columns, rows))
        if found.test is not None:
            parts += _test_tables(found.test, o)
        if o.folds is not None:
            heads = {"held out": "left"} | dict.fromkeys(self.arm.coordinate_names, "right")
            rows = [[name, *(f"{x:z.1f}" for x in part.nrmse_percent)] for name, part in o.folds.parts]
            rows.append(["all together", *(f"{x:z.1f}" for x in o.folds.nrmse_percent)])
            title = "NRMSE % of parts of the training records, each held out in its turn"
            parts.append(Table(title, heads, rows))
        return [*parts, *_processing(o), o.data["verdict"]]

    def details(self) -> Sequence[str]:
        """Remarks on the logs that `shown` leaves out, as `modelgen identify --verbose` prints them.

        Returns
        -------
        sequence of str
            A line each.
        """
        return [f"log: {line}" for line in self.outcome.log.brief()[1]]

    def __repr__(self) -> str:
        errors = ""
        if self.test is not None:
            errors = f", test NRMSE {', '.join(f'{x:z.1f}' for x in self.test.nrmse_percent)} %"
        wrong = "".join(f". {text}" for text in impossible(self.outcome.found))
        return f"Identification of {self.arm.name}: {len(self.parameters)} base parameters{errors}{wrong}"


def identify(
    arm: Arm,
    train: Log | Sequence[Log],
    test: Log | Sequence[Log] = (),
    options: IdentificationOptions | None = None,
    *,
    progress: Progress = silent,
    **changes: Any,
) -> Identification:
    """Find the base parameters from logs, with their uncertainty, and validate them on other logs.

    Parameters
    ----------
    arm : Arm
        An arm with n coordinates and p base parameters.
    train : log or sequence of logs
        Training logs: paths, "FILE@t0:t1" [s], records, or tables of columns.
    test : log or sequence of logs
        Logs that are not fitted. Without one a single training log is split in two.
    options : IdentificationOptions, optional
        Method, processing, torque constants.
    progress : callable, optional
        It is called with what is done, how much of it, and of how much (None where that is not known).
    **changes
        Fields of the options, by name.

    Returns
    -------
    Identification
        Parameters (p,) in SI units of the standard parameters they stand for, errors by joint (n,).

    Raises
    ------
    InputError
        For logs that cannot be read, overlap or move too little, and options that do not go together.

    References
    ----------
    Gautier, Dynamic identification of robots with power model, 1997. Janot, Vandanjon and Gautier, A generic
    instrumental variable approach for industrial robot identification, 2014.
    """
    an_arm(arm)
    chosen = changed(options or IdentificationOptions(), changes)
    training, testing = listed(train, "train"), listed(test, "test")
    with split_said(training):
        outcome = identify_logs(arm, training, testing, chosen, progress)
    fitted, held = (files_of(x.name for x in part) for part in (outcome.log.train, outcome.log.test))
    return Identification(outcome, Call(arm, fitted, held, chosen))


def _of_logs(o: Outcome) -> list[Part]:
    """What the page says of the logs."""
    return [Lines(_processing(o, every=True)), records_table(o.log.recorded())]


def _processing(o: Outcome, *, every: bool = False) -> list[str]:
    """What was found out about the logs, in few lines or every one, and how they were processed."""
    # the first says how many samples there are, as the log does
    steps = [line for line in o.data["processing"][1:] if line not in o.log.remarks]
    lines = o.log.lines() if every else o.log.brief()[0]
    return [*(f"log: {line}" for line in lines), *steps]


def _test_tables(test: Validation, o: Outcome) -> list[str | Table]:
    names = o.found.arm.coordinate_names
    rows = [[names[j], a, test.unit[j], b] for j, (a, b) in enumerate(table(test))]
    columns = dict.fromkeys(("joint", "RMSE", "unit", "NRMSE %"), "right")
    parts: list[str | Table] = [Table("test records", columns, rows)]
    if o.others:
        heads = {"model": "left"} | {
            f"{name} [{unit}]": "right" for name, unit in zip(names, test.unit, strict=True)
        }
        rows = [[name, *cells] for name, cells in models(test, o.others)]
        title = "RMSE on the test records (NRMSE %), and what the described drives change"
        parts.append(Table(title, heads, rows))
    return parts
