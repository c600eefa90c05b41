"""A check of a cause, as it is reported."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """One check of a cause.

    passed: None where it could not be asked. decides: whether a cause that fails it is none. value,
    threshold: the figures that it compares, not a number where it compares none. text: both in words.
    widened: how many times the deviations of noise alone those of the cause's parameters are.
    """

    name: str
    passed: bool | None
    decides: bool
    value: float
    threshold: float
    text: str
    widened: float = 1.0
