"""Arms from their description."""

from __future__ import annotations

from pathlib import Path

from modelgen.description import Arm, load
from modelgen.effects import known_effects
from modelgen.errors import InputError, suggest
from modelgen.resources import shipped_arms


def load_arms(path: Path | str | None = None) -> dict[str, Arm]:
    """Read the description of arms.

    Parameters
    ----------
    path : Path or str, optional
        A description in YAML (docs/describing.md). Default: arms.yaml in the current folder if there is one,
        else the arms that modelgen ships.

    Returns
    -------
    dict of str to Arm
        The arms by name, in the order of the file.

    Raises
    ------
    InputError
        At the first mistake, with its line and column.
    """
    return load(description_file(path), known_effects())


def description_file(path: Path | str | None) -> Path:
    """The file that is read: the given one, arms.yaml here, or the one that modelgen ships."""
    if path is not None:
        return Path(path)
    here = Path("arms.yaml")
    return here if here.exists() else shipped_arms()


def joint_number(arm: Arm, given: int | str, option: str) -> int:
    """Number of a coordinate, from 1, by its name or its number. option: that it was given with.

    Raises InputError for a name that no moving joint has, and a number beyond them.
    """
    names = arm.coordinate_names
    if isinstance(given, str) and given in names:
        return names.index(given) + 1
    if str(given).isdecimal() and 1 <= int(given) <= len(names):
        return int(given)
    near = suggest(str(given), names, listed=True)
    raise InputError(
        f"{option}: found joint '{given}', expected a joint of {arm.name} by its name or number, 1 to "
        f"{len(names)}{near}"
    )


def an_arm(given: object) -> Arm:
    """The arm that a function was given.

    Raises InputError for what is none: a path, or all arms of a file.
    """
    if isinstance(given, Arm):
        return given
    if isinstance(given, dict) and all(isinstance(each, Arm) for each in given.values()):
        found, way = f"{len(given)} arms, {', '.join(map(str, given))}", "arms[NAME]"
    elif isinstance(given, str | Path):
        found, way = f"the text '{given}'", f"load_arms('{given}')[NAME]"
    else:
        found, way = f"{type(given).__name__}", "load_arms(FILE)[NAME]"
    raise InputError(f"arm: found {found}; expected an arm, as {way} gives")
