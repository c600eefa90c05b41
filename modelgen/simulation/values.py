"""Values of the command line: one for all joints, one by joint, joints and where they are locked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.description.expressions import ExpressionError, evaluate
from modelgen.errors import InputError
from modelgen.numeric import Array


def by_joint(option: str, text: str, names: Sequence[str]) -> Array:
    """(n,) values from "20 deg" (all joints alike) or "20 deg, 0.1, ..." (one for each), in rad, m."""
    parts = [part.strip() for part in text.split(",")] if text.strip() else ["0"]
    if len(parts) not in (1, len(names)):
        raise InputError(
            f"{option}: found {len(parts)} values, expected 1 or {len(names)}: {', '.join(names)}"
        )
    values = [_value(option, part) for part in parts]
    return np.array(values * len(names) if len(values) == 1 else values)


def locks(given: Sequence[str]) -> dict[str, float]:
    """{joint: coordinate} from "j2=0", "j3=20 deg"."""
    found: dict[str, float] = {}
    for text in given:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise InputError(f"--lock {text}: expected JOINT=COORDINATE, j2=0 say")
        found[name.strip()] = _value("--lock", value.strip())
    return found


def numbers(option: str, text: str) -> list[float]:
    """Numbers between commas."""
    return [_value(option, part.strip()) for part in text.split(",")] if text.strip() else []


def _value(option: str, text: str) -> float:
    try:
        value = evaluate(text, "any").value
    except ExpressionError as error:
        raise InputError(f"{option}: '{text}': {error}; expected 0.35, 'pi/9' or '20 deg'") from error
    if not np.isfinite(value):
        raise InputError(f"{option}: found '{text}', expected a finite number")
    return value
