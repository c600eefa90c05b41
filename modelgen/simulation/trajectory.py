"""How an arm has moved."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.numeric import Array


@dataclass(frozen=True)
class Trajectory:
    """Samples of a simulated motion.

    t: (S,) [s]. q, dq: (S, n) [rad, m; /s]. input: (S, n), held over the interval that follows [A; N m, N].
    states: (S, z) of the effects. ended: why it stopped before its time, empty where it did not.
    """

    t: Array
    q: Array
    dq: Array
    input: Array
    states: Array
    ended: str = ""
