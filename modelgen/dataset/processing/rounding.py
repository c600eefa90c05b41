"""Rounding of positions and efforts: its step, as the readings show it, and its errors, which follow from
that.
"""

from __future__ import annotations

import numpy as np

from modelgen.dataset.drives import drives_of
from modelgen.dataset.objects import Record
from modelgen.numeric import Array

WAVES = 8  # of the sawtooth of rounding errors: noise of a twelfth of a step leaves no more
LONGEST = 1 << 18  # samples that a step is read off
_WHOLE = 0.01  # of a step, by which a multiple of it may miss a whole number
# The same where a log has few digits for its counts, and of how many differences, which chance does not have:
# of random ones three in ten are so near a whole number.
_DIGITS, _MANY = 0.15, 30
_REACH = 3.0  # times as large are the differences by which a step is made more exact, from look to look


def resolution(values: Array) -> float | None:
    """The step that all differences of readings (N,) are multiples of, None where there is none."""
    # Two decimal readings differ by rounding alone where they were one number.
    smallest = 1e-12 * float(np.max(np.abs(values)))
    steps = np.diff(np.unique(values))
    steps = steps[steps > smallest]
    if len(steps) < 2:
        return None
    # The mean over many steps has more digits than the smallest.
    step, reach = float(steps.min()), 1.5
    while True:
        some = steps[steps < reach * step]
        step = float(some.sum() / np.round(some / step).sum())
        if len(some) == len(steps):
            break
        reach *= _REACH
    multiples = steps / step
    missed = float(np.max(np.abs(multiples - np.round(multiples))))
    return step if missed <= (_WHOLE if len(steps) < _MANY else _DIGITS) else None


def step_of(values: Array) -> float:
    """Resolution of a log's readings (N,) as its first ones show it, in their unit; 0 where there is none."""
    return resolution(values[:LONGEST]) or 0.0


def effort_steps(record: Record, share: float) -> Array:
    """Steps (n,) of the logged efforts whose rounding is more than a share of them, 0 where it is less or
    they have none. Root mean squares.
    """
    logged = record.logged_effort
    found = np.zeros(record.n)
    if logged is None:
        return found
    for k, effort in enumerate(logged[:LONGEST].T):
        levels = np.unique(effort)
        step = float(np.ptp(levels)) if len(levels) == 2 else resolution(effort)
        if step is not None and step / np.sqrt(12.0) > share * np.sqrt(np.mean(effort**2)):
            found[k] = step
    return found


def mean_error(values: Array, step: float, noise: float) -> Array:
    """Error (N,) that rounding to a step has on average where noise of a deviation is added before.

    The sawtooth of the values (N,) through the noise's characteristic function (Widrow 1956).
    """
    error = np.zeros(len(values))
    for k in range(1, WAVES + 1):
        size = step / (np.pi * k) * np.exp(-2.0 * (np.pi * k * noise / step) ** 2)
        error += (-1.0) ** k * size * np.sin(2.0 * np.pi * k * values / step)
    return error


def mean_error_power(step: float, noise: float) -> float:
    """Mean square of `mean_error` over values anywhere in a step."""
    k = np.arange(1, WAVES + 1)
    return float(np.sum((step / (np.pi * k)) ** 2 * np.exp(-4.0 * (np.pi * k * noise / step) ** 2)) / 2.0)


def scatter_of(step: float, noise: float) -> float:
    """Variance of readings rounded to a step, of a value with noise of a deviation: of the noise, and of the
    rounding errors what their mean is not.
    """
    return noise**2 + step**2 / 12.0 - mean_error_power(step, noise)


def position_steps(record: Record) -> Array:
    """Steps of the joint coordinates (n,) [rad, m] that those of the logged positions are, 0 where none show.

    Behind a lever the step is the mean over the record.
    """
    sides = record.motor_side or (False,) * record.n
    logged = [record.motor[:, k] if side else record.q[:, k] for k, side in enumerate(sides)]
    steps = record.counts or tuple(map(step_of, logged))
    drives = () if record.arm is None else drives_of(record.arm)
    found = np.array(steps)
    for k, side in enumerate(sides):
        if side and drives and found[k]:
            found[k] /= float(np.mean(np.abs(drives[k].k1(record.q[:LONGEST, k]))))
    return found


def difference_power(rate: float, f: Array) -> Array:
    """Power of the speed over that of the position [1/s^2], by central differences of one sample, at
    frequencies f [Hz].
    """
    return np.asarray((np.sin(2 * np.pi * f / rate) * rate) ** 2)


def rounding_power(step: float, rate: float, f: Array) -> Array:
    """Power per Hz of the speed that rounding to a step feigns, at frequencies f [Hz].

    Rounding errors are uniform over a step and counted as white (Bennett 1948); central differences of one
    sample make speeds of them.
    """
    return np.asarray(step**2 / (6.0 * rate) * difference_power(rate, f))
