"""Results of an identification."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm
from modelgen.functions import Model
from modelgen.identification.consistent import Consistent
from modelgen.identification.gains import Gain
from modelgen.identification.instrumental import Comparison
from modelgen.numeric import Array
from modelgen.options.noise import Noise
from modelgen.regression.least_squares import Solution

POOR = 30.0  # % of relative standard deviation from which a parameter is called poorly determined
MATTERS = 1.0  # % of the effort: a parameter whose standard deviation moves less is determined well enough


@dataclass(frozen=True)
class Estimate:
    """A base parameter. std: None where the records do not determine it; essential: they support it.

    dropped: left out of the fit, and zero, because they do not. joint: number of the coordinate whose motion
    shows it; standard: name of the standard parameter that it stands for.
    """

    name: str
    value: float
    std: float | None
    unit: str
    essential: bool
    dropped: bool = False
    joint: int = 0
    standard: str = ""

    @property
    def relative(self) -> float | None:
        """Standard deviation in % of the value, None without one."""
        return None if self.std is None or not self.value else 100.0 * self.std / abs(self.value)


@dataclass(frozen=True)
class Validation:
    """On test records, by joint, in the unit that the log carried: rmse (n,), nrmse (n,) in % of the effort.

    t: (M,) [s]; measured, predicted: (M, n), records one after the other. rows: (n,), how many were judged.
    noise: of the inputs there. sizes: (n, p), RMS of what one unit of each parameter adds to the efforts.
    judged: (M, n), samples that were; at rest an effort is whatever holds the joint. None: all. repeats: RMSE
    (n,) of what differs between the periods of the records, which no model can predict, nan where nothing
    repeats. coarse: of the power of accelerations below the cut-off, what the steps of the positions feign.
    moving: error over noise (n,) where rests and turns are left out before the filter; None where not asked.
    """

    unit: tuple[str, ...]
    rmse: Array
    nrmse_percent: Array
    rows: Array
    t: Array
    measured: Array
    predicted: Array
    noise: Noise | None = None
    sizes: Array | None = None
    judged: NDArray[np.bool_] | None = None
    repeats: Array | None = None
    coarse: float = 0.0
    moving: Array | None = None

    def shown_by(self, k: int) -> int | None:
        """Joint (from 0) in whose effort parameter k weighs most; None where it shows in none."""
        if self.sizes is None:
            return None
        whole = np.sqrt(np.mean(self.measured**2, axis=0))
        shares = self.sizes[:, k] / np.where(whole > 0.0, whole, np.inf)
        return int(np.argmax(shares)) if shares.any() else None

    def in_effort(self, k: int, value: float) -> tuple[float, float]:
        """RMS of the effort that `value` of parameter k adds where it shows, and its share in % of all."""
        j = self.shown_by(k)
        if j is None or self.sizes is None:
            return 0.0, 0.0
        size = float(abs(value) * self.sizes[j, k])
        return size, 100.0 * size / float(np.sqrt(np.mean(self.measured[:, j] ** 2)))


DIAGNOSING = " (modelgen diagnose)"  # ends a question that a diagnosis answers


class Doubt(str):
    """A question about joints. joints: their names."""

    joints: tuple[str, ...]

    def __new__(cls, text: str, joints: Sequence[str] = ()) -> Self:
        """Make one of its text and the names of the joints."""
        made = super().__new__(cls, text)
        made.joints = tuple(joints)
        return made

    def without(self, words: str) -> Self:
        """The same question without these words."""
        return type(self)(self.replace(words, ""), self.joints)


class Impossible(Doubt):
    """A doubt about a result that no arm has."""


class WorseThanNone(Impossible):
    """A doubt about a model that predicts worse than none."""


@dataclass(frozen=True)
class LackOfFit:
    """What the model leaves alike in every period of the training records.

    statistic: its mean square over that of noise, (n,), one where the model is complete, nan where nothing
    repeats; threshold: (n,), from which on the model lacks something.
    """

    statistic: Array
    threshold: Array

    @property
    def found(self) -> NDArray[np.intp]:
        """Joints (from 0) at which the model lacks something, the worst first."""
        beyond = np.nan_to_num(self.statistic / self.threshold)
        order = np.argsort(-beyond, kind="stable")
        return order[beyond[order] > 1.0]

    def to_json(self) -> dict[str, Any]:
        """Plain data, by joint."""
        pairs = (("statistic", self.statistic), ("threshold", self.threshold))
        return {name: [float(x) if np.isfinite(x) else None for x in values] for name, values in pairs}


@dataclass(frozen=True)
class Identification:
    """Parameters that the training records give an arm, and its errors on the test records.

    gains: torque constants that were found; `arm` has them. doubts: about what no arm has, or the described
    one has not. signs_tried: whether the other signs of the efforts were tried, and explain no more. remains:
    in the training records, None where nothing repeats.
    """

    arm: Arm
    model: Model
    method: str
    solution: Solution
    estimates: tuple[Estimate, ...]
    test: Validation | None
    consistent: Consistent | None = None
    comparison: Comparison | None = None
    gains: tuple[Gain, ...] = ()
    doubts: tuple[str, ...] = ()
    signs_tried: bool = False
    remains: LackOfFit | None = None

    def poor(self) -> list[tuple[int, Estimate]]:
        """Parameters that are poorly determined, with their numbers: of themselves and in the effort, where a
        test record says so.
        """
        test = self.test if self.test is not None and self.test.sizes is not None else None
        return [
            (k, e)
            for k, e in enumerate(self.estimates)
            if not (e.std is None or e.dropped or (e.relative is not None and e.relative <= POOR))
            and (test is None or test.in_effort(k, e.std)[1] > MATTERS)
        ]
