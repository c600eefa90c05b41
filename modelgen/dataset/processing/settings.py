"""Settings of the processing, and the choices that a record's rate and content ask for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.content import chosen_cutoff, noise_alone, quiet_speeds, white_noise
from modelgen.dataset.processing.filters import smoothed
from modelgen.dataset.processing.rounding import position_steps
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array


@dataclass(frozen=True)
class Settings:
    """How a record is processed; None: chosen from the record.

    cutoff: parallel low-pass of effort and regressor [Hz], 0: none. order: of that Butterworth filter,
    which runs forwards and backwards. position_cutoff, position_order: light filter of the positions,
    0 Hz: none. half_width: of the central differences, whose order is twice that. factor: decimation,
    every factor-th sample is kept. trim: cut off at both ends [s]. rest_gate: speeds below which a
    joint is at rest [rad/s, m/s], one or by joint. rest_time: how long it must stay below [s]. turns: whether
    efforts count beside a turn of their joint. thresholds: by which the rest is chosen.
    """

    cutoff: float | None = None
    order: int = 4
    position_cutoff: float | None = None
    position_order: int = 4
    half_width: int = 3
    factor: int | None = None
    trim: float | None = None
    rest_gate: float | tuple[float, ...] | None = None
    rest_time: float | None = None
    turns: bool = True
    thresholds: DatasetThresholds = USUAL


@dataclass(frozen=True)
class Chosen:
    """Settings with every choice made, meanings and units as there.

    noise: speeds [rad/s, m/s] by joint that the rounding of the positions may feign. edge: over which the
    weight of samples falls to what is left out [s]. spacing: samples between rows where the periods of the
    motion ask for no whole number of them: a row is the sample nearest to its place.
    """

    cutoff: float
    order: int
    position_cutoff: float
    position_order: int
    half_width: int
    factor: int
    trim: float
    rest_speeds: tuple[float, ...]
    rest_time: float
    noise: tuple[float, ...]
    edge: float
    turns: bool = True
    thresholds: DatasetThresholds = USUAL
    spacing: float | None = None

    @property
    def stride(self) -> float:
        """Samples from row to row, on average."""
        return self.factor if self.spacing is None else self.spacing

    def trimmed(self, step: float) -> int:
        """Samples cut off at both ends, for a sampling period [s]."""
        # A record's blocks have its period but for rounding: a half must not fall to either side.
        return math.ceil(self.trim / step - 1e-6)


# Leborne, Creuze, Chemori and Brignone (2018), IV-D: positions by a Butterworth filter of order 3,
# cut-off 0.1 of the Nyquist frequency, zero phase; central differences; current as measured.
# `paper_parallel` also filters current and regressor alike, by that filter.
PRESETS = ("default", "paper", "paper_parallel")


def preset(name: str, rate: float) -> Settings:
    """Settings by name, for a record of `rate` [Hz]. Raises InputError for a name that does not exist."""
    if name == "default":
        return Settings()
    if name not in PRESETS:
        raise InputError(f"found the preset '{name}', expected one of {', '.join(PRESETS)}")
    cutoff = 0.1 * rate / 2
    paper = Settings(cutoff=0.0, order=3, position_cutoff=cutoff, position_order=3, half_width=1, factor=1)
    return paper if name == "paper" else replace(paper, cutoff=cutoff)


def choose(records: Record | Sequence[Record], settings: Settings | Chosen | None = None) -> Chosen:
    """The settings with every choice made, the same for all of the records.

    They must have one rate, to `max_rate_difference`. Raises InputError where the settings do not fit them.
    """
    several = [records] if isinstance(records, Record) else list(records)
    first = several[0]
    limits = USUAL if settings is None else settings.thresholds
    for record in several[1:]:
        if abs(record.step / first.step - 1.0) > limits.max_rate_difference:
            raise InputError(
                f"{record.name}: found the rate {1 / record.step:.6g} Hz, {first.name} has "
                f"{1 / first.step:.6g} Hz{_seldom_new([first, record])}; `time: {{resample: ...}}` in a "
                "mapping file gives them one rate"
            )
    rate = 1.0 / first.step
    if isinstance(settings, Chosen):
        _check(first, settings.cutoff, settings.position_cutoff)
        return settings
    settings = settings or Settings()
    cutoff = settings.cutoff
    if cutoff is None:
        cutoff = chosen_cutoff(several, limits)
    position = settings.position_cutoff
    if position is None:
        position = limits.position_cutoff_over_cutoff * cutoff
        if settings.cutoff is None:
            quiet = min(quiet_speeds(record, limits) for record in several)
            position = min(position, max(quiet, limits.least_position_cutoff_over_cutoff * cutoff))
        position = 0.0 if position > limits.max_position_cutoff * rate else position
    _check(first, cutoff, position)
    factor = settings.factor
    if factor is None:
        factor = max(1, int(rate / (limits.row_rate_over_cutoff * cutoff))) if cutoff else 1
    trim = settings.trim
    if trim is None:
        lowest = min((f for f in (cutoff, position) if f), default=np.inf)
        trim = limits.trimmed_cutoff_periods / lowest + settings.half_width * first.step
    light = (position, settings.position_order, settings.half_width)
    moved = [smoothed(r.q, r.step, *light)[1:] for r in several]
    gates = settings.rest_gate
    if gates is None:
        found = [chosen_gates(r, speed, limits) for r, (speed, _) in zip(several, moved, strict=True)]
        gates = tuple(max(column) for column in zip(*found, strict=True))
    elif isinstance(gates, float | int):
        gates = (float(gates),) * first.n
    if len(gates) != first.n:
        raise InputError(f"{first.name}: found {len(gates)} rest thresholds, expected one or {first.n}")
    noise = [noise_of(r, a, light, limits) for r, (_, a) in zip(several, moved, strict=True)]
    noisy = bool(np.max([n.accelerations for n in noise]) > limits.max_acceleration_noise)
    time = settings.rest_time
    if time is None:
        time = max(limits.rest_cutoff_periods / cutoff, limits.min_rest_time) if cutoff else 3 * first.step
    return Chosen(
        cutoff=cutoff,
        order=settings.order,
        position_cutoff=position,
        position_order=settings.position_order,
        half_width=settings.half_width,
        factor=factor,
        trim=trim,
        rest_speeds=gates,
        rest_time=time,
        noise=tuple(np.max([n.speeds for n in noise], axis=0).tolist()),
        edge=1.0 / (position or 0.5 * rate) if noisy else 0.0,
        turns=settings.turns,
        thresholds=limits,
    )


def _seldom_new(records: Sequence[Record]) -> str:
    """Why records have another rate than their stamps: readings that repeat, in words."""
    said = [f"every {r.repeats:.3g} rows of {r.name}" for r in records if r.repeats > 1.0]
    return f", for readings are new once in {' and in '.join(said)}" if said else ""


def _check(record: Record, cutoff: float, position_cutoff: float) -> None:
    rate = 1.0 / record.step
    for name, value in (("cut-off", cutoff), ("position cut-off", position_cutoff)):
        if not 0.0 <= value < 0.5 * rate:
            raise InputError(
                f"{record.name}: found the {name} {value:g} Hz, expected one above 0 and below half the "
                f"rate, {0.5 * rate:.6g} Hz"
            )


def chosen_gates(record: Record, speed: Array, limits: DatasetThresholds) -> tuple[float, ...]:
    """Speeds [rad/s, m/s] below which the joints are at rest: 1 % of their high speeds (N, n), and all of
    their speeds where they have a few readings alone, or noise alone.
    """
    high = np.quantile(np.abs(speed), 0.99, axis=0)
    few = [len(np.unique(q)) <= limits.max_readings_at_rest for q in record.q.T]
    still = noise_alone(record.q) | np.array(few)
    gate = limits.rest_speed
    return tuple(np.where(still, (1.0 + gate) * np.abs(speed).max(axis=0), gate * high).tolist())


@dataclass(frozen=True)
class Noise:
    """speeds: (n,) that the rounding of positions may feign [rad/s, m/s]. accelerations: (n,), the share of
    their power that noise of the positions makes.
    """

    speeds: Array
    accelerations: Array


def noise_of(record: Record, ddq: Array, light: tuple[float, int, int], limits: DatasetThresholds) -> Noise:
    """What the noise of a record's positions makes of their derivatives, white noise (Bennett 1948).

    Of their accelerations that is all that their spectrum shows; of speeds near zero the rounding alone,
    since jitter of the stamps, say, is noise of a joint that moves. ddq: accelerations (N, n), as `smoothed`
    makes them of the positions; light: cut-off [Hz], order and half-width by which it does.
    """
    impulse = np.zeros((len(record.t), 1))
    impulse[len(impulse) // 2] = 1.0
    _, speed, acceleration = smoothed(impulse, record.step, *light)
    rounding = position_steps(record) / math.sqrt(12.0)
    deviations = np.maximum(rounding, [white_noise(q, 1.0 / record.step) for q in record.q.T])
    power = np.maximum(np.mean(ddq**2, axis=0), 1e-300)
    return Noise(
        limits.direction_deviations * np.linalg.norm(speed) * rounding,
        (np.linalg.norm(acceleration) * deviations) ** 2 / power,
    )
