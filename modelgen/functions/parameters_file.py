"""Values of base parameters as they are given: a file of modelgen identify, names with numbers, estimates."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from math import isfinite, sqrt
from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions.arguments import LARGEST_GAIN
from modelgen.functions.objects import Model
from modelgen.numeric import Array
from modelgen.options import ModelOptions
from modelgen.options.noise import Noise


def values_of(given: Path | str | Mapping[str, Any] | None, arms: Sequence[str]) -> dict[str, float]:
    """Values by name. given: <arm>_parameters.yaml, or names with numbers or estimates (their `value`).

    arms: names of the arms that they are for; a file names its own. Raises InputError where it cannot be
    read or does not fit.
    """
    if given is None:
        return {}
    if isinstance(given, str | Path):
        return read_values(f"--parameters {given}", Path(given), arms)
    return {name: float(getattr(value, "value", value)) for name, value in given.items()}


def values_beside(arms: Sequence[Arm], options: ModelOptions) -> dict[str, dict[str, float]]:
    """Values by arm, from the <arm>_parameters.yaml files that lie beside the description.

    They belong to the arm as described: with parts left out, or gains of each row's own, none is used.
    Raises InputError for a file that does not fit.
    """
    if options.without or options.gains == "row_wise":
        return {}
    files = {
        arm.name: Path(arm.where.file).parent / f"{arm.name}_parameters.yaml"
        for arm in arms
        if arm.where is not None
    }
    return {name: read_values(str(file), file, [name]) for name, file in files.items() if file.is_file()}


def read_values(who: str, file: Path, arms: Sequence[str]) -> dict[str, float]:
    """Values by name of <arm>_parameters.yaml. who: how messages name the file. Raises InputError."""
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


def read_identification(
    given: Path | str | Mapping[str, Any], arms: Sequence[Arm]
) -> tuple[dict[str, float], Noise]:
    """Values of the base parameters by name, and the noise: of identification.json, or of what it holds.

    Raises InputError where it cannot be read, is another arm's, or holds no noise that the arm may have.
    """
    who, data = "--identification", given
    if isinstance(given, str | Path):
        who = f"--identification {given}"
        try:
            data = json.loads(Path(given).read_text(encoding="utf-8"))
        except OSError as error:
            raise InputError(f"{who}: {(error.strerror or str(error)).lower()}") from error
        except ValueError as error:
            raise InputError(f"{who}: cannot be read as JSON; expected identification.json") from error
    if not isinstance(data, Mapping) or not isinstance(data.get("parameters"), list):
        raise InputError(f"{who}: expected what modelgen identify writes as identification.json")
    names = [arm.name for arm in arms]
    if names != [data.get("arm")]:
        raise InputError(
            f"{who}: belongs to the arm '{data.get('arm')}', found {', '.join(names)}; "
            f"give --arm {data.get('arm')}"
        )
    if not isinstance(data.get("noise"), Mapping):
        raise InputError(f"{who}: holds no noise; identify again, with a test record")
    try:
        noise, observer = data["noise"], data["noise"]["observer"]
        lists = (
            noise["input"],
            noise["correlation_s"],
            noise["rest_speed"],
            observer["rms"],
            observer["largest"],
        )
        values = {p["name"]: float(p["value"]) for p in data["parameters"]}
        spreads = {p["name"]: float(p["std"]) for p in data["parameters"] if p["std"] is not None}
        rows = [tuple(float(x) for x in row) for row in lists]
        gain, duration = float(observer["gain"]), float(observer["duration_s"])
        found = Noise(rows[0], rows[1], rows[2], rows[3], rows[4], gain, duration, spreads)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{who}: expected what modelgen identify writes, found {error} amiss") from error
    above = (*found.input, *found.correlation, gain, duration)
    if not all(x > 0 for x in above) or not all(isfinite(x) for row in (above, *rows) for x in row):
        raise InputError(f"{who}: expected errors, times, a gain and a duration above zero under `noise`")
    n = len(arms[0].coordinates)
    for row in rows:
        if len(row) != n:
            raise InputError(
                f"{who}: found a list of {len(row)} under `noise`, expected {n}: one for each joint"
            )
    if gain * sqrt(n) > LARGEST_GAIN:
        most = LARGEST_GAIN / sqrt(n)
        raise InputError(f"{who}: found a gain of {gain:g} 1/s, expected at most {most:.0f} 1/s")
    return values, found


def base_vector(model: Model, values: Mapping[str, float]) -> Array:
    """Base parameters (p,) in the model's order. Raises InputError where these are not the arm's."""
    names = [b.name for b in model.grouping.base]
    missing = [name for name in names if name not in values]
    extra = [name for name in values if name not in names]
    if missing or extra:
        what = f"{missing[0]} is missing" if missing else f"{extra[0]} is none of the arm's"
        raise InputError(f"--parameters: {what}; expected the arm's {len(names)} base parameters")
    return np.array([values[name] for name in names])


def parameters_yaml(arm: str, values: Mapping[str, float]) -> str:
    """The text of <arm>_parameters.yaml."""
    lines = "".join(f"  {name}: {value:.12g}\n" for name, value in values.items())
    return f"schema: 1\narm: {arm}\nparameters:\n{lines}"
