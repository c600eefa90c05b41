"""Simulated motions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.logs import Log, listed
from modelgen.api.results import Shown, Table
from modelgen.description import Arm
from modelgen.files import check_folder, write_together
from modelgen.numeric import Array
from modelgen.options import SimulationOptions, changed
from modelgen.progress import Progress, silent
from modelgen.report.animation import animation
from modelgen.simulation.output import log_table, picture, table
from modelgen.simulation.workflow import Simulated, simulated


class Simulation(Shown):
    """S samples of a simulated motion of n joints, and how it does against logs where there are any.

    Parameters
    ----------
    found : modelgen.simulation.workflow.Simulated
        What the simulation gives back.

    Attributes
    ----------
    arm : Arm
        The arm as simulated.
    t : ndarray
        (S,) times [s].
    q, dq : ndarray
        (S, n) joint coordinates [rad, m] and their rates.
    inputs : ndarray or None
        (S, n) inputs [A for a driven joint, N m or N for another]; None of a free motion and of a replay.
    log : mapping of str to ndarray, or None
        Columns (S,) as a logger would have kept them: t [s], q<n> [rad, m] or qm<n> [motor unit], inputs. It
        is a log that every function takes.
    ended : str
        Why the motion broke off before its time; empty where it did not.
    """

    def __init__(self, found: Simulated) -> None:
        self.found = found
        self.arm: Arm = found.plant.arm
        self.t: Array = found.t
        self.q: Array = found.q
        self.dq: Array = found.dq
        self.inputs: Array | None = found.inputs
        self.log = found.log
        self.ended = found.ended

    def to_json(self) -> dict[str, Any]:
        """Plain data: what `modelgen simulate --json` prints.

        Returns
        -------
        dict
            End, rest and energy of a motion; F_gof, MAE and RMSE by joint against logs.
        """
        return self.found.data

    def table(self) -> str:
        """The motion as CSV, or as a log has it where the options ask for encoders, noise or instants.

        Returns
        -------
        str
            Columns t [s], q<n> [rad, m], dq<n>, and the inputs where there are any; of a log those of `log`.
        """
        if self.log is not None:
            return log_table(self.log)
        return table(self.found.plant, self.t, self.q, self.dq, self.inputs)

    def picture(self) -> str:
        """Position and speed of every joint over time.

        Returns
        -------
        str
            SVG.
        """
        return picture(self.found.plant, self.t, self.q, self.dq, self.found.measured)

    def animation(self) -> str:
        """The moving arm.

        Returns
        -------
        str
            One HTML file.
        """
        return animation(self.arm, self.t, self.q)

    def files(self, stem: str = "simulation") -> Mapping[str, str]:
        """Text of the files that `modelgen simulate` writes with --out, --plot and --animation.

        Parameters
        ----------
        stem : str
            What their names begin with.

        Returns
        -------
        mapping of str to str
            Text by name: the table, the picture and the animation.
        """
        return {f"{stem}.csv": self.table(), f"{stem}.svg": self.picture(), f"{stem}.html": self.animation()}

    def write(self, folder: Path | str, stem: str = "simulation") -> None:
        """Write table, picture and animation into a folder, all of them or none.

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
        write_together("--out", out, self.files(stem))

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen simulate`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        parts = _motion(self.found) if self.found.trajectory is not None else _scores(self.found)
        return [self.found.note, *parts] if self.found.note else parts

    def __repr__(self) -> str:
        head = f"Simulation of {self.arm.name}: {len(self.t)} samples over {self.t[-1] - self.t[0]:g} s"
        if self.found.replays:
            scores = [j["f_gof_percent"] for j in self.to_json()["joints"]]
            head += f", F_gof {', '.join(_cell(x, 1) or 'none' for x in scores)} %"
        return f"{head}; ended early: {self.ended}" if self.ended else head


def simulate(
    arm: Arm,
    log: Log | Sequence[Log] = (),
    options: SimulationOptions | None = None,
    *,
    progress: Progress = silent,
    **changes: Any,
) -> Simulation:
    """Simulate the model: free, under control, or with the inputs of logs to be held against them.

    Parameters
    ----------
    arm : Arm
        An arm with nominal values, or with `parameters` among the options.
    log : log or sequence of logs
        Measured logs whose inputs drive the model; several are runs of one motion.
    options : SimulationOptions, optional
        Initial state [rad, m; /s], duration [s], control, integrator.
    progress : callable, optional
        It is called with the simulated time [s], and of how much.
    **changes
        Fields of the options, by name.

    Returns
    -------
    Simulation
        The motion (S, n), its energy, or its scores against the logs. Where it broke off early, `ended`
        says why.

    Raises
    ------
    InputError
        For options that do not go together, missing nominal values and a state outside the stroke.
    """
    an_arm(arm)
    chosen = changed(options or SimulationOptions(), changes)
    return Simulation(simulated(arm, listed(log, "log"), chosen, progress))


def _motion(s: Simulated) -> list[str | Table]:
    p, data, q = s.plant, s.data, s.q
    rows = [
        [name, f"{q0:z.6g}", f"{q1:z.6g}", f"{low:z.6g}", f"{high:z.6g}", unit]
        for name, q0, q1, low, high, unit in zip(
            p.names, q[0], q[-1], q.min(axis=0), q.max(axis=0), p.arm.coordinate_units, strict=True
        )
    ]
    headings = {"joint": "left"} | dict.fromkeys(("q begin", "q end", "lowest", "highest"), "right")
    rest, energy = data["at_rest_from"], data["energy"]
    return [
        Table("", headings | {"unit": "left"}, rows),
        "moves until the end" if rest is None else f"at rest from {rest:z.6g} s on",
        f"energy {energy['begin']:z.6g} J at the beginning, {energy['end'] - energy['begin']:+z.6g} J since",
    ]


def _scores(s: Simulated) -> list[str | Table]:
    data, several = s.data, len(s.replays) > 1
    columns = {"run": "left"} if several else {}
    columns |= dict.fromkeys(("joint", "F_gof %", "MAE", "RMSE", "unit"), "right")
    parts = [(x["log"], x["joints"]) for x in data["runs"]] if several else []
    rows = []
    for name, joints in [*parts, ("mean of all" if several else "", data["joints"])]:
        for j in joints:
            row = [
                s.plant.names[j["joint"] - 1],
                _cell(j["f_gof_percent"], 2),
                _cell(j["mae"], 6),
                _cell(j["rmse"], 6),
            ]
            rows.append([*([name] if several else []), *row, j["unit"]])
    shown: list[str | Table] = [Table("", columns, rows)]
    if several:
        said = ", ".join(f"{j['scatter']:z.3g} {j['unit']}" for j in data["joints"])
        shown.append(Table("", {"scatter of the runs, which no model can explain": "left"}, [[said]]))
    return shown


def _cell(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"
