"""What a page says of a record: its name and use, how long and fast it is, when it begins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.numeric import Array


@dataclass(frozen=True)
class Recorded:
    """use: "train", "test", or empty where all have one use. samples: N. rate [Hz]. begins: first stamp in
    seconds since 1970, None where the stamps do not count from then.
    """

    name: str
    use: str
    samples: int
    rate: float
    begins: float | None


def recorded(record: Record) -> Recorded:
    """What is said of a record that was read for an arm."""
    return of_stamps(record.name, record.t, record.begins)


def of_stamps(name: str, t: Array, begins: float | None) -> Recorded:
    """What is said of the stamps t (N,) [s]."""
    step = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    return Recorded(name, "", len(t), 1.0 / step if step > 0.0 else float("nan"), begins)
