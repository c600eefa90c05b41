"""Trajectories that determine the base parameters well."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.results import Result, Table
from modelgen.description import Arm
from modelgen.excitation import Excitation as Found
from modelgen.excitation import excite as optimise
from modelgen.excitation.writing import data, files
from modelgen.files import check_folder, write_together
from modelgen.numeric import Array
from modelgen.options import ExcitationOptions, changed
from modelgen.progress import Progress, silent
from modelgen.report.call import Call
from modelgen.report.excitation import following, picture, report, separates, worst
from modelgen.report.parts import steps
from modelgen.report.words import limit_name


class Excitation(Result):
    """A trajectory of one period, of N samples of n joints.

    Parameters
    ----------
    found : modelgen.excitation.Excitation
        What the optimisation gives back.

    Attributes
    ----------
    arm : Arm
        The arm as described.
    t : ndarray
        (N,) times [s]; the period's end is left out.
    signals : mapping of str to ndarray
        (N, n) each: q, dq, ddq in joint coordinates [rad, m], qm, dqm, ddqm in motor coordinates, input
        [A; N m, N], effort [N m, N]; the latter two are NaN without nominal parameters.
    condition : float
        Condition number of the observation matrix with columns of unit norm.
    """

    def __init__(self, found: Found) -> None:
        self.found = found
        self.arm: Arm = found.arm
        self.t: Array = found.t
        self.signals: Mapping[str, Array] = found.signals
        self.condition = found.condition

    def to_json(self) -> dict[str, Any]:
        """Plain data: figures and coefficients of the trajectory.

        Returns
        -------
        dict
            Condition numbers, limits used, coefficients of the Fourier series by joint.
        """
        return data(self.found)

    def files(self, folder: Path | str = "", stem: str = "trajectory") -> Mapping[str, str]:
        """Text of every file that `modelgen excite` writes.

        Parameters
        ----------
        folder : Path or str
            Where they will be, which the commands on the page need. Default: the current folder.
        stem : str
            What their names begin with.

        Returns
        -------
        mapping of str to str
            Text by name: the trajectory, the set-points, JSON, a picture and a page.
        """
        call = Call(self.arm, folder=Path(folder))
        pages = {f"{stem}.svg": picture(self.found), f"{stem}.html": report(self.found, stem, call)}
        return files(self.found, stem) | pages

    def write(self, folder: Path | str, stem: str = "trajectory") -> None:
        """Write the files of the command into a folder, all of them or none.

        Parameters
        ----------
        folder : Path or str
            It is made where it does not exist.
        stem : str
            What the names of the files begin with.

        Raises
        ------
        InputError
            Where the folder cannot be written.
        """
        out = Path(folder)
        check_folder("--out", out)
        write_together("--out", out, self.files(out, stem))

    def next_steps(self, folder: Path | str = "", stem: str = "trajectory") -> Sequence[tuple[str, str]]:
        """What the page says is to be done next.

        Parameters
        ----------
        folder : Path or str
            Where the files are, which the commands need. Default: the current folder.
        stem : str
            What their names begin with.

        Returns
        -------
        sequence of tuple of str
            Each a sentence and the command for it, empty where there is none.
        """
        return steps(following(self.found, stem, Call(self.arm, folder=Path(folder))))

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen excite`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        e, made = self.found, self.to_json()
        rows = [[limit_name(e.arm, name), f"{100 * share:z.1f}"] for name, share in e.usage.items()]
        return [
            *(f"note: {remark}" for remark in made["remarks"]),
            f"{e.arm.name}: {separates(e)}",
            *worst(e),
            f"set-points: {made['samples']} in a period of {e.problem.settings.period:g} s",
            Table("limits", {"limit": "left", "used %": "right"}, rows),
        ]

    def __repr__(self) -> str:
        period = self.found.problem.settings.period
        return f"Excitation of {self.arm.name}: condition number {self.condition:z.4g}, period {period:g} s"


def excite(
    arm: Arm, options: ExcitationOptions | None = None, *, progress: Progress = silent, **changes: Any
) -> Excitation:
    """Compute a trajectory that determines the base parameters well, within the arm's limits.

    Parameters
    ----------
    arm : Arm
        An arm whose joints have limits of position and velocity.
    options : ExcitationOptions, optional
        Period, harmonics, criterion, boxes.
    progress : callable, optional
        It is called, from a thread of its own, with the starts that are done, iterations of all starts, and
        their most.
    **changes
        Fields of the options, by name.

    Returns
    -------
    Excitation
        The best trajectory of all starts, in joint and motor coordinates.

    Raises
    ------
    InputError
        For options that make no trajectory, and limits that are missing or exclude each other.

    References
    ----------
    Swevers, Ganseman, Tukel, De Schutter and Van Brussel, Optimal robot excitation and identification, 1997.
    """
    an_arm(arm)
    chosen = changed(options or ExcitationOptions(), changes)
    chosen.checked()
    progress(f"{arm.name}: writing the programme", 0, None)

    def iterated(ended: int, done: int, most: int) -> None:
        progress(f"{arm.name}: iterations of {chosen.starts} starts, {ended} done", done, most)

    return Excitation(optimise(arm, chosen, None if progress is silent else iterated))
