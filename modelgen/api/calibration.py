"""A lever's geometry from motor counts and measured angles."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm, joint_number
from modelgen.api.logs import Log, listed
from modelgen.api.results import Named, Result, Table
from modelgen.calibration import Calibration as Found
from modelgen.calibration import Estimate, calibrated_yaml
from modelgen.calibration.workflow import calibrate_log, data
from modelgen.description import Arm, loads
from modelgen.effects import known_effects
from modelgen.options import CalibrationOptions, changed
from modelgen.report.calibration import (
    beside,
    errors,
    following,
    picture,
    report,
    stands,
    values,
    verdict,
)
from modelgen.report.call import Call
from modelgen.report.parts import steps
from modelgen.report.words import joint_name


class Calibration(Result):
    """The geometry of a lever as described and as found.

    Parameters
    ----------
    arm : Arm
        The arm as described.
    found : modelgen.calibration.Calibration
        What the calibration gives back.

    Attributes
    ----------
    arm : Arm
        The arm as described.
    parameters : Named of Estimate
        Lengths [m], motor coordinates and offset [rad] by name: before, value, std, unit.
    """

    def __init__(self, arm: Arm, found: Found) -> None:
        self.arm, self.found = arm, found
        self.parameters: Named[Estimate] = Named({e.name: e for e in found.estimates})

    def to_json(self) -> dict[str, Any]:
        """Plain data: calibration.json.

        Returns
        -------
        dict
            Errors of the angle [rad] before and after, parameters of the lever.
        """
        return data(self.arm, self.found)

    def files(self, folder: Path | str = "") -> Mapping[str, str]:
        """Text of every file that `modelgen calibrate` writes.

        Parameters
        ----------
        folder : Path or str
            Where they will be, which the commands on the page need. Default: the current folder.

        Returns
        -------
        mapping of str to str
            Text by name.

        Raises
        ------
        InputError
            Where the description with the lever as found could not be read.
        """
        c, name = self.found, f"{self.arm.name}_calibrated.yaml"
        described = calibrated_yaml(self.arm, c.joint, c.after)
        loads(described, name, known_effects())  # what is written must be readable
        return {
            "calibration.json": json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n",
            name: described,
            "calibration.svg": picture(self.arm, c),
            "report.html": report(self.arm, c, Call(self.arm, folder=Path(folder))),
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
        return steps(following(Call(self.arm, folder=Path(folder)), stands(self.found)))

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen calibrate`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        c = self.found
        before, after = errors(c)
        parts: list[str | Table] = [
            f"{self.arm.name}, {joint_name(self.arm, c.joint)}: "
            f"RMSE of the angle {before} -> {after} deg "
            f"({c.improvement_percent:z.1f} % better), {len(c.motor)} samples",
            verdict(c),
            *beside(c),
        ]
        sides = {"": "left", "described": "right", "calibrated": "right", "std": "right", "unit": "left"}
        return [*parts, Table("", sides, values(c)), *(f"not determined: {words}" for words in c.weak)]

    def __repr__(self) -> str:
        c = self.found
        said = f"RMSE {' -> '.join(errors(c))} deg"
        return f"Calibration of {self.arm.name}, {joint_name(self.arm, c.joint)}: {said}"


def calibrate(
    arm: Arm, joint: int | str, log: Log, options: CalibrationOptions | None = None, **changes: Any
) -> Calibration:
    """Fit a lever's geometry to motor counts and measured joint angles.

    Parameters
    ----------
    arm : Arm
        An arm with a levered drive.
    joint : int or str
        The coordinate by its number, from 1, or by the joint's name.
    log : log
        A log with t [s], qm<joint> [motor unit] and the measured q<joint> [rad]; N samples.
    options : CalibrationOptions, optional
        How well the lengths are known.
    **changes
        Fields of the options, by name.

    Returns
    -------
    Calibration
        Lengths [m], offset [rad] and branch, with standard deviations.

    Raises
    ------
    InputError
        For an unknown joint or one without a lever, missing columns, and data that determine nothing.

    References
    ----------
    Beck and Arnold, Parameter Estimation in Engineering and Science, 1977, chapter 6.
    """
    an_arm(arm)
    (one,) = listed(log, "log")
    chosen = changed(options or CalibrationOptions(), changes)
    return Calibration(arm, calibrate_log(arm, joint_number(arm, joint, "--joint"), one, chosen))
