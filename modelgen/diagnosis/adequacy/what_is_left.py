"""What the causes leave is most like a function of no law, or an error of an encoder."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from modelgen.diagnosis.adequacy.checks import Examined
from modelgen.diagnosis.adequacy.encoder_errors import of_encoder
from modelgen.diagnosis.adequacy.lack_of_fit import LackOfFit
from modelgen.diagnosis.adequacy.smooth_functions import (
    Likeness,
    SmoothFunction,
    likeness,
    smooth_functions,
)
from modelgen.diagnosis.evidence import System


def most_like(system: System, suspects: Sequence[Examined], fit: LackOfFit | None) -> Likeness | None:
    """What the causes leave is most like this function of no law; None where it is like none.

    None as well of free motions, which show little but forces that depend on where the arm is. suspects: what
    failed a check, and is not among the system's columns. fit: lack of fit, None where nothing repeats.
    """
    return None if system.equations.free else likeness(_functions(system, suspects, fit), system)


def _functions(
    system: System, suspects: Sequence[Examined], fit: LackOfFit | None
) -> Iterator[SmoothFunction]:
    """All functions, and errors of the encoders at joints of suspects and where most is left."""
    yield from smooth_functions(system)
    joints = {j - 1 for e in suspects if (j := e.cause.trial.candidate.joint) is not None}
    if fit is not None and fit.found:
        joints.add(fit.worst.joint)
    for joint in sorted(joints):
        yield from of_encoder(joint, system)
