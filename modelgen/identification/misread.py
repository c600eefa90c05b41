"""Logs that were read wrongly: the same fit asks whether another reading explains the efforts far better."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.objects import DIAGNOSING, Doubt
from modelgen.identification.readings import ZERO, amounts, readings
from modelgen.identification.unexplained import FAR, POOR, Unexplained, unexplained
from modelgen.numeric import Array

BETTER = 0.33  # of what is unexplained, that another reading may leave to be believed
ALIKE = 2.0  # times what the best reading leaves, up to which another is named beside it
HARDLY = 0.5  # of the changes of a joint's efforts, unexplained, that is asked about
ANEW = 1.1  # times what differs between periods, up to which what is unexplained is said to be that
APART = 3.0  # times what fits to each record leave, from which on one to all is asked about
NOTABLE = 2.0  # % of the effort, likewise
ROWS = 100  # per parameter, of a record that is asked


@dataclass(frozen=True)
class Asked:
    """questions: about what the records hold. alone: RMS (n,) that fits to each record alone leave of the
    inputs, through the filter; None where they were not fitted so, or there is one record alone.
    """

    questions: tuple[Doubt, ...] = ()
    alone: Array | None = None


def check_reading(train: Sequence[Prepared], model: Model, evaluator: Evaluator) -> Asked:
    """Ask about positions in degrees, motor angles named joint angles or the other way round, positions
    counted the other way, efforts without their sign, and exchanged columns of two joints.

    Where the model explains little of the efforts of a joint in a record, each such reading of it is fitted
    too, and believed where it leaves far less. Questions about joints of which hardly anything is explained,
    however the log is read. Raises InputError with the question.
    """
    if any(p.record.input is None or p.record.arm is None for p in train):
        return Asked()
    fits = [_fit(p, model, evaluator) for p in train]
    known = [fit for fit in fits if fit is not None]
    questions = _hardly([p for p, fit in zip(train, fits, strict=True) if fit is not None], known)
    if len(train) < 2 or len(known) < len(train):
        return Asked(tuple(questions))
    return Asked(tuple(questions), np.sqrt(np.mean([fit.error**2 for fit in known], axis=0)))


def _fit(p: Prepared, model: Model, evaluator: Evaluator) -> Unexplained | None:
    """What a fit to a record leaves, None where it moves too little. Raises InputError with a question."""
    chosen, whole = p.settings, p.record
    enough = 2 * chosen.trimmed(whole.step) + ROWS * len(model.grouping.base) * chosen.factor
    record = whole.part(0, min(len(whole.t), enough))
    fit = unexplained(record, p, model, evaluator)
    if fit is None or not fit.poor.any():
        return fit
    total, found = float(np.sqrt(np.mean(fit.share**2))), []
    for reading in (*readings(record, fit), *amounts(record, fit, p, model, evaluator)):
        like = replace(p, settings=reading.settings(chosen))
        other = unexplained(reading.record, like, model, evaluator)
        # What leaves a joint at rest that moves explains nothing of it.
        if other is not None and not ((other.share == 0.0) & (fit.share > 0.0)).any():
            found.append((float(np.sqrt(np.mean(other.share**2))), reading.question))
    best, question = min(found, default=(math.inf, ""))
    if best < min(BETTER * total, POOR):
        # Of readings that explain hardly less nobody knows which is right.
        alike = [asked for left, asked in sorted(found) if left < min(BETTER * total, POOR, ALIKE * best)]
        also = "".join(f", or {asked}" for asked in alike if asked != question)
        raise InputError(
            f"{whole.name}: {question}{also}? Then {100 * best:.2g} % of the efforts are left unexplained, "
            f"as the log stands {100 * total:.2g} %; a mapping file (--mapping) says what each column is"
        )
    return fit


def _hardly(train: Sequence[Prepared], fits: Sequence[Unexplained]) -> list[Doubt]:
    """Questions about joints of whose efforts' changes hardly anything is explained that is not noise.

    fits: of each record. What is little in one record beside others is asked of all of them.
    """
    if not fits:
        return []
    parts = ((fit.error, fit.changes, fit.noise, fit.repeats) for fit in fits)
    error, changes, noise, repeats = (
        np.sqrt(np.mean([x**2 for x in part], axis=0)) for part in zip(*parts, strict=True)
    )
    first, questions = train[0].record, list[Doubt]()
    assert first.arm is not None
    for j, name in enumerate(first.arm.coordinate_names):
        share = error[j] / max(changes[j], 1e-300)
        if not changes[j] or error[j] <= FAR * noise[j]:
            continue
        if share <= HARDLY:
            continue
        if error[j] <= ANEW * repeats[j]:
            text = (
                f"Of the changes of the effort of {name}, {100 * min(share, 1.0):.0f} % differ from one "
                "period of the motion to the next: is its sensor that noisy, its column what it is read as?"
            )
            questions.append(Doubt(text, [name]))
            continue
        logged = [x[p.awake[:, j], j] for p in train if (x := p.record.logged_effort) is not None]
        moving = np.concatenate(logged)
        one_side = len(moving) > 0 and 0.0 <= moving.min() < ZERO * moving.max()
        lost = f" They are never below {moving.min():.3g}: is their sign lost?" if one_side else ""
        text = (
            f"The model leaves {100 * min(share, 1.0):.0f} % of the changes of the effort of {name} "
            "unexplained: are its columns what they are read as, and what does the description lack"
            f"{DIAGNOSING}?{lost}"
        )
        questions.append(Doubt(text, [name]))
    return questions


def disagreeing(train: Sequence[Prepared], alone: Array | None, together: Array) -> list[str]:
    """The question about joints of which fits to each record alone leave far less than one to all.

    alone, together: RMS (n,) of the inputs that they leave, through the filter.
    """
    if alone is None or train[0].record.arm is None:
        return []
    said = []
    for j, name in enumerate(train[0].record.arm.coordinate_names):
        efforts = np.concatenate([p.effort[p.moving[:, j], j] for p in train])
        size = float(np.sqrt(np.mean(efforts**2))) if len(efforts) else 0.0
        one, all_ = (100.0 * float(x[j]) / max(size, 1e-300) for x in (alone, together))
        if all_ > max(APART * one, NOTABLE):
            said.append(
                f"The training records disagree at {name}: fitted each alone, {one:.2g} % of the effort is "
                f"left unexplained, together {all_:.2g} %. Are they of one arm, with the same units, signs "
                "and zeros, and what changes between them?"
            )
    return said
