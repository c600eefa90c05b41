"""One column of a mapped log, and that no column of the file is read as two of them by mistake."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from modelgen.dataset.mapping.files import Foreign
from modelgen.dataset.mapping.formula import Formula
from modelgen.numeric import Array

# Keys of a mapping by what its columns are called; all others are efforts.
_KEYS = {"q": "position", "qm": "position", "dq": "velocity", "ddq": "acceleration"}


@dataclass(frozen=True)
class Signal:
    """One column to be made: factor * formula + offset. bits: of a counter that was logged as unsigned."""

    formula: Formula
    factor: float
    offset: float
    wrap: float | None = None
    bits: int | None = None

    def __call__(self, columns: dict[str, Array], last: dict[Signal, float]) -> Array:
        """Its values (N,); `last` keeps its last value from block to block where it wraps."""
        raw = self.formula(columns)
        if self.bits is not None:
            raw = np.where(raw >= 2.0 ** (self.bits - 1), raw - 2.0**self.bits, raw)
        values = self.factor * raw + self.offset
        if self.wrap is None:
            return values
        before = last.get(self, float(values[0]))
        values = np.unwrap(np.concatenate([[before], values]), period=self.wrap)[1:]
        last[self] = float(values[-1])
        return values


def check_once(foreign: Foreign, signals: Mapping[str, Signal], aliases: Mapping[str, str]) -> None:
    """Raises InputError for a column that is read as two quantities, or for two joints with one scale.

    A line that was copied does that; a finger that follows another one has a scale of its own. Temperatures
    may be of one sensor.
    """
    seen: dict[str, tuple[str, str, Signal]] = {}
    for name, signal in signals.items():
        short = name.rstrip("0123456789")
        if short == "temperature" or signal.formula.names != (signal.formula.text,):
            continue
        kind, joint = _KEYS.get(short, "effort"), int(name.removeprefix(short)) - 1
        column = aliases.get(signal.formula.text, signal.formula.text)
        first, place, before = seen.setdefault(column, (kind, name, signal))
        same = (before.factor, before.offset) == (signal.factor, signal.offset)
        if place != name and (first != kind or same):
            other = int(place.lstrip("abcdefghijklmnopqrstuvwxyz")) - 1
            raise foreign.error(
                f"found the column '{column}', which joints.{other}.{first} is read from too, expected one "
                "of its own, or a scale of its own for a joint that follows another",
                ["joints", joint, kind, "column"],
            )
