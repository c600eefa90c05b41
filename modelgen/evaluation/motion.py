"""A motion along which effects are probed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from modelgen.backends.numpy import NumpyFunction
from modelgen.evaluation.reversals import Pieces, pieces_of
from modelgen.functions.objects import Function
from modelgen.numeric import Array

# An implicit midpoint rule makes what rings at f slower by (pi f step)^2 / 3: 0.8 % at 10 Hz in FINE steps.
FINE = 0.005  # s
RINGING = 10.0  # s, in which what a motion begins with has rung down


@dataclass(frozen=True)
class Motion:
    """N samples of one record at a uniform rate: t (N,) [s], q, dq, ddq (N, n) [rad, m and rates].

    motor_side: by coordinate, whether q was derived from a reading at the motor; empty: not known, q is used
    as the drive's. cutoff: of the filter that regressors will pass [Hz]; 0: none. before: the motion that
    this one runs on from, with a rest between them where the times are apart; None: states begin at zero.
    """

    t: Array
    q: Array
    dq: Array
    ddq: Array
    motor_side: tuple[bool, ...] = ()
    cutoff: float = 0.0
    before: Motion | None = field(default=None, repr=False)
    held: bool = False

    def picked(self, samples: NDArray[np.intp]) -> Motion:
        """The motion at these samples alone, one by one."""
        return Motion(self.t[samples], self.q[samples], self.dq[samples], self.ddq[samples])

    @cached_property
    def beginning(self) -> Motion:
        """Its first `RINGING` seconds."""
        count = max(2, round(RINGING / self.step))
        tables = {name: getattr(self, name)[:count] for name in ("t", "q", "dq", "ddq")}
        return replace(self, **tables, before=None)

    def rest_until(self, end: float) -> Motion:
        """A rest from where this motion ends up to a time [s], as one step (2 samples)."""
        still = np.zeros((2, self.q.shape[1]))
        t, q = np.array([self.t[-1], end]), np.repeat(self.q[-1:], 2, axis=0)
        return Motion(t, q, still, still, self.motor_side, self.cutoff)

    @cached_property
    def pieces(self) -> Pieces | None:
        """Parts of the samples within which joints turn back, None where none does."""
        return pieces_of(self.dq)

    @cached_property
    def finer(self) -> tuple[Motion, int]:
        """The motion in the middle of steps that are fine, and how many of these make one of its own.

        What rings is simulated in these: a step that holds the load of its begin is half of itself late, as
        damping makes it.
        """
        count = max(1, math.ceil(self.step / FINE - 1e-9))
        begins = np.linspace(self.t[0], self.t[-1], (len(self.t) - 1) * count + 1)
        t = np.minimum(begins + self.step / count / 2, self.t[-1])
        q, dq = (CubicHermiteSpline(self.t, *x)(t) for x in ((self.q, self.dq), (self.dq, self.ddq)))
        return replace(self, t=begins, q=q, dq=dq, ddq=CubicSpline(self.t, self.ddq)(t), before=None), count

    @property
    def step(self) -> float:
        """Sampling period [s]."""
        return float(self.t[-1] - self.t[0]) / max(1, len(self.t) - 1)


def given_for(
    function: Function,
    motion: Motion,
    parameters: Array,
    *,
    free: tuple[float, ...] = (),
    geometry: Array | None = None,
    loads: Array | None = None,
    states: Array | None = None,
) -> dict[str, Array]:
    """Arguments of a function along a motion, by name; loads and states are zero where they are not given."""
    count, n = motion.q.shape
    known = {
        "q": motion.q,
        "dq": motion.dq,
        "ddq": motion.ddq,
        "time": motion.t[:, None],
        "dt": np.full((count, 1), motion.step),
        "parameters": np.asarray(parameters, dtype=float),
        "free": np.asarray(free, dtype=float),
        "geometry": np.zeros(0) if geometry is None else geometry,
        "load": loads if loads is not None else np.zeros((count, n)),
        "state": states if states is not None else np.zeros((count, 1)),
        "input": np.zeros((count, n)),
    }
    return {a.name: known[a.name] for a in function.arguments}


def evaluated(
    call: NumpyFunction, given: Mapping[str, Array], motion: Motion, *, means: bool = False
) -> Array:
    """Values of a function along a motion, from its arguments (N, .) or (.,) by name; with `means`, or where
    efforts are held, the mean over the sample of samples within which a joint turns back.
    """
    found = np.asarray(call(**given))
    pieces = motion.pieces if (means or motion.held) and "dq" in given else None
    if pieces is None:
        return found
    within = {name: x[pieces.sample] if x.ndim == 2 else x for name, x in given.items()}
    within["dq"] = pieces.speeds(motion.dq)
    samples, values = pieces.means(np.asarray(call(**within)))
    found[samples] = values
    return found
