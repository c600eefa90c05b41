"""Thresholds as entries: each has a name, a value, a unit, a meaning and a source, and a user can change it.

A group of thresholds is a frozen dataclass whose fields are made by `entry`, or are groups themselves. The
page of thresholds, and the names that `with_values` takes, follow from the fields.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from difflib import get_close_matches
from typing import Any, Self, TypeVar

from modelgen.errors import InputError

Value = float | tuple[float, ...]
_Number = TypeVar("_Number")


def entry(value: _Number, unit: str, meaning: str, source: str) -> _Number:
    """A field of a group: its usual value, its unit, one sentence that says what it decides, and its source.

    unit: "1" for a ratio or a share. source: a paper, or how the value was measured, calibrated or chosen.
    """
    found: _Number = field(default=value, metadata={"unit": unit, "meaning": meaning, "source": source})
    return found


@dataclass(frozen=True)
class Entry:
    """One threshold. name: dotted, as `with_values` takes it."""

    name: str
    value: Value
    unit: str
    meaning: str
    source: str


@dataclass(frozen=True)
class Group:
    """Base of all groups of thresholds."""

    def __post_init__(self) -> None:
        """Raises InputError where a value is no finite number, or of another kind than the usual one."""
        for f in fields(self):
            if "unit" in f.metadata:
                _check(f"{type(self).__name__}.{f.name}", getattr(self, f.name), f.default)

    def entries(self) -> Iterator[Entry]:
        """All thresholds of the group and of the groups in it, in the order of definition."""
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, Group):
                for inner in value.entries():
                    yield replace(inner, name=f"{f.name}.{inner.name}")
            else:
                yield Entry(f.name, value, f.metadata["unit"], f.metadata["meaning"], f.metadata["source"])

    def with_values(self, values: Mapping[str, Value]) -> Self:
        """The group with other values, by dotted name: `{"selection.min_delta_bic": 10.0}`.

        Raises InputError for a name that no threshold has, and for a value that is no finite number.
        """
        changed: dict[str, Any] = {}
        inside: dict[str, dict[str, Value]] = {}
        known = [e.name for e in self.entries()]
        for name, value in values.items():
            if name not in known:
                near = get_close_matches(name, known, n=1)
                hint = f", did you mean '{near[0]}'?" if near else ""
                raise InputError(f"found no threshold '{name}'{hint}")
            first, _, rest = name.partition(".")
            if rest:
                inside.setdefault(first, {})[rest] = value
            else:
                changed[first] = value
        for first, inner in inside.items():
            changed[first] = getattr(self, first).with_values(inner)
        return replace(self, **changed)


def _check(name: str, value: object, usual: object) -> None:
    several = isinstance(usual, tuple)
    numbers = value if isinstance(value, tuple) else (value,)
    good = isinstance(value, tuple) == several and len(numbers) > 0
    for x in numbers:
        good = good and isinstance(x, int | float) and not isinstance(x, bool) and math.isfinite(x)
    if several and isinstance(usual, tuple) and len(usual) == 2:
        good = good and len(numbers) == 2
    if not good:
        kind = "a tuple of finite numbers" if several else "a finite number"
        raise InputError(f"threshold {name}: found {value!r}, expected {kind}")
