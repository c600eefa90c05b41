"""Parameters tuned until the simulated motion is the measured one."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.logs import Log, listed
from modelgen.api.results import Named, Result, Table
from modelgen.charts import apart
from modelgen.dataset import parse
from modelgen.description import Arm
from modelgen.functions.parameters_file import parameters_yaml
from modelgen.identification.output_error.refine import Refined
from modelgen.identification.output_error.refine import Refinement as Found
from modelgen.identification.refinement import refine_logs, to_json
from modelgen.options import RefinementOptions, changed
from modelgen.progress import Progress, silent
from modelgen.report.call import Call, files_of
from modelgen.report.parts import steps
from modelgen.report.refinement import deviation, headline, misses, picture, report
from modelgen.report.refinement_steps import following


class Refinement(Result):
    """Refined base parameters, and the simulated motion before and after.

    Parameters
    ----------
    found : modelgen.identification.output_error.refine.Refinement
        What the refinement gives back.
    call : modelgen.report.call.Call
        The arm as described, and what it was asked for with.

    Attributes
    ----------
    arm : Arm
        The arm as described.
    parameters : Named of Refined
        Base parameters (p,) by name: start, value, std (None where held, or not converged), unit.
    converged : bool
        Whether no step is left that lowers the errors by what is worth it; `found.stopped` says why not.
    """

    def __init__(self, found: Found, call: Call) -> None:
        self.found, self.call = found, call
        self.arm: Arm = found.plant.arm
        self.parameters: Named[Refined] = Named({x.name: x for x in found.parameters})
        self.converged = found.converged

    def to_json(self) -> dict[str, Any]:
        """Plain data: refinement.json.

        Returns
        -------
        dict
            Parameters and scores by joint, before and after.
        """
        return to_json(self.found)

    def files(self, folder: Path | str = "") -> Mapping[str, str]:
        """Text of every file that `modelgen refine` writes.

        Parameters
        ----------
        folder : Path or str
            Where they will be, which the commands on the page need. Default: the current folder.

        Returns
        -------
        mapping of str to str
            Text by name.
        """
        name = self.arm.name
        return {
            "refinement.json": json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n",
            f"{name}_parameters.yaml": parameters_yaml(
                name, {x.name: x.value for x in self.found.parameters}
            ),
            "refinement.svg": picture(self.found),
            "report.html": report(self.found, replace(self.call, folder=Path(folder))),
        }

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
        return steps(following(replace(self.call, folder=Path(folder)), self.found))

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen refine`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        rows = [
            [
                x.name,
                *apart(x.start, x.value, 5),
                deviation(x),
                x.unit,
            ]
            for x in self.found.parameters
        ]
        joints = [
            [
                name,
                *apart(j["f_gof_before"], j["f_gof"], 4),
                *missed,
            ]
            for name, j, missed in zip(
                self.arm.coordinate_names, self.to_json()["joints"], misses(self.found), strict=True
            )
        ]
        headings = ("joint", "F_gof % before", "after", "RMSE before", "after ", "unit")
        parameters = dict.fromkeys(("parameter", "start", "value", "std", "unit"), "right")
        return [
            headline(self.found),
            Table("", parameters, rows),
            Table("simulated motion", dict.fromkeys(headings, "right"), joints),
        ]

    def __repr__(self) -> str:
        free = sum(not x.held for x in self.found.parameters)
        after = ", ".join(f"{x:z.1f}" for x in self.found.after.f_gof)
        ended = "" if self.converged else ", not converged"
        return f"Refinement of {self.arm.name}: {free} parameters tuned{ended}, F_gof {after} %"


def refine(
    arm: Arm,
    log: Log | Sequence[Log],
    options: RefinementOptions | None = None,
    *,
    progress: Progress = silent,
    **changes: Any,
) -> Refinement:
    """Tune base parameters until the simulated motion is the measured one, with or without efforts.

    Parameters
    ----------
    arm : Arm
        An arm with n coordinates.
    log : log or sequence of logs
        Measured motions: paths, "FILE@t0:t1" [s], records, or tables of columns.
    options : RefinementOptions, optional
        Which parameters are free, and where they start.
    progress : callable, optional
        It is called with the step.
    **changes
        Fields of the options, by name.

    Returns
    -------
    Refinement
        Base parameters, scores by joint (n,) [%, rad, m].

    Raises
    ------
    InputError
        For unknown parameters, values that the motion does not tell apart, and simulations that do not run.

    References
    ----------
    Bock, Recent advances in parameter identification techniques for ODE, 1983.
    """
    an_arm(arm)
    chosen = changed(options or RefinementOptions(), changes)
    logs = listed(log, "log")
    names = files_of(parse(each).text for each in logs)
    call = Call(arm, names[:-1], names[-1:], chosen)
    return Refinement(refine_logs(arm, logs, chosen, progress), call)
