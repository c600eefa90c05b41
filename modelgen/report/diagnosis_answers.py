"""The first screen of a diagnosis: what is missing, how sure that is, what it is worth, what to do next."""

from __future__ import annotations

from collections.abc import Iterator

from modelgen.charts import number
from modelgen.diagnosis.result import Diagnosis
from modelgen.report.cause_parts import failed, found, marks
from modelgen.report.diagnosis_sentences import harms, interval, missing, remains, worth
from modelgen.report.following import following
from modelgen.report.page import Command, Grid, Part, Run, Section, Text
from modelgen.report.words import at, by_name, joint_name, sentence

# By whether the test record is a free motion.
_ERRORS = {
    True: "RMSE of the simulated free motion, from the release on,",
    False: "RMSE of the effort",
}
_NOTHING = "Nothing is named, so nothing is gained. The model as described misses, on the test record:"


def answers(d: Diagnosis) -> list[Section]:
    """The four questions with their answers."""
    return [
        Section("What is missing", list(_missing(d))),
        Section("How sure", list(_sure(d))),
        Section("What it is worth", list(_worth(d))),
        Section("What to do next", list(_next(d))),
    ]


def _missing(d: Diagnosis) -> Iterator[Part]:
    for k, text in enumerate(missing(d)):
        said = [Run(text, "strong")]
        if d.causes:
            effect = d.causes[k].effect
            said += [Run(" "), Run(effect, "quiet", f"#about-{effect}")]
        yield Text(said)
    if not d.causes and not d.suspects:
        yield Text(_reason(d))


def _sure(d: Diagnosis) -> Iterator[Part]:
    for k, c in enumerate(d.causes):
        if len(d.causes) > 1:
            yield Text(at(d.arm, c.effect, c.joint))
        yield marks(d, c, f"cause{k}")
    for k, c in enumerate(d.suspects):
        title = at(d.arm, c.effect, c.joint)
        yield Text(f"{found(d, c)} {title} is suspected and not named, for want of: {failed(d, c)}.")
        yield marks(d, c, f"suspect{k}")
    yield Text(f"{_reason(d)} {remains(d)}", "quiet") if d.causes else Text(remains(d))


def _worth(d: Diagnosis) -> Iterator[Part]:
    unit, caption = d.errors.unit, "Error on the test record by joint"
    if d.causes:
        yield Text(sentence(worth(d)))
        for text in harms(d):
            yield Text([Run(text, "strong")])
        heads = (
            ("joint", "left"),
            (f"before [{unit}]", "right"),
            (f"after [{unit}]", "right"),
            ("less % (95 %)", "right"),
        )
        yield Grid(caption, heads, _gains(d))
    else:
        before = [(joint_name(d.arm, j), number(x)) for j, x in enumerate(d.errors.before, 1)]
        yield Text(_NOTHING)
        yield Grid(caption, (("joint", "left"), (f"error [{unit}]", "right")), before)
    how = "; intervals from a block bootstrap" if d.causes else ""
    measured = _ERRORS[d.test.prepared.input is None]
    yield Text(
        f"{measured} on the test record, which nothing of the choice or the fit has seen{how}.", "quiet"
    )


def _next(d: Diagnosis) -> Iterator[Part]:
    for step in following(d):
        yield Text(step.text)
        if step.command:
            yield Command(step.command)


def _reason(d: Diagnosis) -> str:
    return sentence(by_name(d.arm, d.reason))


def _gains(d: Diagnosis) -> list[tuple[str, str, str, tuple[str, str]]]:
    e = d.errors
    return [
        (
            joint_name(d.arm, j + 1),
            number(e.before[j]),
            number(e.after[j]),
            (f"{e.gain[j]:.1f}", interval(e.low[j], e.high[j], "({})")),
        )
        for j in range(len(e.before))
    ]
