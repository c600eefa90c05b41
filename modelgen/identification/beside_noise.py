"""The error of an identified model beside the noise of its test records, which no model predicts.

What is left above it repeats with the motion: the model lacks something. Deviations hold noise, and not that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.identification.objects import Doubt, Identification, Validation
from modelgen.identification.unexplained import FAR

TENS = 10.0  # from which on a figure has no decimals
_LACKS = "the model lacks something, and parameters may be wrong by more than their deviations say."


class Lacking(Doubt):
    """A doubt about a model that lacks something."""


@dataclass(frozen=True)
class BesideNoise:
    """joint: (from 0), whose error is largest beside its noise, `times` as large. far: whether that is more
    than noise is. steps: whether the steps of the positions can make it; rests: whether what holds joints at
    rest makes it.
    """

    joint: int
    times: float
    far: bool
    steps: bool
    rests: bool

    @property
    def lacks(self) -> bool:
        """Whether the model lacks something."""
        return self.far and not self.steps and not self.rests


def noise_known(test: Validation) -> bool:
    """Whether the test records repeat."""
    return test.repeats is not None and bool(np.isfinite(test.repeats).any())


def beside_noise(test: Validation) -> BesideNoise | None:
    """The error beside the noise; None where nothing repeats."""
    if test.repeats is None or not noise_known(test):
        return None
    times = np.nan_to_num(test.rmse / np.maximum(test.repeats, 1e-300))
    j = int(np.argmax(times))
    # what accelerations make of the efforts is less than all of their changes
    feigned = np.sqrt(test.coarse) * np.std(test.measured, axis=0)
    steps = bool((test.rmse < FAR * np.hypot(test.repeats, feigned)).all())
    rests = test.moving is not None and bool((test.moving < FAR).all())
    return BesideNoise(j, float(times[j]), bool(times[j] >= FAR), steps, rests)


def lacking(found: Identification) -> tuple[Doubt, ...]:
    """The doubt about a model that lacks something; none where another is said already."""
    if found.doubts:
        return ()
    names, remains = found.arm.coordinate_names, found.remains
    if remains is not None and len(remains.found):
        worst, *others = remains.found
        beside = f" ({', '.join(names[j] for j in others)} too)" if others else ""
        square = float(remains.statistic[worst])
        what = (
            f"What the model leaves at {names[worst]}{beside} repeats from period to period of the training "
            f"records, with {square:.{int(square < TENS)}f} times the mean square of noise"
        )
        return (Lacking(f"{what}: {_LACKS}", [names[j] for j in remains.found]),)
    known = None if found.test is None else beside_noise(found.test)
    if known is None or not known.lacks:
        return ()
    name = names[known.joint]
    return (Lacking(f"The error at {name} is {known.times:.0f} times the noise: {_LACKS}", [name]),)
