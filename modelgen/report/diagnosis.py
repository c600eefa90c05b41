"""The report of a diagnosis: one HTML file with its pictures inside."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from modelgen.charts import known, sheet
from modelgen.diagnosis.result import Diagnosis
from modelgen.report.call import Call
from modelgen.report.cause_parts import about, law_found, suspected
from modelgen.report.diagnosis_answers import answers
from modelgen.report.diagnosis_figures import WINDOWS, efforts, replayed, residuals
from modelgen.report.diagnosis_sentences import SWINGING, assumptions, by_worth, compared
from modelgen.report.experiment import described
from modelgen.report.following import RESIDUALS
from modelgen.report.named_joints import named_joints
from modelgen.report.others import rivals
from modelgen.report.page import Folded, Grid, Heading, Lines, Part, Run, Section, Text, block, page
from modelgen.report.ranking import rankings
from modelgen.report.records import records_table
from modelgen.report.words import joint_name
from modelgen.simulation.windows import Windows

_FINER = (
    "modelgen simulate --log with --window {window:g} takes finer steps, and begins its windows at the first "
    "sample of the log, which is left out here: its errors differ a little from these."
)
# By whether the test record is a free motion.
_SIMULATED = {
    True: "The test record simulated from its release on",
    False: "Windows of the test record simulated from their measured initial states with the measured inputs",
}
_FIT = (
    "goodness of fit 100 (1 - |y - y\N{COMBINING CIRCUMFLEX ACCENT}| / |y - mean y|), mean absolute error "
    "and RMSE in"
)
_SHEET = ("speed", "position", "load (size of the effort)")  # of the residuals that stand in a file
_RIVALS = (("cause", "left"), ("rival", "left"), ("why not", "left"))
_GAPS = "Gaps: the joint rests there, or the record begins or ends; that is not judged."
_NO_RIVALS = "None: no other candidate explains what a cause does nearly as well."
_CANDIDATES = (
    ("effect", "left"),
    ("place", "left"),
    ("delta BIC", "right"),
    ("unseen %", "right"),
    ("expected %", "right"),
    ("answer", "left"),
)
_SOME = 0.05  # of a record, that need not be mentioned
_PARAMETERS = (("parameter", "left"), ("value", "right"), ("std", "right"), ("unit", "left"))
_SETTINGS = {
    "asked": "effects asked for",
    "train": "training records",
    "test": "test record",
    "cutoff_hz": "cut-off of effort and regressor [Hz]",
    "position_cutoff_hz": "cut-off of the positions [Hz]",
    "factor": "samples of the log for one row",
    "simulated_window_s": "length of a simulated window, but of free motions [s]",
    "rest_speeds": "speeds below which a joint rests [rad/s, m/s]",
    "period_s": "periods of the training records [s]",
    "evidence_threshold": "least evidence of a cause [delta BIC]",
    "practical_gain_percent": "least gain of a cause [% of the RMSE]",
}


def pictures(d: Diagnosis) -> dict[str, str]:
    """Pictures of the report that stand alone, by file name."""
    over = residuals(d)
    rows = [over[name][j] for j in range(len(d.arm.coordinates)) for name in _SHEET]
    return {"effort.svg": sheet(efforts(d), 2), "residuals.svg": sheet(rows, len(_SHEET))}


def report(d: Diagnosis, folder: Path | None = None, call: Call | None = None) -> str:
    """HTML that needs nothing beside it.

    folder: that it is written into, as modelgen was given it. call: how the diagnosis was asked for.
    """
    asked = answers(d, replace(call or Call(d.arm), folder=folder or Path()))
    return page(f"{d.arm.name}: what its model lacks", "Diagnosis", asked, list(_sections(d)))


def _sections(d: Diagnosis) -> Iterator[Section]:
    drawing = named_joints(d)
    if drawing:
        what = "named" if d.causes else "suspected"
        title = f"The arm, to turn and move, with the joints at which something is {what}"
        yield Section("", [Folded(title, [drawing], screen=True)])
    yield from (law_found(d, k) for k in by_worth(d))
    yield from _others(d)
    experiment = described(d)
    if experiment:
        yield Section("Next experiment", experiment)
    yield Section("The log, and what is assumed about it", _log(d))
    whole: list[Part] = [block(efforts(d)), _over_abscissae(d)]
    rests = [] if d.test.moving.all() else [Text(_GAPS)]
    yield Section("Measured against predicted, the whole test record", [*rests, *whole])
    motion = _simulation(d)
    if motion:
        yield Section("Simulated motion", motion)
    yield Section("Parameters, settings and files", _files(d))
    yield from about(d)


def _others(d: Diagnosis) -> Iterator[Section]:
    """Rivals, suspects, and every candidate of every turn below the last of them."""
    against, turns = rivals(d), rankings(d.arm, d.ranking)
    found: list[Section] = []
    if against or (turns and not d.suspects):
        title = "Rivals, and why not" if d.causes else "What was tried"
        said: list[Part] = [Grid("Rivals", _RIVALS, against, folds=True)] if against else []
        found.append(Section(title, said or ([Text(_NO_RIVALS)] if d.causes else [])))
    if d.suspects:
        parts = [part for k in range(len(d.suspects)) for part in suspected(d, k)]
        found.append(Section("Suspects", parts))
    if turns:
        parts = []
        for heading, rows in turns:
            parts += [Heading(heading), Grid(heading, _CANDIDATES, rows)]
        last = found.pop()
        folded = Folded("The candidates, and what became of each", parts, printed=False)
        found.append(last._replace(parts=[*last.parts, folded]))
    yield from found


def _log(d: Diagnosis) -> list[Part]:
    hidden = [f"{name}: {why}" for name, why in d.not_identifiable]
    above = (SWINGING,) if d.causes else ()  # on the first screen already
    assumed = [text for text in assumptions(d) if text not in above]
    said: list[Part] = [Lines([*d.log.lines(), *assumed, *compared(d)])]
    return [*said, Heading("What these records cannot show"), Lines(hidden)] if hidden else said


def _over_abscissae(d: Diagnosis) -> Folded:
    parts: list[Part] = [Text("Means over bins of the test record.")]
    over = residuals(d)
    if len(d.arm.coordinates) == 1:  # one beside the other, each with what it is over as its title
        parts.append(block([replace(chart, title=f"over {name}") for name, (chart,) in over.items()]))
        return Folded(RESIDUALS, parts)
    for name, charts in over.items():
        parts += [Heading(f"Over {name}"), block(charts)]
    return Folded(RESIDUALS, parts)


def _simulation(d: Diagnosis) -> list[Part]:
    one, two = d.simulation
    if one is None or two is None:
        return []
    models = (("before", one), ("after", two)) if d.causes else (("", one),)
    heads = [("joint", "left")]
    scores = [f"{score} {when}".rstrip() for score in ("F_gof", "MAE", "RMSE") for when, _ in models]
    heads += [(score, "right") for score in scores]
    rows = [
        (
            joint_name(d.arm, j + 1),
            *(_fit(x.f_gof[j]) for _, x in models),
            *(f"{x.mae[j]:z.3g}" for _, x in models),
            *(f"{x.rmse[j]:z.3g}" for _, x in models),
        )
        for j in range(len(one.f_gof))
    ]
    fit = f"{_FIT} {' or '.join(sorted(set(d.arm.coordinate_units), reverse=True))}"
    text = f"{_SIMULATED[d.free]}: {fit}{', before and after' if d.causes else ''}. {_covered(d, one)}"
    parts: list[Part] = [Text(text.rstrip()), Grid("Simulated motion", heads, rows, folds=True)]
    if not d.free:
        again = _FINER.format(window=d.settings["simulated_window_s"])
        parts.append(Text(again, "quiet unprinted"))  # about a command that is copied from the screen
    return [*parts, block(replayed(d))]


def _covered(d: Diagnosis, simulated: Windows) -> str:
    """How much of the record was simulated, and how much of that is drawn."""
    t = d.test.prepared.t
    whole = float(t[-1] - t[0])
    count, part = len(simulated.t), float(np.sum(simulated.t[:, -1] - simulated.t[:, 0]))
    said = []
    if count > WINDOWS and not d.free:
        said.append(f"The first {WINDOWS} of {count} windows are drawn.")
    if part < (1.0 - _SOME) * whole:
        said.append(
            f"Simulated are {part:z.3g} s of the record's {whole:z.3g} s: modelgen simulate --log counts the "
            "rest too, and its errors are others."
        )
    return " ".join(said)


def _fit(percent: float) -> str:
    """A goodness of fit, short also where the simulated motion runs away."""
    return f"{percent:z.2f}" if abs(percent) < 1e5 else f"{percent:.0e}"


def _files(d: Diagnosis) -> list[Part]:
    unknown = "held" if d.free else "not known"  # what the records do not show
    values = [
        (name, known(e.value, e.std), unknown if np.isnan(e.std) else f"{e.std:z.2g}", e.unit)
        for name, e in d.parameters.items()
    ]
    settings = [(_SETTINGS.get(name, name), _said(value)) for name, value in d.settings.items()]
    extended, identified = f"{d.arm.name}_extended.yaml", f"{d.arm.name}_parameters.yaml"
    beside = [
        Run("Beside this page: "),
        Run("diagnosis.json", target="diagnosis.json"),
        Run(" has all of it as data, verdict "),
        Run(d.verdict, "code"),
        Run("; "),
        Run(extended, target=extended),
        Run(f" is the description{' with the causes' if d.causes else ''}, "),
        Run(identified, target=identified),
        Run(" its parameters; "),
        Run("effort.svg", target="effort.svg"),
        Run(" and "),
        Run("residuals.svg", target="residuals.svg"),
        Run(" are pictures."),
    ]
    model = "extended model" if d.causes else "model"
    tables = [
        records_table(d.log.recorded()),
        Grid("Settings", (("setting", "left"), ("value", "left")), settings),
    ]
    return [
        Folded(f"Parameters of the {model}", [Grid("Parameters", _PARAMETERS, values, long=True)]),
        Folded("Records and settings", tables),
        Text(beside),
    ]


def _said(value: object) -> str:
    """A setting for a person."""
    if isinstance(value, list):
        return ", ".join(_said(v) for v in value)
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
