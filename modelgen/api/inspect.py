"""Logs as they are: a record, and what a log says about itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.logs import Log, listed
from modelgen.api.results import Shown, Table
from modelgen.dataset import Record, read
from modelgen.dataset.inspection import Channel, Inspected, inspect, inspection_svg, skeleton
from modelgen.dataset.processing.instants import EffortInstant
from modelgen.dataset.processing.stamps import EVEN, strayed
from modelgen.description import Arm
from modelgen.identification.effort_instant import effort_instant

_GUESSED = "?: guessed from names and sizes; the arm's description settles units, and which joints slide"


class Inspection(Shown):
    """What a log of N samples says about itself.

    Parameters
    ----------
    found : modelgen.dataset.inspection.Inspected
        What the inspection gives back.
    instant : EffortInstant, optional
        When the efforts were read, as the model of an arm finds it.

    Attributes
    ----------
    name : str
        What the log was called.
    samples : int
        Number of samples N.
    rate : float
        One over the median time between samples [Hz].
    jitter : float
        Largest deviation of that time from its median, in medians.
    period : float or None
        Period of the motion [s], None where it does not repeat.
    channels : tuple of Channel
        By column: name, unit, low, high, resolution, shares of repeated readings and of rest, spikes, missing
        readings; a guess of the unit where nobody has said it.
    """

    def __init__(self, found: Inspected, instant: EffortInstant | None = None) -> None:
        self.found, self.instant = found, instant
        self.name, self.samples = found.name, found.samples
        self.rate, self.jitter, self.period = found.rate, found.jitter, found.period
        self.channels: tuple[Channel, ...] = found.channels

    def to_json(self) -> dict[str, Any]:
        """Plain data: the facts, null where there is none.

        Returns
        -------
        dict
            Samples, time [s], rate [Hz], jitter, period [s], channels.
        """
        x = self.found
        return {
            "log": x.name,
            "samples": x.samples,
            "begin_s": _number(x.begin),
            "end_s": _number(x.end),
            "rate_hz": _number(x.rate),
            "jitter": _number(x.jitter),
            "backwards": x.backwards,
            "period_s": x.period,
            "channels": [
                {
                    "name": c.name,
                    "unit": c.unit or None,
                    "low": _number(c.low),
                    "high": _number(c.high),
                    "resolution": c.resolution,
                    "repeated": c.repeated,
                    "missing": c.missing,
                    "unit_guess": c.guess or None,
                    "at_rest": c.at_rest,
                    "spikes": c.spikes,
                }
                for c in x.channels
            ],
            "effort_instant": None if self.instant is None else self.instant.to_json(),
            "without_numbers": list(x.without_numbers),
            "remarks": list(x.remarks),
        }

    def picture(self) -> str:
        """The channels over time, and the time between samples.

        Returns
        -------
        str
            SVG.
        """
        return inspection_svg(self.found)

    def shown(self) -> Sequence[str | Table]:
        """Lines and a table of the channels.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        x = self.found
        parts: list[str | Table] = [self._headline()]
        if x.backwards:
            parts.append(f"time stands still or runs backwards at {x.backwards} of {x.samples} stamps")
        if not math.isnan(x.rate):
            parts.append("the motion does not repeat" if x.period is None else f"period {x.period:z.6g} s")
        rows = [
            [
                c.name,
                c.unit or (f"{c.guess}?" if c.guess else ""),
                f"{c.low:z.6g}",
                f"{c.high:z.6g}",
                "" if c.resolution is None else f"{c.resolution:z.4g}",
                f"{100 * c.repeated:z.1f}",
                "" if c.at_rest is None else f"{100 * c.at_rest:z.0f}",
                str(c.spikes or ""),
                str(c.missing or ""),
            ]
            for c in x.channels
        ]
        columns = {"column": "left", "unit": "left"}
        numbers = ("lowest", "highest", "resolution", "repeated %", "at rest %", "spikes", "missing")
        columns |= dict.fromkeys(numbers, "right")
        parts.append(Table("", columns, rows))
        if any(c.guess and not c.unit for c in x.channels):
            parts.append(_GUESSED)
        if x.without_numbers:
            parts.append(f"no numbers: {', '.join(x.without_numbers)}")
        asked = [] if self.instant is None else [self.instant.line(), *self.instant.questions()]
        return [*parts, *asked, *(f"note: {remark}" for remark in x.remarks)]

    def __repr__(self) -> str:
        return f"Inspection of {self._headline()}"

    def _headline(self) -> str:
        x = self.found
        if math.isnan(x.rate):
            return f"{x.name}: {len(x.channels)} columns, no time t that runs"
        jitter = "evenly sampled" if x.jitter < EVEN else strayed(x.jitter)
        time = f"{x.samples} samples from {x.begin:z.6g} s to {x.end:z.6g} s at {x.rate:z.6g} Hz"
        return f"{x.name}: {time}, {jitter}"


def read_log(log: Log, arm: Arm, *, mapping: Path | str | None = None) -> Record:
    """Read a log in the coordinates and units of an arm, through all checks.

    Parameters
    ----------
    log : log
        A path, "FILE@t0:t1" [s], or a table of columns: t [s], q<n> [rad, m] or qm<n> [motor unit], i<n> [A]
        or tau<n> [N m, N], n from 1.
    arm : Arm
        An arm with n coordinates.
    mapping : Path or str, optional
        A mapping file that renames and scales the columns of a foreign log.

    Returns
    -------
    Record
        N samples on a uniform time axis: t (N,) [s], q (N, n) [rad, m], motor (N, n) [motor unit], input
        (N, n) [A; N m, N without a drive]; `columns` and `units` have them by name. Every function that takes
        logs takes it.

    Raises
    ------
    InputError
        For a log that cannot be read, and for columns that are missing, doubled, not finite or out of range.
    """
    an_arm(arm)
    (one,) = listed(log, "log")
    return read(one, arm, mapping)


def inspect_log(log: Log, arm: Arm | None = None, *, mapping: Path | str | None = None) -> Inspection:
    """Say what is in a log: ranges, rate, jitter, resolution, repeated readings, period, instant of efforts.

    Parameters
    ----------
    log : log
        A path, "FILE@t0:t1" [s], a record, or a table of columns. Stamps t are in s.
    arm : Arm, optional
        With it the columns are those that are read for the arm, in its units, and its model says when the
        efforts were read. Default: all columns as the log has them.
    mapping : Path or str, optional
        A mapping file that renames and scales the columns of a foreign log. Without an arm they are those of
        joints without limits and gears.

    Returns
    -------
    Inspection
        Facts of the log and of its columns; it prints as a line and shows as a table.

    Raises
    ------
    InputError
        For a log that cannot be opened, and with an arm for one that cannot be read for it.
    """
    (one,) = listed(log, "log")
    found = inspect(one, arm, mapping)
    if arm is None or found.record is None:
        return Inspection(found)
    return Inspection(found, effort_instant([found.record], arm))


def mapping_skeleton(log: Log | Inspection, arm: Arm | None = None) -> str:
    """Guess a mapping file from the names and numbers of a log's columns; every guess is marked as one.

    Parameters
    ----------
    log : log or Inspection
        A path, "FILE@t0:t1" [s], or a table of columns; or what `inspect_log` found in one without arm and
        mapping.
    arm : Arm, optional
        Whose joints the mapping is for. Default: as many joints as columns look like positions.

    Returns
    -------
    str
        YAML text of a mapping file that the log can be read by.

    Raises
    ------
    InputError
        For a log that cannot be opened, and where too few columns look like positions.
    """
    if isinstance(log, Inspection):
        return skeleton(log.found, arm)
    (one,) = listed(log, "log")
    return skeleton(one, arm)


def _number(x: float) -> float | None:
    return x if math.isfinite(x) else None
