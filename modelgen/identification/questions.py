"""What identification asks about records and about what it found of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from modelgen.dataset import Chosen, Prepared, Record
from modelgen.dataset.processing.content import feigned_by_rounding, too_coarse
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.channels import effort_questions
from modelgen.identification.doubts import doubts
from modelgen.identification.impossible import driving
from modelgen.identification.misread import Asked, check_reading
from modelgen.identification.objects import Identification
from modelgen.identification.signs import check_signs
from modelgen.numeric import Array


def misread(train: Sequence[Prepared], test: Sequence[Prepared], model: Model, evaluator: Evaluator) -> Asked:
    """Questions about training records that may hold something else than is read; test records are asked too.

    Raises InputError.
    """
    asked = check_reading(train, model, evaluator)
    if test:
        check_reading(test, model, evaluator)
    return asked


def coarse_positions(train: Sequence[Record], chosen: Chosen) -> tuple[str, ...]:
    """Where positions are too coarse for a cut-off that was asked for."""
    limits, cutoff = chosen.thresholds, chosen.cutoff
    for record in train if cutoff else ():
        if feigned_by_rounding(record, cutoff, limits)[0] > limits.max_rounding_share:
            return (
                f"{record.name}: {too_coarse(record, cutoff, limits)}: inertias come out too small, by more "
                "than their deviations say. Leave the cut-off to modelgen, or ask for a lower one.",
            )
    return ()


def doubts_of(
    train: Sequence[Prepared],
    found: Identification,
    evaluator: Evaluator,
    carried: Sequence[Array] | None = None,
) -> tuple[str, ...]:
    """Questions about what was found. carried: base parameters (p,) of each record's payload, None: none has
    one. Raises InputError where the efforts are counted the other way.
    """
    s = found.solution  # as the data have it: consistent parameters hide what is impossible
    plain = [replace(e, value=float(x)) for e, x in zip(found.estimates, s.theta, strict=True)]
    check_signs(train, found.model, evaluator, carried, whole=bool(driving(plain)))
    asked = [] if carried is not None else effort_questions(train, found.model, evaluator)
    return (*asked, *doubts(train, found.model, evaluator, s.theta, s.covariance, s.determined))
