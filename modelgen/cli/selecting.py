"""Which arms, with which options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches
from math import isfinite
from pathlib import Path

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from modelgen.description import Arm, load
from modelgen.description.messages import suggest
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.functions import PARTS, Options
from modelgen.resources import shipped_arms


def selected(path: Path | None, names: Sequence[str]) -> tuple[str, list[Arm]]:
    """The file as messages name it, and its arms of the given names, all where none are given.

    Without a path arms.yaml of the current folder is read, else the arms that modelgen ships. Raises
    InputError where the description is wrong or an arm does not exist.
    """
    if path is None:
        here = Path("arms.yaml")
        path = here if here.exists() else shipped_arms()
    arms = load(path, known_effects())
    for name in names:
        if name not in arms:
            near = get_close_matches(name, arms, n=1)
            hint = f", did you mean '{near[0]}'?" if near else ""
            raise InputError(f"{path}: found no arm '{name}'{hint} (available: {', '.join(arms)})")
    chosen = [arms[name] for name in dict.fromkeys(names)] if names else list(arms.values())
    return str(path), chosen


def one(path: Path | None, name: str) -> tuple[str, Arm]:
    """The file as messages name it, and its arm of that name, its only one where no name is given.

    Raises InputError as `selected` does, and where no name is given and the file has several arms.
    """
    file, arms = selected(path, [name] if name else [])
    if len(arms) > 1:
        names = ", ".join(arm.name for arm in arms)
        raise InputError(f"{file}: found {len(arms)} arms and no --arm, expected --arm with one of {names}")
    return file, arms[0]


def options(
    without: str, gains: str, runtime_geometry: bool, sincos: bool, jacobian_link: str | None
) -> Options:
    """The options of the functions. Raises InputError for a part that cannot be left out."""
    parts = [part.strip() for part in without.split(",") if part.strip()]
    for part in parts:
        if part not in PARTS:
            raise InputError(
                f"--without: found '{part}', expected {' or '.join(PARTS)}{suggest(part, PARTS)}"
            )
    return Options(
        without=frozenset(parts),
        gains=str(gains),
        runtime_geometry=runtime_geometry,
        sincos=sincos,
        jacobian_link=jacobian_link,
    )


def with_parameters(chosen: Options, file: Path | None, arms: Sequence[Arm]) -> Options:
    """The options with the values of <arm>_parameters.yaml. Raises InputError where it does not fit."""
    if file is None:
        return chosen
    return replace(chosen, identified=_parameters(f"--parameters {file}", file, [arm.name for arm in arms]))


def beside(description: Path, arms: Sequence[Arm], chosen: Options) -> dict[str, dict[str, float]]:
    """By arm, the values of the <arm>_parameters.yaml that lie beside the description.

    They belong to the arm as described: with parts left out, or gains of each row's own, none is taken.
    Raises InputError for a file that does not fit.
    """
    if chosen.without or chosen.gains == "row_wise":
        return {}
    files = {arm.name: description.parent / f"{arm.name}_parameters.yaml" for arm in arms}
    return {name: _parameters(str(file), file, [name]) for name, file in files.items() if file.is_file()}


def _parameters(who: str, file: Path, arms: Sequence[str]) -> dict[str, float]:
    """The values by name. who: how messages name the file."""
    try:
        data = YAML(typ="safe", pure=True).load(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{who}: {(error.strerror or str(error)).lower()}") from error
    except (UnicodeDecodeError, YAMLError) as error:
        raise InputError(f"{who}: cannot be read as YAML ({type(error).__name__})") from error
    values = data.get("parameters") if isinstance(data, dict) else None
    if not isinstance(values, dict) or not all(
        isinstance(k, str) and type(v) in (int, float) for k, v in values.items()
    ):
        raise InputError(f"{who}: expected 'parameters:' with a number by each name")
    infinite = [k for k, v in values.items() if not isfinite(v)]
    if infinite:
        raise InputError(f"{who}: {infinite[0]} is {values[infinite[0]]}, expected a finite number")
    if list(arms) != [data.get("arm")]:
        raise InputError(
            f"{who}: belongs to the arm '{data.get('arm')}', found {', '.join(arms)}; "
            f"give --arm {data.get('arm')}"
        )
    return {k: float(v) for k, v in values.items()}
