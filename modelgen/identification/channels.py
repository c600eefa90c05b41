"""Faults of an effort's channel that parameters take up: a zero that is off, readings that fall short or are
smoothed, drift or are cut off towards zero.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.rounding import LONGEST, resolution
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.beside import Beside
from modelgen.identification.cut_off import LEVELS
from modelgen.identification.drifting import drifting
from modelgen.identification.objects import DIAGNOSING, Doubt
from modelgen.identification.slow_turns import SAID as WRONG
from modelgen.identification.slow_turns import slow_turns
from modelgen.identification.truncated import truncated
from modelgen.identification.validation import beginning

CLEARLY = 5.0  # standard deviations, which hold that residuals of neighbouring rows hang together
POWER = 5  # of the model's effort over its largest: what a channel lacks that is cut off, sharply or softly
COARSE = 2.0  # deviations of the effort, from which on its rounding is no noise beside it (Widrow 1956)
ZERO, SHORT = 0.1, 0.5  # of the squares that are left, which a constant and a curve explain at least
ABOVE_ALL = 0.5  # the same of a constant, in a diagnosis, which names effects


def effort_questions(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    zero: float = ZERO,
    *,
    short: bool = True,
) -> list[Doubt]:
    """Questions about joints of whose efforts a constant, or readings that fall short where they are large,
    explain a part that is no chance, or whose efforts drift, are cut off towards zero or smoothed.

    Weights of links take up most of either, so that little shows in the residuals. zero: part of the squares
    that the model leaves, which a constant explains at least. short: whether efforts that fall short are
    asked about.
    """
    if any(p.record.input is None or p.record.arm is None for p in train):
        return []
    try:
        found = Beside([beginning(p, model) for p in train], model, evaluator)
        if not found.enough:
            return []
        # What says more of a channel comes later, and instead.
        said = (
            drifting(train, model, evaluator)
            | _faults(found, train, zero, short=short)
            | truncated(found, train)
        )
        turns = slow_turns(found.records, found.own, model, evaluator)
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return []  # what is wrong is said where the parameters are found
    return [*(said[j] for j in sorted(said)), *turns]


def _faults(found: Beside, train: Sequence[Prepared], zero: float, *, short: bool) -> dict[int, Doubt]:
    """Questions by joint (from 0) about a constant, and readings that fall short."""
    constants = found.explained(np.ones_like)
    curves = found.explained(lambda effort: effort**POWER) if short else None
    first, said = train[0].record, dict[int, Doubt]()
    assert first.arm is not None
    for j, name in enumerate(first.arm.coordinate_names):
        if _coarse(train, j):
            continue
        share = float(constants.share[j])
        if curves is not None and curves.clear[j] < -CLEARLY and curves.share[j] > max(SHORT, share):
            text = (
                f"The efforts of {name} fall short of the model's where they are large, which explains "
                f"{100 * curves.share[j]:.0f} % of what it leaves: are they cut off, softly or beneath "
                f"noise, or does the motor saturate{DIAGNOSING}? {WRONG}"
            )
            said[j] = Doubt(text, [name])
        elif abs(constants.clear[j]) > CLEARLY and share > zero:
            value = constants.amount[j] * found.gain[j]
            text = (
                f"A constant effort of {value:.3g} {first.effort_unit[j]} at {name} explains "
                f"{100 * share:.0f} % of what the model leaves there: are the readings zero without an "
                f"effort, and is friction the same either way{DIAGNOSING}? {WRONG}"
            )
            said[j] = Doubt(text, [name])
    return said


def _coarse(train: Sequence[Prepared], j: int) -> bool:
    """Whether the effort of a coordinate has steps that are large beside its changes."""
    logged = [
        x[:LONGEST, j][p.awake[:LONGEST, j]] for p in train if (x := p.record.logged_effort) is not None
    ]
    moving = np.concatenate(logged)
    if not 0 < len(np.unique(moving)) < LEVELS:
        return len(moving) > 0 and (resolution(moving) or 0.0) > COARSE * float(np.std(moving))
    return True
