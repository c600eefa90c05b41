"""What columns seem to be, by their names and numbers; nothing is more than a guess."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from modelgen.dataset.mapping.units import plausible_times
from modelgen.numeric import Array

_TIME = re.compile(
    r"(^|[^a-z])(t|time|stamp|timestamp|clock)([^a-z]|$)|header\.stamp|time_?stamp", re.IGNORECASE
)
_KINDS = (
    ("velocity", re.compile(r"vel|speed|(^|[^a-z])(dq|qd|rpm)", re.IGNORECASE)),
    ("acceleration", re.compile(r"acc|ddq|qdd", re.IGNORECASE)),
    ("temperature", re.compile(r"temp", re.IGNORECASE)),
    ("current", re.compile(r"cur|amp|(^|[^a-z])i(_|\d|$|\[)", re.IGNORECASE)),
    ("torque", re.compile(r"tau|torq|effort|force|load|moment", re.IGNORECASE)),
    ("position", re.compile(r"pos|angle|(^|[^a-z])(q|qm)(_|\d|$|\[)|enc|deg|rad", re.IGNORECASE)),
)
_BRACKETS = re.compile(r"[\[(<]\s*([^\[\]()<>]+?)\s*[\])>]\s*$")
_ENDING = re.compile(r"_(deg|rad|mrad|rev|mm|cm|mA|A|ms|us|ns|Nm|Nmm|kNm|N|kN|rpm)$")
# What units are called, in small letters without blanks and points, by kind of the column.
_CALLED: Mapping[str, Mapping[str, str]] = {
    "position": {
        **dict.fromkeys(("deg", "degree", "degrees", "°"), "deg"),
        **dict.fromkeys(("rad", "radian", "radians"), "rad"),
        **dict.fromkeys(("rev", "turn", "turns", "revolutions"), "rev"),
        **{word: word for word in ("mrad", "m", "cm", "mm", "um")},
    },
    "velocity": {word: word for word in ("rad/s", "deg/s", "rev/s", "m/s", "mm/s", "rpm")},
    "acceleration": {word: word for word in ("rad/s^2", "deg/s^2", "m/s^2", "mm/s^2")},
    "temperature": dict.fromkeys(("degc", "°c", "c"), "degC"),
    "current": {"a": "A", "amp": "A", "ampere": "A", "ma": "mA"},
    "torque": {"nm": "N m", "nmm": "N mm", "knm": "kN m", "n": "N", "kn": "kN"},
    "time": {"s": "s", "sec": "s", "ms": "ms", "us": "us", "µs": "us", "ns": "ns"},
}
TURNS = 4 * np.pi  # rad, beyond which an angle is taken as degrees
AMPERES = 200.0  # beyond which a current is taken as milliamperes


def kind_of(name: str) -> str | None:
    """Kind of a column by its name: "position", "velocity", "current"; None where it says nothing."""
    if _TIME.search(name):
        return None
    return next((k for k, pattern in _KINDS if pattern.search(name)), None)


def time_of(columns: Mapping[str, Array]) -> str | None:
    """The column of the stamps: its name says so, and it does not fall; those of messages first."""
    rising = [
        name for name, x in columns.items() if len(x) > 1 and np.ptp(x) > 0 and np.all(np.diff(x) >= 0.0)
    ]
    named = [name for name in rising if _TIME.search(name)]
    return next((name for name in named if "header.stamp" in name), next(iter(named), None))


def unit_in(name: str, kind: str, said: str = "") -> str:
    """The unit that a column's name says, for its kind, or the file beside it; empty where neither does."""
    found = _BRACKETS.search(name) or _ENDING.search(name)
    word = said or (found[1] if found else "")
    plain = word.lower().replace("²", "^2").translate({ord(c): None for c in " ·.*[]()<>"})
    return _CALLED[kind].get(plain, "")


def unit_of_time(stamps: Array, name: str = "", said: str = "") -> str:
    """The unit that its name or the file says, else one that makes the step that of a robot's logs."""
    named = unit_in(name, "time", said)
    if named:
        return named
    return next(iter(plausible_times(float(np.median(np.diff(stamps))))), "s")


def unit_of_angle(values: Array) -> str:
    """Degrees where the angle would be more than two turns in radians."""
    return "rad" if float(np.nanmax(np.abs(values))) < TURNS else "deg"


def guessed_unit(name: str, values: Array) -> str:
    """Unit of a column by its name and the size of its numbers; empty where neither tells."""
    kind, finite = kind_of(name), values[np.isfinite(values)]
    if kind is None or not len(finite):
        return ""
    named = unit_in(name, kind)
    if named:
        return named
    if kind == "position" and _whole_steps(finite) and np.ptp(finite) > TURNS:
        return "counts"
    largest = float(np.abs(finite).max())
    angle = unit_of_angle(finite)
    units = {
        "position": angle,
        "velocity": "rad/s" if largest < 10 * TURNS else "deg/s",
        "acceleration": "rad/s^2" if largest < 100 * TURNS else "deg/s^2",
        "temperature": "degC",
        "current": "A" if largest < AMPERES else "mA",
        "torque": "N m",
    }
    return units[kind]


@np.errstate(over="ignore")  # a wrong digit makes any number
def _whole_steps(values: Array) -> bool:
    """Whether all differ by whole numbers: counts of an encoder, with an offset of any size."""
    steps = values - values[0]
    return bool(np.allclose(steps, np.rint(steps), rtol=0.0, atol=1e-6))
