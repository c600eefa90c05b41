"""A record becomes what regressions are made of: filtered positions, derivatives, and one parallel filter.

Regressor columns are evaluated at full rate from lightly filtered positions; the effort and all columns
then pass the same low-pass filter and are decimated alike (Gautier, 1997, "Dynamic identification of
robots with power model"; Pham, Gautier and Poignet, 2001).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from modelgen.dataset.couplings import couplings_of
from modelgen.dataset.drives import drives_of
from modelgen.dataset.objects import Record
from modelgen.dataset.processing.decimation import Decimation, decimation, kept
from modelgen.dataset.processing.filters import advanced, low_pass, smoothed
from modelgen.dataset.processing.rest import (
    beside_turns,
    directed,
    moving_samples,
    samples_away_from_rest,
    weights,
)
from modelgen.dataset.processing.saturation import saturated
from modelgen.dataset.processing.settings import Chosen, Settings, choose
from modelgen.errors import InputError
from modelgen.numeric import Array

COLUMNS = 32  # filtered together


@dataclass(frozen=True)
class Prepared:
    """A processed record: N samples at full rate, M after decimation and trimming, n coordinates.

    time: (N,) [s]. q, dq, ddq: (N, n) joint coordinates and derivatives [rad, m, per s, per s^2], filtered.
    motor, dmotor, ddmotor: the same in the motor coordinates [motor unit]. input: (N, n) in the contract's
    unit, moved to the instants of the positions, not filtered; None for a free motion. gain: (N, n), input
    times gain is what the log carried, in `effort_unit` by joint. temperature: (N, n) [deg C] or None.
    rows: (M,) indices of the samples that are kept. t: (M,) their times [s]. moving: (M, n), whether the
    joint moves there, away from rest, and its effort is not cut off. awake: (N, n), whether that is so at all
    samples, and so does what it turns with another joint, rests of a moment counted; at all of a free motion.
    settings: as used, every choice made. before: the record that this one runs on from, see `in_sequence`;
    None: it begins cold.
    """

    record: Record
    settings: Chosen
    time: Array
    q: Array
    dq: Array
    ddq: Array
    motor: Array
    dmotor: Array
    ddmotor: Array
    input: Array | None
    gain: Array | None
    effort_unit: tuple[str, ...]
    temperature: Array | None
    rows: np.ndarray
    moving: np.ndarray
    awake: np.ndarray
    before: Prepared | None = field(default=None, compare=False, repr=False)

    @property
    def t(self) -> Array:
        """Times of the rows (M,) [s]."""
        return np.asarray(self.time[self.rows])

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return self.record.n

    @property
    def rate(self) -> float:
        """Rows per second [Hz]."""
        return 1.0 / (self.record.step * self.settings.stride)

    @property
    def decimation(self) -> Decimation | None:
        """The parallel filter at the rows alone; None where all samples are filtered, or none."""
        chosen = self.settings
        return decimation(len(self.time), self.rows, chosen.cutoff, 1.0 / self.record.step, chosen.order)

    def parallel(self, columns: Array) -> Array:
        """Columns (N,) or (N, k) at full rate, low-passed, decimated and trimmed: (M,) or (M, k).

        THE filter of effort and of every regressor column.
        """
        table: Array = columns.reshape(len(columns), -1)
        result = np.empty((len(self.rows), table.shape[1]))
        rate, chosen = 1.0 / self.record.step, self.settings
        # Some columns at a time: what the filter takes along stays small.
        for k in range(0, table.shape[1], COLUMNS):
            part = table[:, k : k + COLUMNS]
            result[:, k : k + COLUMNS] = kept(part, self.rows, chosen.cutoff, rate, chosen.order)
        return result.reshape((len(self.rows), *columns.shape[1:]))

    def smooth(self, columns: Array) -> Array:
        """Columns (N, k) at full rate without the noise of the accelerations that they are made of: (N, k).

        Through the parallel filter, where there is one.
        """
        chosen = self.settings
        if not chosen.cutoff:
            return columns
        return low_pass(columns, chosen.cutoff, 1.0 / self.record.step, chosen.order)

    @cached_property
    def weights(self) -> Array:
        """Weights (N, n) of the samples that are awake, by which columns are multiplied before the filter."""
        return self.weighted(self.awake)

    def weighted(self, flags: np.ndarray) -> Array:
        """Weights (N, n), for samples that count (N, n)."""
        return weights(flags, self.settings, 1.0 / self.record.step)

    def picked(self, columns: Array) -> Array:
        """Columns (N, ...) at the rows, not filtered: (M, ...)."""
        return np.asarray(columns[self.rows])

    def with_turns(self) -> Prepared:
        """The same where samples beside turns count; what is filtered stays as it is."""
        if self.settings.turns or self.input is None:
            return self
        settings = replace(self.settings, turns=True)
        return replace(self, settings=settings, awake=_counted(self.record, self.dq, settings))

    @property
    def effort(self) -> Array:
        """The input through the parallel filter (M, n). Raises InputError for a free motion."""
        if self.input is None:
            raise InputError(f"{self.record.name}: a free motion has no effort")
        return self.parallel(self.input)


def prepare(record: Record, settings: Settings | Chosen | None = None) -> Prepared:
    """The record processed by `settings`, by default by what its rate and content ask for.

    Raises InputError where the record is too short for the filters, or cut-offs do not fit its rate.
    """
    chosen = choose(record, settings)
    step = record.step
    rate = 1.0 / step
    drives = drives_of(record.arm) if record.arm is not None else ()
    sides = record.motor_side or (False,) * record.n
    # Quantisation is even in the coordinate that was logged: that one is filtered, the other follows.
    logged = np.where(sides, record.motor, record.q) if any(sides) else record.q
    light = (chosen.position_cutoff, chosen.position_order, chosen.half_width)
    q, dq, ddq = smoothed(logged, step, *light)
    if drives:
        both = zip(drives, sides, strict=True)
        ratios = np.array([1.0 if side or d.ratio is None else d.ratio for d, side in both])
        motor, dmotor, ddmotor = q * ratios, dq * ratios, ddq * ratios
    else:
        motor, dmotor, ddmotor = smoothed(record.motor, step, *light)
    for k, drive in enumerate(drives):
        if sides[k]:
            q[:, k] = drive.joint(motor[:, k])
            k1, slope = drive.k1(q[:, k]), drive.slope(q[:, k])
            dq[:, k] = dmotor[:, k] / k1
            ddq[:, k] = (ddmotor[:, k] - slope * dq[:, k] ** 2) / k1
        elif drive.ratio is None:
            motor[:, k] = drive.motor(q[:, k])
            k1, slope = drive.k1(q[:, k]), drive.slope(q[:, k])
            dmotor[:, k] = k1 * dq[:, k]
            ddmotor[:, k] = k1 * ddq[:, k] + slope * dq[:, k] ** 2
    if not np.isfinite(q).all():
        raise InputError(
            f"{record.name}: filtered motor coordinates leave the lever's stroke; check the description"
        )
    given = None
    if record.input is not None:
        given = advanced(record.input, record.hold / step, record.held) if record.hold else record.input
    rows, least = kept_rows(record, chosen), chosen.thresholds.min_rows
    if len(rows) < least and record.core is None:
        raise InputError(
            f"{record.name}: found {len(record.t) * step:.4g} s, too short a record: with the cut-off "
            f"{chosen.cutoff:.4g} Hz only {len(rows)} rows remain, expected at least {least}"
        )
    cut = _cut_off(record)
    return Prepared(
        record=record,
        settings=chosen,
        time=record.t,
        q=q,
        dq=dq,
        ddq=ddq,
        motor=motor,
        dmotor=dmotor,
        ddmotor=ddmotor,
        input=given,
        gain=record.gain,
        effort_unit=record.effort_unit,
        temperature=record.temperature,
        rows=rows,
        moving=moving_samples(dq, rows, chosen, rate) & ~cut[rows],
        # a swing turns slowly, and what is known of its friction is there
        awake=np.ones(dq.shape, dtype=bool) if given is None else _counted(record, dq, chosen, cut),
    )


def _counted(record: Record, dq: Array, chosen: Chosen, cut: np.ndarray | None = None) -> np.ndarray:
    """Samples (N, n) that are awake and whose effort is not cut off. cut: those where it is, where known."""
    return np.asarray(_awake(record, dq, chosen) & ~(_cut_off(record) if cut is None else cut))


def _awake(record: Record, dq: Array, chosen: Chosen) -> np.ndarray:
    """Samples (N, n) away from rest, for speeds dq (N, n), of joints and of what turns with two of them.

    Nor do those count at which nobody knows which way a joint moves: it is slower than the rounding of its
    position lets see, or turns back within what the instants of the efforts are known to, a period where
    they lie between two readings; of held efforts, which are means, either side is known. Nor, where turns do
    not count, the last before a turn and the first after it: a joint sticks for a while as it turns, and
    nobody sees between two readings for how long, of means either. What lies between two readings is made of
    those a period further off, too.
    """
    rate, limits = 1.0 / record.step, chosen.thresholds
    between = abs(record.hold * rate - round(record.hold * rate)) > 1e-9
    within = 0.0 if record.held else 1.0 if between else limits.max_instant_std
    awake: np.ndarray = samples_away_from_rest(dq, chosen, rate)
    awake &= directed(dq, chosen.noise, within)
    if not chosen.turns:
        apart = math.ceil(rate / chosen.position_cutoff) if chosen.position_cutoff else 1
        awake &= ~beside_turns(dq, limits.turning_periods * (2.0 if between else 1.0), apart)
    for part in () if record.arm is None else couplings_of(record.arm):
        own = replace(chosen, rest_speeds=(part.gate(chosen.rest_speeds),))
        awake[:, [part.one, part.other]] &= samples_away_from_rest(part.speed(dq), own, rate)
    return awake


def _cut_off(record: Record) -> np.ndarray:
    """Samples (N, n) at which an effort is cut off, or was not read: they say no more of it than those that
    hold a joint.
    """
    found = np.zeros(record.q.shape, dtype=bool)
    if record.cut_off is not None:
        found |= record.cut_off
    elif (logged := record.logged_effort) is not None:
        for k, effort in enumerate(logged.T):
            found[:, k] = saturated(effort, record.q[:, k])
    return found if record.absent is None else found | record.absent


def kept_rows(record: Record, settings: Chosen) -> np.ndarray:
    """Indices of the samples that decimation and trimming keep.

    In a block of a stream they lie on the grid of the whole log.
    """
    trim = settings.trimmed(record.step)
    begin, end = (trim, len(record.t) - trim) if record.core is None else record.core
    if settings.spacing is not None:
        count = max(0, int((end - 1 - begin) / settings.spacing) + 1) if end > begin else 0
        return np.asarray(begin + np.floor(np.arange(count) * settings.spacing + 0.5).astype(int))
    begin += (trim - record.first - begin) % settings.factor
    return np.arange(begin, max(begin, end), settings.factor)


def held_inputs(p: Prepared) -> Array:
    """Inputs (N, n) constant over the interval that follows each sample; zeros for a free motion.

    Those of the log where that is how they were applied, else what they are in the interval's middle.
    """
    record = p.record
    if record.input is None:
        return np.zeros_like(p.q)
    early = record.step / 2 - record.hold
    if record.held or abs(early) < 1e-9 * record.step:
        return record.input
    t = record.t + early
    return np.stack([np.interp(t, record.t, u) for u in record.input.T], axis=1)
