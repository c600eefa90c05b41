"""The part of a free motion that counts: from where a hand lets go to where the arm rests."""

from __future__ import annotations

import numpy as np

from modelgen.dataset.processing.prepare import Prepared
from modelgen.errors import InputError

AFTER = 1.0  # s of rest that count
LATEST = 0.1  # s, after which a motion that has not begun is held by a hand


def free_samples(p: Prepared) -> tuple[int, int]:
    """The samples of a record from and before which a free motion counts.

    It begins where a hand lets go: rest for longer than LATEST before it is left out, and so is rest later
    than AFTER. Raises InputError where all joints rest, or noise hides that they move.
    """
    q = p.record.q
    noise = 1.4826 * np.median(np.abs(np.diff(q, axis=0)), axis=0) / np.sqrt(2)
    far = np.maximum(10 * noise, 5e-3 * np.ptp(q, axis=0))
    moving, ending = (np.flatnonzero((np.abs(q - q[k]) > far).any(axis=1)) for k in (0, -1))
    if not len(moving) or not len(ending):
        raise InputError(
            f"{p.record.name}: all joints rest, or move by less than ten times their noise; expected a free "
            "motion"
        )
    last = int(ending[-1])
    begin = int(moving[0]) if moving[0] * p.record.step > LATEST else 0
    return begin, min(len(q), last + round(AFTER / p.record.step))
