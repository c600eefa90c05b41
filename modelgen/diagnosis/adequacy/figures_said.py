"""Figures of checks in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.charts import number, sized
from modelgen.description import Arm
from modelgen.diagnosis.adequacy.free_form import FreeForm
from modelgen.diagnosis.candidates import FittedCandidate
from modelgen.diagnosis.selection import Cause
from modelgen.effects import Parameter
from modelgen.effects.placement import joint_meant
from modelgen.model.parameters import units_at

FREE_FUNCTION = "a free function"
_FREE = ("a force ", "a gain ")  # that depends on something
CLEAR = 2.0  # standard deviations
HARDLY = 1e-4  # a share beneath which its figure says no more


def possible(cause: Cause, arm: Arm) -> str:
    """Its values, each with what it may be; a joint by its name alone, which was one of those to choose."""
    c, values = cause.trial.candidate, cause.trial.parameters
    units = units_at(arm, *c.place)
    said = [
        f"{p.name} is {joint_meant(arm, c.effect, p.name, values[p.name])}"
        if p.joint
        else f"{p.name} is {sized(values[p.name], units[p.name])}, may be {range_said(*p.bounds)}"
        for p in c.definition.accepted()
        if p.name in values
    ]
    return f"its values can be those of an arm: {'; '.join(said)}" if said else "it has no values of its own"


def beyond(parameters: Sequence[Parameter]) -> str:
    """That these come out beyond what they may be beside all other causes, a clause; empty for none."""
    said = [f"{p.name} beyond what it may be, {range_said(*p.bounds)}" for p in parameters]
    return f"beside all others it comes out with {' and '.join(said)}" if said else ""


def claimed(cause: FittedCandidate) -> tuple[str, ...]:
    """Names of what its effect claims and was found: without it the effect would not be there."""
    c = cause.candidate
    return tuple(name for name in c.definition.claims if name in (*c.names, *cause.values))


def significance(
    cause: FittedCandidate, arm: Arm, values: Mapping[str, float], spread: Mapping[str, float]
) -> tuple[float, str]:
    """How many standard deviations what a cause claims is from an arm without it, else the clearest of its
    parameters from zero, and that in words; not a number where none has a deviation.

    values, spread: of its parameters by name.
    """
    known = {name: std for name, std in spread.items() if std > 0.0}  # which one that is not a number is not
    names = claimed(cause)
    hidden = [name for name in names if values.get(name) == 0.0 and name not in known]
    if hidden:
        return 0.0, f"its {' and '.join(hidden)}, by which it would be there, does not show in these records"
    if names:
        found = cause.candidate.definition.above_zero(arm, {n: values[n] for n in known}, known)
        what = f"its {' and '.join(names)} differs by {number(found)} standard deviations"
        return found, f"{what} from that of an arm without it"
    sizes = [abs(values[name]) / std for name, std in known.items() if name in cause.candidate.names]
    one = len(cause.candidate.names) == 1
    text = "its evidence decides" if one else "their evidence together decides"
    if not sizes:
        return float("nan"), text
    largest = number(max(sizes))
    if one:
        name = cause.candidate.names[0]
        return max(sizes), f"{text}; its {name} is {largest} standard deviations from zero"
    text = f"{text}; the clearest of its parameters is {largest} standard deviations from zero"
    alone = "" if max(sizes) >= CLEAR else ": what they make together is known, none of them by itself"
    return max(sizes), f"{text}{alone}"


def range_said(low: float, high: float) -> str:
    """What a value may be between bounds of which either may be infinite."""
    if not np.isfinite(low) and not np.isfinite(high):
        return "anything"
    if not np.isfinite(high):
        return f"{number(low)} or more"
    return f"{number(high)} or less" if not np.isfinite(low) else f"{number(low)} to {number(high)}"


def ahead_of(ahead: float, most: float) -> str:
    """How much more or less something explains than a cause, and how much more it may."""
    if not np.isfinite(ahead):
        return "explains nothing"
    what = "more" if ahead > 0.0 else "less"
    may = f"{number(most)} more are allowed" if most > 0.0 else "it must not explain more"
    return f"explains {what}, by {number(abs(ahead))} of delta BIC; {may}"


def form_said(by: FreeForm) -> str:
    """What the form of a cause was held against, and how it does."""
    if by.slow:
        return (
            f"{number(-by.ahead)} of delta BIC are left for it without the rows at which its joint is "
            f"slowest, where friction changes; {number(-by.most)} is asked"
        )
    whole = by.error or by.what.startswith(_FREE)
    what = by.what if whole else f"{FREE_FUNCTION} of {by.what}"
    if by.pace:
        what = "the same with a size of its own in slow motion"
    elif by.apart:
        what = "the same with a size of its own at each joint"
    return f"{what} {ahead_of(by.ahead, by.most)}"


def percent(share: float) -> str:
    """A share in percent; hardly any has no figure of its own."""
    if 0.0 <= share < HARDLY:
        return f"less than {100.0 * HARDLY:g} %"
    return f"{number(100.0 * share, 2)} %"
