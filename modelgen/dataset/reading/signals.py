"""Which column of a log is which signal of the arm, by the names of the contract: q1, qm2, i1, tau2."""

from __future__ import annotations

import difflib
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.dataset.drives import NumericDrive
from modelgen.dataset.objects import Wanted
from modelgen.description import Arm
from modelgen.errors import InputError

KINDS = ("q", "qm", "dq", "ddq", "i", "tau", "temperature")
MAPPED_EFFORTS = ("taum", "u")  # force at the motor coordinate; duty cycle or voltage
_SIGNAL = re.compile(rf"({'|'.join(sorted(KINDS, key=len, reverse=True))})([1-9][0-9]*)")


def is_signal(name: str) -> bool:
    """Whether a column has a name of docs/logs.md: t, q1, tau2."""
    return name == "t" or _SIGNAL.fullmatch(name) is not None


def by_names(names: tuple[str, ...]) -> Wanted:
    """Columns whose names say what they are, where they are those of docs/logs.md."""
    kinds = {name: found[1] for name in names if (found := _SIGNAL.fullmatch(name))}
    positions = frozenset(name for name, kind in kinds.items() if kind in ("q", "qm"))
    return Wanted(names, positions, frozenset(name for name, kind in kinds.items() if kind in ("i", "tau")))


@dataclass(frozen=True)
class Signals:
    """Names of the columns by joint: position always, the others where the log has them."""

    position: tuple[str, ...]
    effort: tuple[str | None, ...]  # all None: a free motion
    dq: tuple[str, ...] | None
    ddq: tuple[str, ...] | None
    temperature: tuple[str | None, ...] | None

    @property
    def wanted(self) -> tuple[str, ...]:
        """All columns to be read, the time first."""
        rows = (self.position, self.effort, self.dq or (), self.ddq or (), self.temperature or ())
        return ("t", *(name for row in rows for name in row if name is not None))


def find_signals(
    file: str, names: Sequence[str], arm: Arm, drives: Sequence[NumericDrive], *, mapped: bool = False
) -> Signals:
    """The signals of an arm with n coordinates among the columns of a log. Raises InputError.

    mapped: whether the names come from a mapping file, which has more kinds of effort.
    """
    n = len(drives)
    doubled = [
        name
        for name, count in Counter(names).items()
        if count > 1 and (name == "t" or _SIGNAL.fullmatch(name))
    ]
    if doubled:
        raise InputError(
            f"{file}: the column {doubled[0]} stands there {Counter(names)[doubled[0]]} times, expected once"
        )
    if "t" not in names:
        raise InputError(f"{file}: the column t [s] is missing{_near('t', names)}")
    beyond = [m[0] for name in names if (m := _SIGNAL.fullmatch(name)) and int(m[2]) > n]
    if beyond:
        joints = ", ".join(arm.coordinate_names)
        raise InputError(
            f"{file}: found the column {beyond[0]}, but {arm.name} has {n} coordinates ({joints}); "
            "locked and fixed joints are not counted"
        )
    position = tuple(_one(file, names, f"q{k}", f"qm{k}", arm) for k in range(1, n + 1))
    missing = [k for k, name in enumerate(position, 1) if name is None]
    if missing:
        expected = f"q{missing[0]}"
        raise InputError(
            f"{file}: the column {expected} or qm{missing[0]} is missing{_near(expected, names)}"
            f" (found {', '.join(names)})"
        )
    effort = tuple(_effort(file, names, k, drive, arm, mapped) for k, drive in enumerate(drives, 1))
    if any(effort):
        for k, (name, drive) in enumerate(zip(effort, drives, strict=True), 1):
            if name is None and drive.driven:
                raise InputError(f"{file}: the column i{k} or tau{k} is missing{_near(f'i{k}', names)}")
    return Signals(
        tuple(name for name in position if name is not None),
        effort,
        _all(file, names, "dq", n),
        _all(file, names, "ddq", n),
        _some(names, "temperature", n),
    )


def _one(file: str, names: Sequence[str], first: str, second: str, arm: Arm) -> str | None:
    found = [name for name in (first, second) if name in names]
    if len(found) == 2:
        raise InputError(
            f"{file}: found both {first} and {second} for one joint of {arm.name}, expected one of them; "
            "a mapping file (--mapping) says which columns are read"
        )
    return found[0] if found else None


def _effort(
    file: str, names: Sequence[str], k: int, drive: NumericDrive, arm: Arm, mapped: bool
) -> str | None:
    for kind in MAPPED_EFFORTS if mapped else ():
        if f"{kind}{k}" in names:
            return f"{kind}{k}"
    name = _one(file, names, f"i{k}", f"tau{k}", arm)
    if name == f"i{k}" and not drive.driven:
        joint = arm.joints[arm.coordinates[k - 1]]
        unit = "N" if joint.type == "prismatic" else "N m"
        raise InputError(
            f"{file}: found the current i{k}, but joint {joint.name} has no drive: its input is tau{k} "
            f"[{unit}]; describe the drive, or rename the column in a mapping file (--mapping)"
        )
    return name


def _all(file: str, names: Sequence[str], kind: str, n: int) -> tuple[str, ...] | None:
    wanted = [f"{kind}{k}" for k in range(1, n + 1)]
    found = [name for name in wanted if name in names]
    if found and len(found) < n:
        absent = next(name for name in wanted if name not in names)
        raise InputError(
            f"{file}: found {found[0]}, but the column {absent} is missing{_near(absent, names)}"
        )
    return tuple(wanted) if found else None


def _some(names: Sequence[str], kind: str, n: int) -> tuple[str | None, ...] | None:
    found = [name if (name := f"{kind}{k}") in names else None for k in range(1, n + 1)]
    return tuple(found) if any(found) else None


def _near(name: str, names: Sequence[str]) -> str:
    near = difflib.get_close_matches(name.lower(), [n.lower() for n in names], n=1, cutoff=0.5)
    if name == "t":
        near = [n.lower() for n in names if re.search(r"time|stamp|^t\b", n.lower())]
    original = next((n for n in names if near and n.lower() == near[0] and not _SIGNAL.fullmatch(n)), None)
    return (
        f", did you mean the column '{original}'? a mapping file (--mapping) renames it" if original else ""
    )
