"""How far an identified arm is from its model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

# Bandwidth of the observer over that of the records: of what lies beyond, which is unknown, little passes.
BANDWIDTH = 1 / 3
SETTLED = 5.0  # over the gain: time until what the observer began with is forgotten [s]


@dataclass(frozen=True)
class Noise:
    """By coordinate, of records that were not fitted.

    input: root mean square of the inputs' errors [unit of the inputs]. correlation: time over which they stay
    alike [s]. rest_speed: below which a joint counts as resting [rad/s, m/s]. rms, largest: of what the
    momentum observer gives with the gain [1/s], where nothing acts from outside [N m, N]; over a duration
    [s]. parameters: standard deviations of the base parameters by name.
    """

    input: tuple[float, ...]
    correlation: tuple[float, ...]
    rest_speed: tuple[float, ...]
    rms: tuple[float, ...]
    largest: tuple[float, ...]
    gain: float
    duration: float
    parameters: Mapping[str, float] = field(default_factory=dict)
