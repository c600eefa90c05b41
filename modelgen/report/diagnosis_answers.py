"""The first screen of a diagnosis: what is missing, how sure that is, what it is worth, what to do next."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from modelgen.charts import apart, number
from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.result import Diagnosis
from modelgen.report.call import Call
from modelgen.report.cause_parts import marks
from modelgen.report.complete import complete
from modelgen.report.diagnosis_sentences import (
    SWINGING,
    beside,
    by_worth,
    cause_title,
    doubted,
    efforts_of,
    harmful,
    harms,
    interval,
    missing,
    no_arm,
    reason,
    remains,
    worth,
)
from modelgen.report.following import following
from modelgen.report.opening import hardly_moved
from modelgen.report.others import near, suspected
from modelgen.report.page import Checks, Command, Folded, Grid, Part, Run, Section, Text
from modelgen.report.words import joint_name, listed, sentence

_OVER_ALL = (
    "Over all joints each counts alike: it is the root mean square of what is left of each joint's error, so "
    "one joint of four without its error is 13 % less over all."
)
# By whether the test record is a free motion.
_ERRORS = {
    True: "RMSE of the simulated free motion, from the release on,",
    False: "RMS of the error, beside that of the effort,",
}
_CHECKS = "Checks of each cause"
_ROWS = 2  # of a table that a phone has room for beside the other answers
_SHOWN = 4  # causes in full: more would leave the other answers no place on the first screen
_SUSPECTS = 1  # in full, where nothing is named


def answers(d: Diagnosis, call: Call) -> list[Section]:
    """The four questions with their answers. call: how they were asked, with the folder of the report."""
    return [
        Section("What is missing", list(_missing(d))),
        Section("How sure", list(_sure(d))),
        Section("What it is worth", list(_worth(d))),
        Section("What to do next", list(_next(d, call))),
    ]


def _missing(d: Diagnosis) -> Iterator[Part]:
    if not d.causes:
        yield Text([Run(text, "strong") for text in missing(d)])
        if reason(d) and not d.suspects:
            yield Text(reason(d))
        yield from (Text([Run(text, "strong")]) for text in no_arm(d))
        return
    order, texts = by_worth(d), missing(d)
    said = [Text([Run(texts[k], "strong"), Run(" "), _linked(d.causes[k].effect)]) for k in order]
    yield from said[:_SHOWN]
    if said[_SHOWN:]:
        yield Folded(f"And {len(said) - _SHOWN} more", said[_SHOWN:])


def _linked(effect: str) -> Run:
    return Run(effect, "quiet", f"#about-{effect}")


def _names(d: Diagnosis, causes: Sequence[NamedCause]) -> str:
    return listed(cause_title(d, c) for c in causes)


def _sure(d: Diagnosis) -> Iterator[Part]:
    if rests := hardly_moved(d):
        yield Text(rests)
    checks = complete(d)
    if checks is not None:
        yield checks
    if len(d.causes) == 1:
        yield marks(d.causes[0], "cause0")
    elif d.causes:
        rows = [
            (
                cause_title(d, d.causes[k]),
                f"#cause{k}",
                marks(d.causes[k], f"mark{k}"),
            )
            for k in by_worth(d)
        ]
        table = Checks(_CHECKS, rows)
        yield Folded(_CHECKS, [table], narrow=True) if len(rows) > _ROWS else table
        yield Text([Run(_passed(d.causes)), *_doubted(d)])
    if len(d.causes) == 1 and doubted(d):
        yield Text(_doubted(d))
    if d.free and d.causes:
        yield Text(SWINGING, "quiet")
    if rival := near(d):
        yield Text(rival)
    suspects = [_suspect(d, k) for k in range(len(d.suspects))]
    shown = 0 if d.causes else _SUSPECTS
    for parts in suspects[:shown]:
        yield from parts
    if suspects[shown:]:
        title = "And suspected too" if shown else "Suspected, and not named"
        names = _names(d, d.suspects[shown:])
        yield Folded(f"{title}: {names}", [part for parts in suspects[shown:] for part in parts])
    if not d.causes:
        left = Text(remains(d))
        yield Folded(_left(d), [left], narrow=True) if d.suspects else left
        return
    left = Text(f"{beside(d)} {remains(d)}".strip(), "quiet")
    yield Folded(_left(d), [left], narrow=True) if len(d.causes) > 1 else left


def _left(d: Diagnosis) -> str:
    """Title of what is left, which says whether that is more than noise."""
    f = d.lack_of_fit
    if f is None:
        return "What is left: no period repeats, by which the noise could be measured"
    what = "more than noise" if f.statistic > f.threshold else "no more than noise"
    return f"What is left: {what}, lack of fit {f.statistic:z.2f}, threshold {f.threshold:z.2f}"


def _passed(causes: Sequence[NamedCause]) -> str:
    others = dict.fromkeys(c.name for cause in causes for c in cause.checks if not c.decides)
    every = "Both" if len(causes) == 2 else f"All {len(causes)}"
    return f"{every} passed the checks that decide; {listed(others)} decide nothing. "


def _doubted(d: Diagnosis) -> list[Run]:
    return [Run(" ".join(doubted(d)), "strong")]


def _suspect(d: Diagnosis, k: int) -> list[Part]:
    c = d.suspects[k]
    title = cause_title(d, c)
    checks = listed(x.name for x in c.checks if x.decides and x.passed is False)
    text = f"{suspected(d, c)}{title} has evidence, and is not named: it failed {checks}."
    return [Text(text), marks(c, f"suspect{k}")]


def _worth(d: Diagnosis) -> Iterator[Part]:
    unit, caption = d.errors.unit, "Error on the test record by joint"
    if d.causes:
        yield Text(sentence(worth(d)))
        yield from _warned(d)
        heads = (
            ("joint", "left"),
            (f"before [{unit}]", "right"),
            (f"after [{unit}]", "right"),
            ("less % (95 %)", "right"),
        )
        errors = Grid(caption, heads, _gains(d), beside=True)
        many = len(d.causes) > 1 or len(errors.rows) > _ROWS
        yield Folded(caption, [errors], narrow=True) if many else errors
    else:
        yield Text(_erring(d))
        rows = [(joint_name(d.arm, j), x) for j, x in enumerate(_before(d), 1)]
        table = Grid(caption, (("joint", "left"), (f"error [{unit}]", "right")), rows, beside=True)
        yield Folded(caption, [table], narrow=True)
    known = bool(np.isfinite(d.errors.low).any())
    how = "; intervals from a block bootstrap" if known else "; the record is too short for intervals"
    how = how if d.causes else ""
    measured = _ERRORS[d.free]
    said = f"{measured} on the test record, which nothing of the choice or the fit has seen{how}."
    if d.causes and len(d.errors.gain) > 1:
        said += f" {_OVER_ALL}"
    yield Folded("How the error was measured", [Text(said, "quiet")], narrow=True)


def _erring(d: Diagnosis) -> str:
    """How large the error of the model as described is, at the joint where it is largest."""
    before, names, efforts = d.errors.before, d.arm.coordinate_names, efforts_of(d)
    known = np.nan_to_num(before if efforts is None else before / np.maximum(efforts, 1e-300))
    j = int(np.argmax(known))
    size = (
        f"{number(before[j])} {d.errors.unit}"
        if efforts is None
        else f"{number(100.0 * known[j], 2)} % of the effort"
    )
    most = "" if len(before) == 1 else ", its largest error"
    return f"No cause is named. The model as described errs on the test record by {size} at {names[j]}{most}."


def _before(d: Diagnosis) -> list[tuple[str, str]]:
    """Error of every joint, and small the effort that it is of."""
    efforts = efforts_of(d) or [np.nan] * len(d.errors.before)
    return [
        (number(x), "" if np.isnan(effort) else f"of {number(effort)}")
        for x, effort in zip(d.errors.before, efforts, strict=True)
    ]


def _warned(d: Diagnosis) -> Iterator[Part]:
    """Warnings about causes that make the test record worse; of several their names alone, unless asked."""
    texts = [Text([Run(text, "strong")]) for text in harms(d)]
    if len(texts) > 1:
        yield Folded(f"The error on the test record is larger with {_names(d, harmful(d))}", texts)
    else:
        yield from texts


def _next(d: Diagnosis, call: Call) -> Iterator[Part]:
    steps = following(d, call)
    alone = [Text(step.text) for step in steps if not (step.command or step.mends or step.warns)]
    for step in steps:
        if step.mends or step.warns:
            yield Text([Run(step.text, "strong")] if step.mends else step.text)
        elif step.command:
            yield Text(step.text)
            yield Command(step.command)
    if len(alone) > 1:
        yield Folded("Experiments that show each effect by itself", alone)
    else:
        yield from alone


def _gains(d: Diagnosis) -> list[tuple[str, tuple[str, str], str, tuple[str, str]]]:
    e = d.errors
    return [
        (
            joint_name(d.arm, j + 1),
            (value, of),
            after,
            (f"{e.gain[j]:z.1f}", interval(e.low[j], e.high[j], "({})")),
        )
        for j, (_, of) in enumerate(_before(d))
        for value, after in [apart(e.before[j], e.after[j])]
    ]
