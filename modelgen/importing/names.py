"""Names of the source made fit for a description."""

from __future__ import annotations

import re
from collections.abc import Iterable

from modelgen.description.names import arm_name_problem
from modelgen.errors import InputError

_TAKEN = "base"  # the arm's own base


def joint_names(names: Iterable[str], used_before: Iterable[str] = ()) -> list[str]:
    """A name for each that a joint or a tool may have, all of them and those `used_before` different."""
    used = {_TAKEN, *used_before}
    found = []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_-]+", "_", name) or "joint"
        if not re.match(r"[A-Za-z_]", plain):
            plain = f"j{plain}"
        unique, k = plain, 2
        while unique in used:
            unique, k = f"{plain}_{k}", k + 1
        used.add(unique)
        found.append(unique)
    return found


def arm_name(wished: str | None, given: str) -> str:
    """The arm's name: as wished, else the source's. Raises InputError for a wish that is no name."""
    if wished is not None:
        problem = arm_name_problem(wished)
        if problem:
            raise InputError(f"--name '{wished[:60]}': {problem}")
        return wished
    plain = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9_]+", "_", given)).strip("_")[:48]
    if not re.match(r"[A-Za-z]", plain):
        plain = f"arm_{plain}".rstrip("_")[:48]
    return f"{plain}_arm" if arm_name_problem(plain) else plain
