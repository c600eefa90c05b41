"""Rounding of the positions: its step, as the readings show it, and its noise, which follows from that."""

from __future__ import annotations

import numpy as np

from modelgen.dataset.drives import drives_of
from modelgen.dataset.objects import Record
from modelgen.numeric import Array

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
