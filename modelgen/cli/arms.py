"""Which arms of a description a command is for."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

from modelgen.api.description import description_file, load_arms
from modelgen.description import Arm
from modelgen.errors import InputError


def selected(path: Path | None, names: Sequence[str]) -> tuple[str, list[Arm]]:
    """The file as messages name it, and its arms of the given names, all where none are given.

    Without a path arms.yaml of the current folder is read, else the arms that modelgen ships. Raises
    InputError where the description is wrong or an arm does not exist.
    """
    file = description_file(path)
    arms = load_arms(file)
    for name in names:
        if name not in arms:
            near = get_close_matches(name, arms, n=1)
            hint = f", did you mean '{near[0]}'?" if near else ""
            raise InputError(f"{file}: found no arm '{name}'{hint} (available: {', '.join(arms)})")
    chosen = [arms[name] for name in dict.fromkeys(names)] if names else list(arms.values())
    return str(file), chosen


def one(path: Path | None, name: str) -> Arm:
    """The arm of that name in the file, its only one where no name is given.

    Raises InputError as `selected` does, and where no name is given and the file has several arms.
    """
    file, arms = selected(path, [name] if name else [])
    if len(arms) > 1:
        names = ", ".join(arm.name for arm in arms)
        raise InputError(f"{file}: found {len(arms)} arms and no --arm, expected --arm with one of {names}")
    return arms[0]
