"""A mapping file to start from: what a log's columns seem to be, by their names and numbers."""

from __future__ import annotations

import json
import re

import numpy as np

from modelgen.dataset.inspection.channels import columns_of_log
from modelgen.dataset.mapping.units import plausible_times
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.specs import parse
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array

_TIME = re.compile(
    r"(^|[^a-z])(t|time|stamp|timestamp|clock)([^a-z]|$)|header\.stamp|time_?stamp", re.IGNORECASE
)
_KINDS = (
    ("velocity", re.compile(r"vel|speed|(^|[^a-z])(dq|qd|rpm)", re.IGNORECASE)),
    ("acceleration", re.compile(r"acc|ddq|qdd", re.IGNORECASE)),
    ("temperature", re.compile(r"temp", re.IGNORECASE)),
    ("current", re.compile(r"cur|amp|(^|[^a-z])i(_|\d|$|\[)", re.IGNORECASE)),
    ("torque", re.compile(r"tau|torq|effort|force|load|moment", re.IGNORECASE)),
    ("position", re.compile(r"pos|angle|(^|[^a-z])(q|qm)(_|\d|$|\[)|enc|deg|rad", re.IGNORECASE)),
)


def skeleton(log: Log, arm: Arm | None = None) -> str:
    """A mapping file (YAML) for a log; every guess is marked as one. Raises InputError where nothing fits."""
    text = parse(log).text
    columns, _ = columns_of_log(log)
    found: dict[str, list[str]] = {}
    time = _time(columns)
    for name in columns:
        kind = next((k for k, pattern in _KINDS if pattern.search(name)), None)
        if kind is not None and name != time:
            found.setdefault(kind, []).append(name)
    positions = found.get("position", [])
    efforts = found.get("current") or found.get("torque") or []
    n = len(positions) if arm is None else len(arm.coordinates)
    if len(positions) < n or not n:
        raise InputError(
            f"{text}: found {len(positions)} columns whose names look like positions, expected "
            f"{n or 'some'}; columns: {', '.join(list(columns)[:30])}"
        )
    lines = ["# Units, sides and signs marked with a question mark are guesses: look at each.", "schema: 1"]
    if time is None:
        lines.append("rate: 100  # ? samples per second: found no column of stamps")
    else:
        unit = _unit_of_time(columns[time])
        lines.append(f"time: {{column: {json.dumps(time)}, unit: {unit}, relative: true}}  # ? unit")
    lines += ["hold: following  # ? instant, where the effort was read with the position", "joints:"]
    for k in range(n):
        name = "" if arm is None else f"  # {arm.joints[arm.coordinates[k]].name}"
        prismatic = arm is not None and arm.joints[arm.coordinates[k]].type == "prismatic"
        unit = "m" if prismatic else _unit_of_angle(columns[positions[k]])
        lines.append(f"  - position: {{column: {json.dumps(positions[k])}, unit: {unit}}}  # ?{name}")
        if k < len(efforts):
            effort = "A" if "current" in found else "N" if prismatic else "N m"
            lines.append(f"    effort: {{column: {json.dumps(efforts[k])}, unit: {effort}}}  # ?")
    return "\n".join(lines) + "\n"


def _time(columns: dict[str, Array]) -> str | None:
    """The column of the stamps: its name says so, and it does not fall."""
    rising = [
        name for name, x in columns.items() if len(x) > 1 and np.ptp(x) > 0 and np.all(np.diff(x) >= 0.0)
    ]
    named = [name for name in rising if _TIME.search(name)]
    return next(iter(named), None)


def _unit_of_time(stamps: Array) -> str:
    """The unit that makes the step one of a robot's logs."""
    return next(iter(plausible_times(float(np.median(np.diff(stamps))))), "s")


def _unit_of_angle(values: Array) -> str:
    return "rad" if float(np.nanmax(np.abs(values))) < 4 * np.pi else "deg"
