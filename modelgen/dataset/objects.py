"""A record: one log, or a part of one, in the coordinates and units of its arm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from html import escape
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm
from modelgen.numeric import Array


@dataclass(frozen=True)
class Uneven:
    """Efforts of a record at the stamps of its log, before they were moved to a uniform axis.

    stamps: (M,) [s]; efforts: (M, n) as logged; method: as the axis has it, "spline" and so on.
    """

    stamps: Array
    efforts: Array
    method: str


@dataclass(frozen=True)
class Record:
    """One log, or a part of one: N samples of an arm with n coordinates, on one uniform time axis.

    Parameters
    ----------
    name : str
        What the user called it (FILE@t0:t1).
    t : ndarray
        Times (N,) [s].
    q : ndarray
        Joint coordinates (N, n) [rad, m].
    motor : ndarray
        Motor coordinates (N, n) [motor unit], q where a joint has no drive.
    input : ndarray, optional
        Inputs (N, n) [A for a driven joint, N m or N for an undriven one], None for a free motion.
    gain : ndarray, optional
        What the input is multiplied by to give what the log carried, (N, n): K(q) where it carried tau<n>, 1
        where it carried a current.
    effort_unit : tuple of str
        Unit of what the log carried, by joint.
    dq, ddq : ndarray, optional
        Measured rates (N, n) [rad/s, m/s; rad/s^2, m/s^2] where the log has them.
    temperature : ndarray, optional
        Temperatures (N, n) [deg C].
    motor_side : tuple of bool
        Whether joint n was logged as qm<n>.
    hold : float
        Time by which the input lies after the position's stamp [s].
    remarks : tuple of str
        What the user should know.
    arm : Arm, optional
        Whose coordinates these are.
    core : tuple of int, optional
        In a block of a stream the samples to keep, (begin, end); the others are overlap with its neighbours.
        None for a whole record.
    first : int
        Number of the block's first sample in the whole.
    held : bool
        Whether the input is constant between its samples.
    repeats : float
        Rows of the log per new reading.
    jitter : float
        Largest deviation of the time between two samples from the period, in periods, before the samples were
        moved to their uniform axis.
    effort_hold : str or float
        When the efforts were read: "following", "previous" or "instant", or their delay [s].
    hold_known : str
        What says so: "mapping", "readings", or nothing, where it is the default.
    hold_std : float
        How far that may be off [s].
    counts : tuple of float
        Step of the logged positions by joint, in the unit that was logged, 0 where there is none; empty: not
        known, to be read off the samples.
    begins : float, optional
        First stamp in seconds since 1970, UTC; None where the stamps do not count from then.
    period : float, optional
        Samples in a period of the motion, as the log that this is a part of shows it; None: to be looked for.
    cut_off : ndarray of bool, optional
        Samples (N, n) at which an effort is cut off; None: to be read off the efforts.
    jump : str
        Where a position of the log jumps as no motion does, or rows are missing, and what to do; empty where
        nothing of that is found.
    absent : ndarray of bool, optional
        Samples (N, n) at which the log has no reading of an effort; None: it has all.
    uneven : Uneven, optional
        The efforts at their stamps, where the samples were moved to a uniform axis.

    Attributes
    ----------
    n : int
        Number of coordinates.
    step : float
        Sampling period [s].
    logged_effort : ndarray, optional
        Efforts (N, n) as the log carried them, in `effort_unit`; None for a free motion.
    columns : dict of str to ndarray
        Samples (N,) by the names of a log: t, q<n>, dq<n>, ddq<n>, i<n> or tau<n>, temperature<n>.
    units : dict of str to str
        Unit of each of the columns.
    """

    name: str
    t: Array
    q: Array
    motor: Array
    input: Array | None = None
    gain: Array | None = None
    effort_unit: tuple[str, ...] = ()
    dq: Array | None = None
    ddq: Array | None = None
    temperature: Array | None = None
    motor_side: tuple[bool, ...] = ()
    hold: float = 0.0
    remarks: tuple[str, ...] = field(default=())
    arm: Arm | None = None
    core: tuple[int, int] | None = None
    first: int = 0
    held: bool = False
    repeats: float = 1.0
    jitter: float = 0.0
    effort_hold: str | float = "following"
    hold_known: str = ""
    hold_std: float = 0.0
    counts: tuple[float, ...] = ()
    begins: float | None = None
    period: float | None = None
    cut_off: NDArray[np.bool_] | None = None
    jump: str = ""
    absent: NDArray[np.bool_] | None = None
    uneven: Uneven | None = None

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.q.shape[1])

    @property
    def joint_names(self) -> list[str]:
        """Names of the coordinates' joints; their numbers, where no arm is known."""
        return [f"joint {k + 1}" for k in range(self.n)] if self.arm is None else self.arm.coordinate_names

    @property
    def step(self) -> float:
        """Sampling period [s]."""
        return float(self.t[-1] - self.t[0]) / (len(self.t) - 1)

    @property
    def logged_effort(self) -> Array | None:
        """Efforts (N, n) as the log carried them, in `effort_unit`; None for a free motion."""
        if self.input is None or self.gain is None:
            return self.input
        return self.input * self.gain

    @property
    def columns(self) -> dict[str, Array]:
        """Samples (N,) by the names of a log: t, q<n>, dq<n>, ddq<n>, i<n> or tau<n>, temperature<n>."""
        tables = {"q": self.q, "dq": self.dq, "ddq": self.ddq, "temperature": self.temperature}
        found = {"t": self.t}
        for kind, table in tables.items():
            found |= {} if table is None else {f"{kind}{k + 1}": table[:, k] for k in range(self.n)}
        if self.input is not None:
            found |= {f"{self._effort(k)}{k + 1}": self.input[:, k] for k in range(self.n)}
        return found

    @property
    def units(self) -> dict[str, str]:
        """Unit of each of the columns."""
        found = {"t": "s"}
        for name in self.columns:
            kind, number = name.rstrip("0123456789"), name.lstrip("abcdefghijklmnopqrstuvwxyz")
            if number:
                length = self._prismatic(int(number) - 1)
                position = "m" if length else "rad"
                effort = {"i": "A", "tau": "N" if length else "N m", "temperature": "deg C"}
                rates = {"q": position, "dq": f"{position}/s", "ddq": f"{position}/s^2"}
                found[name] = (effort | rates)[kind]
        return found

    def _effort(self, k: int) -> str:
        if self.arm is None:
            return "i" if self.effort_unit[k : k + 1] == ("A",) else "tau"
        return "i" if self.arm.joints[self.arm.coordinates[k]].drive.driven else "tau"

    def _prismatic(self, k: int) -> bool:
        return self.arm is not None and self.arm.joints[self.arm.coordinates[k]].type == "prismatic"

    def __repr__(self) -> str:
        names = [name for name in self.columns if name != "t"]
        time = f"{len(self.t)} samples from {self.t[0]:.6g} s to {self.t[-1]:.6g} s at {1 / self.step:.6g} Hz"
        return f"Record {self.name}: {time}, {', '.join(names)}"

    def _repr_html_(self) -> str:
        units = self.units
        rows = "".join(
            f"<tr><td>{name}</td><td>{units[name]}</td><td>{x.min():.6g}</td><td>{x.max():.6g}</td></tr>"
            for name, x in self.columns.items()
        )
        head = "<tr><th>column</th><th>unit</th><th>lowest</th><th>highest</th></tr>"
        return f"<table><caption>{escape(repr(self))}</caption>{head}{rows}</table>"

    def part(self, begin: int, end: int, name: str = "") -> Record:
        """Samples begin to end as a record of their own.

        Parameters
        ----------
        begin, end : int
            Numbers of the first sample and of the one after the last.
        name : str
            Its name. Default: that of the whole.

        Returns
        -------
        Record
            The part, with (end - begin) samples.
        """

        def cut(values: Array | None) -> Array | None:
            return None if values is None else values[begin:end]

        return replace(
            self,
            name=name or self.name,
            t=self.t[begin:end],
            q=self.q[begin:end],
            motor=self.motor[begin:end],
            input=cut(self.input),
            gain=cut(self.gain),
            dq=cut(self.dq),
            ddq=cut(self.ddq),
            temperature=cut(self.temperature),
            core=None,
            cut_off=None if self.cut_off is None else self.cut_off[begin:end],
            absent=None if self.absent is None else self.absent[begin:end],
            begins=None if self.begins is None else self.begins + float(self.t[begin] - self.t[0]),
        )


@dataclass(frozen=True)
class Layout:
    """How a text file holds a table, as far as somebody has said it; the rest is found out.

    columns: names where there is no header. delimiter: between cells, " " for blanks. decimal: its sign.
    encoding: of the text. skip_lines: lines passed over at the beginning.
    """

    columns: tuple[str, ...] = ()
    delimiter: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    skip_lines: int = 0


@dataclass(frozen=True)
class Wanted:
    """Columns that are asked of a reader, the time first, and what is known of them.

    positions, efforts: of the names, as far as somebody says so. turning: positions that begin anew after a
    turn.
    """

    names: tuple[str, ...]
    positions: frozenset[str] = frozenset()
    efforts: frozenset[str] = frozenset()
    turning: frozenset[str] = frozenset()


class Reader(Protocol):
    """A file with named columns."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was found out about the file and assumed, as far as it has been read."""

    @property
    def by_column(self) -> bool:
        """Whether a column is read without the others."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns, in the file's order; doubled ones as often as they stand there."""

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns (rows at most, len(wanted.names)), block after block. Raises InputError."""
