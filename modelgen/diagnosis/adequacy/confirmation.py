"""The check `confirmed`: what a cause is worth on the test record."""

from __future__ import annotations

import numpy as np

from modelgen.diagnosis.validation import Check
from modelgen.effects import CATALOGUE


def confirmed(gain: float, low: float, there: bool = True) -> Check:
    """Whether a cause lowers the error on the test record.

    gain, low: its share and the lower bound [%]. there: whether the record has it, or is predicted better by
    an arm without it.
    """
    asked = bool(np.isfinite(low))
    text = "the test record cannot tell what it is worth there"
    if np.isfinite(gain):
        end = "which is too short for an interval"
        if asked:
            worst = f"{abs(low):.1f} % {_sense(low)} at the lower end of the 95 % interval"
            end = f"{worst}; more than 0 % less confirms it"
        how = "with it" if there else "where it is not, once the training records are fitted with it"
        text = f"{abs(gain):.1f} % {_sense(gain)} error on the test record {how}, {end}"
    return Check("confirmed", low > 0.0 if asked else None, False, low, 0.0, text)


def worth_nothing(gain: float, effect: str) -> Check:
    """The check that a cause fails where the causes make nothing less of the error on the test record.

    gain: of all of them together there [%].
    """
    text = (
        f"{abs(gain):.1f} % {_sense(gain)} error on the test record over all joints with it; what is named "
        "makes it less"
    )
    caveat = CATALOGUE[effect].caveat.strip(" .")
    return Check("confirmed", False, True, gain, 0.0, f"{text}. {caveat}" if caveat else text)


def _sense(gain: float) -> str:
    return "less" if gain >= 0.0 else "more"
