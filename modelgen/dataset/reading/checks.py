"""Checks of a record before anything is computed from it; each refusal says what to do."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np

from modelgen.dataset.drives import NumericDrive
from modelgen.dataset.processing.content import noise_alone
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.transmission import of_joint

LARGEST = 1e30  # beyond nanoseconds since 1970 and counts of 64 bits; its square is still a number


def check_finite(file: str, stamps: Array, names: tuple[str, ...], block: Array, first: int = 0) -> None:
    """No NaN, no infinity and no number beyond all units in a block (N, k) of columns. Raises InputError."""
    finite = np.abs(block) < LARGEST
    if not finite.all():
        wrong = np.argwhere(~finite)
        row, column = (int(x) for x in wrong[0])
        time = f"t = {stamps[row]:.9g} s" if np.isfinite(stamps[row]) else f"sample {first + row + 1}"
        raise InputError(
            f"{file}: found {block[row, column]} in the column {names[column]} at {time}, expected a finite "
            f"number below {LARGEST:g} ({len(wrong)} such in this block); use the parts beside it, FILE@t0:t1"
        )


def check_constant(
    file: str,
    arm: Arm,
    names: tuple[str | None, ...],
    columns: Array,
    what: str,
    samples: int | None = None,
    held: Collection[int] = (),
) -> None:
    """Positions and efforts must change, but for undriven joints without any effort. Raises InputError.

    columns: (N, n), or their lowest and highest values (2, n) over `samples`. held: joints that may stand, by
    number of the coordinate from 0.
    """
    count = len(columns) if samples is None else samples
    if what == "position" and len(names) > 1 and not np.ptp(columns, axis=0).any():
        raise InputError(
            f"{file}: all {len(names)} joints are at rest in all {count} samples, expected a motion; "
            "see modelgen excite"
        )
    for k, name in enumerate(names):
        if name is None or k in held or np.ptp(columns[:, k]) > 0.0:
            continue
        drive, joint = arm.joints[arm.coordinates[k]].drive, arm.joints[arm.coordinates[k]].name
        if what == "effort" and not drive.driven and columns[0, k] == 0.0:
            continue
        advice = (
            f"where joint {joint} was held, lock it in the description, locked: {{{joint}: ...}}"
            if what == "position"
            else "where the arm moved freely, leave the effort columns out"
        )
        raise InputError(
            f"{file}: the {what} {name} is {columns[0, k]:.6g} in all {count} samples, expected one "
            f"that changes; {advice}"
        )


def trembling(file: str, names: Sequence[str], columns: Array) -> list[str]:
    """Remarks about positions (N, n) that are noise of a joint at rest. Raises InputError where all are."""
    found, step, whole = noise_alone(columns), np.diff(columns, axis=0).std(axis=0), columns.std(axis=0)
    if found.all():
        others = ", and the other positions likewise," if len(names) > 1 else ","
        raise InputError(
            f"{file}: {names[0]} changes by {step[0]:.2g} from row to row and by {whole[0]:.2g} over the "
            f"record (RMS){others} as noise does; expected a motion: does the arm rest, or are the rows not "
            "in the order of time?"
        )
    return [
        f"{name} shows no motion, only noise of {whole[k]:.2g} about {columns[:, k].mean():.4g}: what "
        "depends on it is not determined; lock the joint in the description, or move it"
        for k, name in enumerate(names)
        if found[k]
    ]


def check_jumps(file: str, arm: Arm, names: tuple[str, ...], q: Array, t: Array, steady: float) -> None:
    """No sensor that starts anew after a turn. q: (N, n) joint coordinates; steady: median step [rad] below
    which a jump is no motion. Raises InputError.
    """
    for k, i in enumerate(arm.coordinates):
        if arm.joints[i].type == "prismatic":
            continue
        steps = np.diff(q[:, k])
        jumps = np.abs(steps) > math.pi
        # Half a turn within one sample, among samples that hardly move: no motion does that.
        if jumps.any() and np.median(np.abs(steps)) < steady:
            m = int(np.argmax(jumps))
            raise InputError(
                f"{file}: {names[k]} jumps by {steps[m]:.4g} rad after t = {t[m]:.9g} s; where the sensor "
                "starts anew after a turn, declare `wrap: 2*pi` (in its unit) in a mapping file (--mapping)"
            )


def check_range(
    file: str,
    arm: Arm,
    drives: Sequence[NumericDrive],
    names: tuple[str, ...],
    columns: Array,
    q: Array,
    margin: float,
) -> list[str]:
    """Positions within the joint's range and the drive's stroke, up to `margin` times that.

    columns: (N, n) as logged; q: (N, n) joint coordinates, NaN where a lever cannot reach. Returns remarks
    where a range is left by less. Raises InputError, with the unit that would fit.
    """
    remarks = []
    for k, i in enumerate(arm.coordinates):
        joint, name = arm.joints[i], names[k]
        drive = of_joint(arm, joint)
        motor_side = name.startswith("qm")
        given = drive.motor_range() if motor_side else (joint.limits.position or drive.joint_range())
        if given is None and motor_side and joint.limits.position is not None:
            ends = drives[k].motor(np.array(joint.limits.position))
            given = float(ends.min()), float(ends.max())
        if given is None:
            continue
        low, high = given
        found = float(columns[:, k].min()), float(columns[:, k].max())
        excess, slack = max(low - found[0], found[1] - high), margin * (high - low)
        unit = drive.unit if motor_side else joint.unit
        printed = "motor units" if unit == "unit" else unit
        shown = f"{name} runs from {found[0]:.6g} to {found[1]:.6g} {printed}"
        limits = f"joint {joint.name} from {low:.6g} to {high:.6g} {printed}"
        if excess > slack or not np.isfinite(q[:, k]).all():
            also = joint.drive.decides_motor if motor_side else ""
            ratio = None if motor_side else drives[k].ratio
            hint = _unit_hint(found, (low - slack, high + slack), unit, also, ratio)
            raise InputError(f"{file}: {shown}, {limits}{hint}")
        if excess > 0.0:
            remarks.append(f"{shown}, {limits}")
    return remarks


_MOVED = 0.05  # of its range, that a joint moves in a unit of which a log is suspected


def _unit_hint(
    found: tuple[float, float],
    allowed: tuple[float, float],
    unit: str,
    also: str,
    ratio: float | None,
) -> str:
    """The unit in which the values would be allowed and the joint would move by a part of its range that is
    worth a log, else what may be wrong, `also` besides the limits.

    ratio: of the gear before the joint whose side these should not be, None where there is none.
    """
    options = {
        "rad": [("degrees", "`unit: deg`", math.pi / 180), ("turns", "`unit: rev`", 2 * math.pi)],
        "m": [("millimetres", "`unit: mm`", 1e-3), ("centimetres", "`unit: cm`", 1e-2)],
    }.get(unit, [])
    if ratio is not None and abs(ratio) > 1.0:
        options.append(("the motor's positions", "`side: motor`", 1.0 / ratio))
    fitting = []
    for words, key, factor in options:
        low, high = sorted((found[0] * factor, found[1] * factor))
        if low >= allowed[0] and high <= allowed[1] and high - low >= _MOVED * (allowed[1] - allowed[0]):
            fitting.append((words, key))
    if fitting:
        words, keys = (" or ".join(x) for x in zip(*fitting, strict=True))
        return f": these look like {words}; declare {keys} in a mapping file (--mapping)"
    described = f"the limits or {also}" if also else "the limits"
    return f": correct unit, sign or offset in a mapping file (--mapping), or {described} in the description"
