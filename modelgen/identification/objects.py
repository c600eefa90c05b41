"""Results of an identification."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.description import Arm
from modelgen.functions import Model
from modelgen.identification.consistent import Consistent
from modelgen.identification.gains import Gain
from modelgen.identification.instrumental import Comparison
from modelgen.numeric import Array
from modelgen.options.noise import Noise
from modelgen.regression.least_squares import Solution

POOR = 30.0  # % of relative standard deviation from which a parameter is called poorly determined


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
    noise: of the inputs there.
    """

    unit: tuple[str, ...]
    rmse: Array
    nrmse_percent: Array
    rows: Array
    t: Array
    measured: Array
    predicted: Array
    noise: Noise | None = None


@dataclass(frozen=True)
class Identification:
    """Parameters that the training records give an arm, and its errors on the test records.

    gains: torque constants that were found; `arm` has them. doubts: about what no arm has, or the described
    one has not.
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
