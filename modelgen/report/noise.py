"""The error of an identified model beside the noise of its test records, in the words of the diagnosis.

Noise is what differs between the periods of a motion, here as in the lack of fit of a diagnosis.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.identification import Validation
from modelgen.identification.unexplained import FAR
from modelgen.numeric import Array

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


def noise_known(test: Validation) -> bool:
    """Whether the test records repeat."""
    return test.repeats is not None and bool(np.isfinite(test.repeats).any())


def counted_as_noise(test: Validation) -> str:
    """What the noise in the table of errors counts, and what an error above it can be."""
    return _COUNTED if noise_known(test) else _UNKNOWN


def beside_noise(test: Validation, names: Sequence[str]) -> tuple[bool, str]:
    """Whether the model clearly lacks something, by how much the error is larger than the noise, and what is
    said of it before the command that names it. names: of the joints.
    """
    if not noise_known(test) or test.repeats is None:
        return False, _LACKING
    times = np.nan_to_num(test.rmse / np.maximum(test.repeats, 1e-300))
    j = int(np.argmax(times))
    where = names[j]
    if times[j] < FAR:
        less = ", and less elsewhere" if len(times) > 1 else ""
        said = f"The error is {times[j]:z.2g} times the noise at {where}{less}."
        return False, f"{said} {_WHETHER}"
    said = f"The error at {where} is {times[j]:.0f} times the noise"
    if (test.rmse < FAR * np.hypot(test.repeats, np.sqrt(test.coarse) * _changes(test))).all():
        theirs = (
            f"the steps of the positions feign {100 * test.coarse:.2g} % of the power of the accelerations "
            "and can make it; a lower cut-off tells"
        )
        return False, f"{said}: {theirs}. {_WHETHER}"
    return True, f"{said}: the model lacks something. This names it:"


def _changes(test: Validation) -> Array:
    """Standard deviations (n,) of the efforts: what accelerations make of them is less."""
    return np.asarray(np.std(test.measured, axis=0))
