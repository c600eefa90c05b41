"""Values by joint, as text or as numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.description.expressions import ExpressionError, evaluate
from modelgen.errors import InputError
from modelgen.numeric import Array

ANGLES, MASSES = "0.35, 'pi/9' or '20 deg'", "2.5 or 2.5,0,0,0.1 (kg, m)"


def by_joint(option: str, given: str | float | Sequence[float], names: Sequence[str]) -> Array:
    """(n,) values [rad, m] from "20 deg" (for all joints), "20 deg, 0.1, ..." (for each), or numbers."""
    if isinstance(given, str):
        parts = [part.strip() for part in given.split(",")] if given.strip() else ["0"]
        values = [_value(option, part) if len(parts) in (1, len(names)) else 0.0 for part in parts]
    else:
        values = np.atleast_1d(np.asarray(given, dtype=float)).tolist()
    if len(values) not in (1, len(names)):
        raise InputError(
            f"{option}: found {len(values)} values, expected 1 or {len(names)}: {', '.join(names)}"
        )
    return np.array(values * len(names) if len(values) == 1 else values)


def locks(given: Sequence[str] | Mapping[str, float]) -> dict[str, float]:
    """{joint: coordinate} from "j2=0", "j3=20 deg", or as it stands."""
    if isinstance(given, Mapping):
        return {name: float(value) for name, value in given.items()}
    found: dict[str, float] = {}
    for text in given:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise InputError(f"--lock {text}: expected JOINT=COORDINATE, j2=0 say")
        found[name.strip()] = _value("--lock", value.strip())
    return found


def numbers(option: str, given: str | float | Sequence[float]) -> list[float]:
    """Numbers of a payload between commas, or as they stand."""
    if not isinstance(given, str):
        return [float(x) for x in np.atleast_1d(np.asarray(given, dtype=float))]
    return [_value(option, part.strip(), MASSES) for part in given.split(",")] if given.strip() else []


def _value(option: str, text: str, like: str = ANGLES) -> float:
    try:
        value = evaluate(text, "any").value
    except ExpressionError as error:
        raise InputError(f"{option}: '{text}': {error}; expected {like}") from error
    if not np.isfinite(value):
        raise InputError(f"{option}: found '{text}', expected a finite number")
    return value
