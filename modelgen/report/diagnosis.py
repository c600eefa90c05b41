"""The report of a diagnosis: one HTML file with its pictures inside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.result import Diagnosis
from modelgen.diagnosis.selection import COARSE, EXCHANGED, STANDS_IN, SUPERFLUOUS, SUSPECT, Ranked
from modelgen.effects import CATALOGUE
from modelgen.report.diagnosis_figures import effort, inline, left_over, replayed, residuals
from modelgen.report.diagnosis_sentences import (
    assumptions,
    checked,
    compared,
    harms,
    place_of,
    suspicions,
    unnamed,
    worth,
)
from modelgen.report.experiment import described, picture
from modelgen.report.figures import Sketch
from modelgen.report.named_joints import named_joints
from modelgen.resources import templates_folder

EFFORT, LEFT_OVER, REPLAY, NEXT = "effort", "left over", "replay", "next experiment"
AGAINST = "left over against "


def sketches(d: Diagnosis) -> dict[str, Sketch]:
    """Sketches of all pictures, by name."""
    found = {EFFORT: effort(d)}
    found |= {AGAINST + name: sketch for name, sketch in residuals(d).items()}
    replay = replayed(d)
    if replay is not None:
        found[REPLAY] = replay
    if d.next_experiment is not None and d.next_experiment.proposal is not None:
        found[NEXT] = picture(d.next_experiment)
    return {**found, LEFT_OVER: left_over(d)}


def pictures(drawn: Mapping[str, str]) -> dict[str, str]:
    """Pictures of the report that stand alone, by file name."""
    return {"effort.svg": drawn[EFFORT], "left_over.svg": drawn[LEFT_OVER]}


def report(d: Diagnosis, drawn: Mapping[str, str] | None = None) -> str:
    """HTML that needs nothing beside it. drawn: SVG text of `sketches` by name, drawn here by default."""
    if drawn is None:
        drawn = {name: sketch.drawn() for name, sketch in sketches(d).items()}
    environment = Environment(
        loader=FileSystemLoader(templates_folder()),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    template = environment.get_template("report/diagnosis.html.j2")
    free = d.test.prepared.input is None
    text: str = template.render(
        arm=d.arm.name,
        verdict=d.verdict,
        sentence=_sentence(d),
        arm_drawing=named_joints(d),
        reason=d.reason,
        causes=[_cause(d, k) for k in range(len(d.causes))],
        harms=harms(d),
        suspicions=suspicions(d),
        assumptions=[*assumptions(d), *compared(d)],
        fit=_fit(d),
        errors=_errors(d),
        unit=d.errors.unit,
        simulation=_simulation(d),
        effort_picture=inline(drawn[EFFORT]),
        residual_pictures=[
            (name.removeprefix(AGAINST), inline(text))
            for name, text in drawn.items()
            if name.startswith(AGAINST)
        ],
        replay_picture=inline(drawn[REPLAY]) if REPLAY in drawn else Markup(),
        ranking=_rankings(d),
        error_text=_ERRORS[free],
        simulation_text=_SIMULATED[free],
        parameters=[(name, f"{e.value:.6g}", f"{e.std:.2g}", e.unit) for name, e in d.parameters.items()],
        missing=d.not_identifiable,
        experiment=described(d.next_experiment, drawn.get(NEXT, "")),
        log=d.log.lines(),
        settings=[(name, _said(value)) for name, value in d.settings.items()],
    )
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


# By whether the test record is a free motion.
_ERRORS = {
    True: "RMSE of the simulated free motion, from the release on,",
    False: "RMSE of the effort",
}
_SIMULATED = {
    True: "The test record simulated from its release on",
    False: "Windows of the test record simulated from their measured initial states with the measured inputs",
}


def _sentence(d: Diagnosis) -> Markup:
    if d.verdict != "named":
        return Markup(unnamed(d))
    found = [Markup("<b>{}</b> at {}").format(c.effect, place_of(c.joint)) for c in d.causes]
    return Markup("The model lacks {}: {}.").format(Markup(" and ").join(found), worth(d))


# Why a candidate was not taken, by the gate that stayed shut, or taken back.
_REFUSED = {
    "evidence": "too little evidence",
    "values": "values that the effect cannot have",
    "gain": "gains too little on records that its fit has not seen",
    "positions": "gains no more than errors of the positions could feign",
    "other joints": "makes other joints worse",
    "one joint": "does more at one joint alone",
    "near rest": "its exponent is the least that is searched: friction near rest, for which there is a law",
    EXCHANGED: "taken, then exchanged: another one explains more with all values found anew",
    SUPERFLUOUS: "taken, then superfluous beside the others",
    STANDS_IN: "taken, then taken back: it stands in for something that the catalogue lacks",
    SUSPECT: "taken, then taken back: it failed a check, see the suspects",
    COARSE: "taken, then taken back: the positions are too coarse to tell it from others",
}
_SHOWN = 12  # candidates of a turn


def _rankings(d: Diagnosis) -> list[tuple[str, list[Sequence[str]]]]:
    """Heading and rows of every turn that had candidates."""
    headings = ["Candidates", *["Candidates, with what was taken before"] * len(d.ranking)]
    ranked = zip(headings, map(_ranked, d.ranking), strict=False)
    return [(heading, rows) for heading, rows in ranked if rows]


def _ranked(turn: Sequence[Ranked]) -> list[Sequence[str]]:
    """The candidates of one turn with their evidence, the losing ones too."""
    rows: list[Sequence[str]] = []
    for r in turn[:_SHOWN]:
        word = _REFUSED.get(r.refused, "taken" if r.taken else "passes every gate too")
        gains = ["" if g is None or np.isnan(g) else f"{g:.1f}" for g in (r.cross_gain, r.expected_gain)]
        rows.append((r.effect, place_of(r.joint), f"{r.delta_bic:.1f}", *gains, word))
    return rows


def _said(value: object) -> str:
    """A setting for a person."""
    if isinstance(value, list):
        return ", ".join(_said(v) for v in value)
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _cause(d: Diagnosis, k: int) -> dict[str, Any]:
    c = d.causes[k]
    return {
        "effect": c.effect,
        "text": CATALOGUE[c.effect].text,
        "place": place_of(c.joint),
        "parameters": [
            (n, f"{e.value:.4g}", "" if np.isnan(e.std) else f"{e.std:.2g}", e.unit)
            for n, e in c.parameters.items()
        ],
        "delta_bic": f"{c.delta_bic:.1f}",
        "gain": f"{c.cross_gain:.1f}",
        "expected": f"{c.expected_gain:.1f}",
        "share": _share(c),
        "aliases": ", ".join(f"{e} ({place_of(j)})" for e, j in c.aliases),
        "rivals": ", ".join(f"{e} ({place_of(j)}, {b:.1f} behind)" for e, j, b in c.ambiguous_with),
        "checks": [checked(check) for check in c.checks],
        "experiment": CATALOGUE[c.effect].experiment,
        "reference": CATALOGUE[c.effect].reference,
    }


def _share(c: NamedCause) -> str:
    """Effect of the cause on the error of the test record; empty where it is not known."""
    s = c.share
    if np.isnan(s.gain):
        return ""
    size, low, high, word = (
        (s.gain, s.low, s.high, "less") if s.gain >= 0 else (-s.gain, -s.high, -s.low, "more")
    )
    return f"{size:.1f} % {word} error on the test record than without it ({low:.1f} to {high:.1f} %)"


def _fit(d: Diagnosis) -> str:
    f = d.lack_of_fit
    if f is None:
        return "No period repeats in the training records, so the noise could not be measured."
    return (
        f"Lack of fit over {f.periods} repeated periods: {f.statistic:.2f}, threshold {f.threshold:.2f} "
        f"(1 for a complete model), {_where(d)}."
    )


def _where(d: Diagnosis) -> str:
    """Place of the part that repeats most."""
    f = d.lack_of_fit
    assert f is not None
    found = d.lack_of_fit_part
    joint = f"joint {f.worst.joint + 1}"
    return joint if found is None else f"{joint}, {found[0]} from {found[1]:.2f} to {found[2]:.2f} s"


def _errors(d: Diagnosis) -> list[Sequence[str]]:
    e = d.errors
    return [
        (
            str(j + 1),
            f"{e.before[j]:.4g}",
            f"{e.after[j]:.4g}",
            f"{e.gain[j]:.1f}",
            f"{e.low[j]:.1f} to {e.high[j]:.1f}",
        )
        for j in range(len(e.before))
    ]


def _simulation(d: Diagnosis) -> list[Sequence[str]]:
    one, two = d.simulation
    if one is None or two is None:
        return []
    return [
        (
            str(j + 1),
            f"{one.f_gof[j]:.2f}",
            f"{two.f_gof[j]:.2f}",
            f"{one.mae[j]:.3g}",
            f"{two.mae[j]:.3g}",
            f"{one.rmse[j]:.3g}",
            f"{two.rmse[j]:.3g}",
        )
        for j in range(len(one.f_gof))
    ]
