"""A mapping file to start from: what a log's columns seem to be, by their names and numbers."""

from __future__ import annotations

import json

from modelgen.dataset.inspection.channels import Inspected, inspect
from modelgen.dataset.inspection.guesses import kind_of, time_of, unit_of_angle, unit_of_time
from modelgen.dataset.mapping.units import EFFORTS, LENGTHS, POSITIONS
from modelgen.dataset.reading.column_table import Log
from modelgen.description import Arm
from modelgen.errors import InputError


def skeleton(log: Log | Inspected, arm: Arm | None = None) -> str:
    """A mapping file (YAML) for a log; every guess is marked as one. Raises InputError where nothing fits.

    log: also as `inspect` has found it without an arm, whose columns are those of the log.
    """
    seen = log if isinstance(log, Inspected) else inspect(log)
    text, columns = seen.name, dict(seen.columns)
    said = {channel.name: channel.unit or channel.guess for channel in seen.channels}
    found: dict[str, list[str]] = {}
    time = time_of(columns)
    for name in columns:
        kind = kind_of(name)
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
        unit = said.get(time) or unit_of_time(columns[time], time)
        lines.append(f"time: {{column: {json.dumps(time)}, unit: {unit}, relative: true}}  # ? unit")
    lines.append(
        "# hold: following  # instant, previous, or a delay [s]; where nothing is said, the data are asked"
    )
    lines.append("joints:")
    for k in range(n):
        name = "" if arm is None else f"  # {arm.joints[arm.coordinates[k]].name}"
        prismatic = arm is not None and arm.joints[arm.coordinates[k]].type == "prismatic"
        unit = said[positions[k]]
        if unit not in (LENGTHS if prismatic else POSITIONS["rad"]):
            unit = "m" if prismatic else unit_of_angle(columns[positions[k]])
        lines.append(f"  - position: {{column: {json.dumps(positions[k])}, unit: {unit}}}  # ?{name}")
        if k < len(efforts):
            effort = said[efforts[k]]
            wrong = ("N m", "N mm", "kN m") if prismatic else ("N", "kN")
            if effort not in EFFORTS or effort in wrong:
                effort = "A" if "current" in found else "N" if prismatic else "N m"
            lines.append(f"    effort: {{column: {json.dumps(efforts[k])}, unit: {effort}}}  # ?")
    return "\n".join(lines) + "\n"
