"""The error of an identified model beside the noise of its test records, in the words of the diagnosis.

Noise is what differs between the periods of a motion, here as in the lack of fit of a diagnosis.
"""

from __future__ import annotations

import numpy as np

from modelgen.charts import number
from modelgen.identification import Identification, Validation
from modelgen.identification.beside_noise import Lacking, beside_noise, noise_known

SOME = 2.0  # times the mean square of noise: more than sound models leave of most logs
_LACKING = (
    "An error that is several times the noise says that the model lacks something; this names the cause."
)
_UNKNOWN = "Nothing repeats in the test records, so that they do not show how much of it is noise."
_WHETHER = "This says whether the model lacks something, and names the cause:"
_COUNTED = (
    "Noise is what differs between the periods of the test records. What the error has above it repeats: the "
    "model lacks something, or its parameters are not right for a motion that they were not fitted to. "
    "modelgen diagnose says which: its lack of fit is what repeats in the training records."
)


def counted_as_noise(test: Validation) -> str:
    """What the noise in the table of errors counts, and what an error above it can be."""
    return _COUNTED if noise_known(test) else _UNKNOWN


def said_of_noise(found: Identification) -> tuple[bool, str]:
    """Whether the model clearly lacks something, by how much the error is larger than the noise, and what is
    said of it before the command that names it.
    """
    if any(isinstance(doubt, Lacking) for doubt in found.doubts):
        return True, "This names what the model lacks:"
    known = None if found.test is None else beside_noise(found.test)
    if known is None or found.test is None:
        return False, _LACKING
    where = found.arm.coordinate_names[known.joint]
    if not known.far:
        less = ", and less elsewhere" if len(found.test.rmse) > 1 else ""
        said = f"The error is {known.times:z.2g} times the noise at {where}{less}."
        return False, f"{said}{_repeating(found)} {_WHETHER}"
    said = f"The error at {where} is {known.times:.0f} times the noise"
    if known.steps:
        theirs = (
            f"the steps of the positions feign {100 * found.test.coarse:.2g} % of the power of the "
            "accelerations and can make it; a lower cut-off tells"
        )
        return False, f"{said}: {theirs}. {_WHETHER}"
    if known.rests and found.test.moving is not None:
        least = number(float(np.nanmax(found.test.moving)), 2)
        held = (
            f"what holds joints at rest makes it; without their rests and turns it is {least} times the noise"
        )
        return False, f"{said}: {held}. {_WHETHER}"
    return True, f"{said}: the model lacks something. This names it:"


def _repeating(found: Identification) -> str:
    """What the model leaves alike in the periods of the training records, where that is more than noise."""
    fit = found.remains
    if fit is None or not (fit.statistic > SOME).any():
        return ""
    worst = int(np.nanargmax(fit.statistic))
    times, where = number(float(fit.statistic[worst]), 2), found.arm.coordinate_names[worst]
    return (
        f" In the training records {times} times the mean square of noise repeats at {where}: deviations do "
        "not hold that."
    )
