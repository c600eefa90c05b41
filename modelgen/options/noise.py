"""How far the inputs of an identified arm are from those of its model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Noise:
    """By coordinate; `largest` and `input` in the unit of the inputs, of records that were not fitted.

    input: root mean square of the inputs' errors. largest: their largest magnitude, joints at rest included.
    correlation: time over which the errors stay alike [s]. rest_speed: below which a joint counts as resting
    [rad/s, m/s]. cutoff: of the filters of the records [Hz]. duration: of the records [s]. parameters:
    standard deviations of the base parameters by name.
    """

    input: tuple[float, ...]
    largest: tuple[float, ...]
    correlation: tuple[float, ...]
    rest_speed: tuple[float, ...]
    cutoff: float
    duration: float
    parameters: Mapping[str, float] = field(default_factory=dict)
