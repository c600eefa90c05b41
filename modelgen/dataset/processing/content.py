"""What the positions of a record hold of the motion, and what of noise: the cut-offs that this asks for.

The noise of coarse positions is known: their rounding. It hides the motion from some frequency on, beyond
which neither the motion's bandwidth nor any other noise is looked for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.rounding import difference_power, position_steps, rounding_power
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array

NOISIER = 3.0  # times its rounding, from which on a position has other noise
TOP = 0.35  # of the rate: central differences see little above


@dataclass(frozen=True)
class Spectrum:
    """Speeds of the coordinate `joint`, from 0. f: (F,) [Hz]. power, rounding: (F,) of the speed, and of what
    its rounding feigns of it, zero where the positions have no steps. seen: (F,), where motion shows. white:
    (F,) of the speeds that white noise of positions makes, of power 1.
    """

    joint: int
    f: Array
    power: Array
    rounding: Array
    seen: np.ndarray
    white: Array

    @property
    def content(self) -> Array:
        """Power of the speed without its noise, (F,)."""
        # its estimate scatters: twice the level is noise
        return np.asarray(
            np.where(self.seen, np.maximum(self.power - 2.0 * self.floor * self.white, 0.0), 0.0)
        )

    @property
    def floor(self) -> float:
        """Power density of white noise of the positions, from the upper half, where no motion is."""
        upper = self.f > 0.5 * self.f[-1]
        return float(np.median(self.power[upper] / self.white[upper]))

    def bandwidth(self, share: float) -> float:
        """Frequency [Hz] below which a share of the speed's power lies."""
        speeds = np.cumsum(self.content)
        return float(self.f[np.searchsorted(speeds, share * speeds[-1])])

    def quiet(self, begin: float, share: float, rounded: float) -> float:
        """Highest cut-off [Hz] that leaves noise a share of the power of the accelerations.

        Where rounding is all the noise there is, it is known; rounded: the share that it may feign. Else
        what the spectrum holds beyond its valley, looked for from `begin` [Hz] on, and the valley's level
        below it, counts as noise.
        """
        if self.rounding_alone:
            noisy = self.feigned > rounded
            return float(self.f[np.argmax(noisy)]) if noisy.any() else float(self.f[-1] + self.f[1])
        f, accelerations = self.f, self.power * (2 * np.pi * self.f) ** 2
        edges = max(begin, f[1]) * 2.0 ** np.arange(0.0, 20.0, 0.5)
        bands = [(f >= low) & (f < high) for low, high in pairwise(edges)]
        levels = [(float(np.mean(accelerations[b])), float(f[b][0])) for b in bands if b.any()]
        level, valley = min(levels, default=(0.0, float(f[-1])))
        noise = np.cumsum(np.where(f < valley, level, accelerations))
        noisy = noise > share * np.sum(accelerations[f < valley])
        noisy |= self.feigned > rounded
        return float(f[np.argmax(noisy)]) if noisy.any() else float(f[-1] + f[1])

    @property
    def rounding_alone(self) -> bool:
        """Whether the positions have steps, and no noise beside them, in the upper half of the spectrum."""
        upper = self.f > 0.5 * self.f[-1]
        power, rounding = self.power[upper], self.rounding[upper]
        return bool(rounding.any() and np.median(power) < NOISIER * np.median(rounding))

    @property
    def feigned(self) -> Array:
        """Power of the accelerations that rounding feigns up to each frequency, in all that shows, (F,)."""
        square = (2 * np.pi * self.f) ** 2
        whole = float(np.sum((self.power * square)[self.seen]))
        return np.asarray(np.cumsum(self.rounding * square) / max(whole, 1e-300))

    def quiet_speeds(self, share: float) -> float:
        """Frequency [Hz] up to which rounding feigns a share of the speed's power at most."""
        noisy = np.cumsum(self.rounding) > share * np.sum(self.power[self.seen])
        return float(self.f[np.argmax(noisy)]) if noisy.any() else np.inf


def noise_alone(q: Array) -> NDArray[np.bool_]:
    """Columns (n,) of positions (N, n) that change from one reading to the next by more than over the record.

    Those of a motion that is slower than a sixth of the rate do not: this is the noise of a joint at rest.
    """
    whole = q.std(axis=0)
    return np.asarray((np.diff(q, axis=0).std(axis=0) > whole) & (whole > 0.0))


def spectra(record: Record, limits: DatasetThresholds = USUAL) -> list[Spectrum]:
    """Those of the joints that have more readings than one at rest; of all where none has."""
    steps, rate = position_steps(record), 1.0 / record.step
    moving = [k for k in range(record.n) if len(np.unique(record.q[:, k])) > limits.max_readings_at_rest]
    return [_spectrum(k, record.q[:, k], steps[k], rate) for k in moving or range(record.n)]


def white_noise(values: Array, rate: float) -> float:
    """Standard deviation of the white noise of positions (N,) that are read at a rate [Hz]."""
    return math.sqrt(0.5 * rate * _spectrum(0, values, 0.0, rate).floor)


def _spectrum(joint: int, q: Array, step: float, rate: float) -> Spectrum:
    speed = np.gradient(q, 1.0 / rate)[1:-1]  # the ends are one-sided
    window = int(min(len(speed), max(64, 10.0 * rate)))
    f, power = signal.welch(speed, fs=rate, nperseg=window, detrend="constant")
    f, power = f[f < TOP * rate], power[f < TOP * rate]
    rounding, total = rounding_power(step, rate, f), step**2 / 12.0
    upper = f > 0.5 * f[-1]
    if step:  # a dither, or a little noise, adds to it
        more = float(np.median(power[upper] / rounding[upper]))
        more = more if 1.0 < more < NOISIER else 1.0
        rounding, total = more * rounding, more * total
    white = difference_power(rate, f)
    positions = np.divide(power, white, out=np.zeros_like(power), where=white > 0.0)
    return Spectrum(joint, f, power, rounding, f <= _seen(f, positions, total), white)


def _seen(f: Array, positions: Array, total: float) -> float:
    """Frequency [Hz] above which positions of such a spectrum (F,) have no more power than their rounding,
    which has `total`.

    Rounding of a slow motion is not white; the power of all of it is known.
    """
    beyond = np.cumsum(positions[::-1])[::-1] * f[1]
    hidden = beyond <= total
    return float(f[max(1, int(np.argmax(hidden)))]) if hidden.any() else float(f[-1])


def chosen_cutoff(
    records: Sequence[Record], limits: DatasetThresholds = USUAL, lengths: Sequence[float] = ()
) -> float:
    """Parallel cut-off [Hz] of records of one rate: as high as the noise of every record's positions allows.

    Noise in a regressor biases least squares: it makes up a thousandth of the accelerations' power at most.
    Bounded by the motions' own bandwidth, and by the records' rate and lengths. lengths: of further records
    [s] that are to be processed alike.
    """
    rate = 1.0 / records[0].step
    return min(quiet_cutoff(records, limits, lengths), rate / limits.samples_per_cutoff_period)


def quiet_cutoff(
    records: Sequence[Record],
    limits: DatasetThresholds = USUAL,
    lengths: Sequence[float] = (),
    *,
    rounding: bool = True,
) -> float:
    """The same without the bound of the rate. rounding: whether positions count whose only noise is that of
    their steps.
    """
    shares = limits.max_noise_share, limits.cutoff_rounding_share
    quiet, widest = np.inf, 0.0
    for spectrum in (s for record in records for s in spectra(record, limits)):
        width = spectrum.bandwidth(limits.bandwidth_power)
        widest = max(widest, width)
        if rounding or not spectrum.rounding_alone:
            quiet = min(quiet, spectrum.quiet(width, *shares))
    shortest = min(*(len(r.t) * r.step for r in records), *lengths, np.inf)
    least = max(limits.cutoff_over_bandwidth * widest, limits.min_cutoff_periods / shortest)
    return float(max(quiet, least))


def motion_bandwidth(record: Record, limits: DatasetThresholds = USUAL) -> float:
    """Frequency [Hz] below which nine tenths of the power of every joint's speed lie, noise apart."""
    return max(s.bandwidth(limits.bandwidth_power) for s in spectra(record, limits))


def quiet_speeds(record: Record, limits: DatasetThresholds = USUAL) -> float:
    """Frequency [Hz] up to which rounding spoils no joint's speed; infinite where positions have no steps."""
    return min(s.quiet_speeds(limits.max_speed_noise_share) for s in spectra(record, limits))


def check_coarse(record: Record, cutoff: float, limits: DatasetThresholds = USUAL) -> None:
    """Raises InputError where rounding feigns more of the accelerations below a cut-off [Hz] than may be.

    A cut-off that the motion needs may let through more of it than is asked for.
    """
    if feigned_by_rounding(record, cutoff, limits)[0] > limits.max_rounding_share:
        raise InputError(
            f"{record.name}: {too_coarse(record, cutoff, limits)}; what would help: the motor's encoder, "
            "faster motions over more of the range, more samples per second; --cutoff takes the choice upon "
            "you"
        )


def too_coarse(record: Record, cutoff: float, limits: DatasetThresholds = USUAL) -> str:
    """In words, where rounding feigns more of the accelerations below a cut-off [Hz] than may be."""
    share, joint = feigned_by_rounding(record, cutoff, limits)
    arm, most = record.arm, limits.max_rounding_share
    name = f"q{joint + 1}" if arm is None else arm.joints[arm.coordinates[joint]].name
    return (
        f"the positions of {name} are too coarse: steps of {position_steps(record)[joint]:.3g} feign "
        f"{100 * share:.2g} % of the power of its accelerations below {cutoff:.3g} Hz, expected "
        f"{100 * most:g} % at most"
    )


def feigned_by_rounding(
    record: Record, cutoff: float, limits: DatasetThresholds = USUAL
) -> tuple[float, int]:
    """The largest share of the accelerations' power below a cut-off [Hz] that rounding feigns, and its joint
    (from 0).
    """
    return max((float(s.feigned[np.searchsorted(s.f, cutoff) - 1]), s.joint) for s in spectra(record, limits))
