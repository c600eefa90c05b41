"""The report of a diagnosis: one HTML file with its pictures inside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from markupsafe import Markup

from modelgen.charts import number, sheet
from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.result import Diagnosis
from modelgen.diagnosis.validation import Check
from modelgen.effects import CATALOGUE
from modelgen.report.diagnosis_figures import efforts, replayed, residuals
from modelgen.report.diagnosis_sentences import (
    assumptions,
    checked,
    compared,
    harms,
    missing,
    remains,
    rivals,
    worth,
)
from modelgen.report.experiment import described
from modelgen.report.following import following
from modelgen.report.law_figures import judged_joint, law_charts, law_size
from modelgen.report.named_joints import named_joints
from modelgen.report.page import block, rendered
from modelgen.report.ranking import rankings
from modelgen.report.words import at, by_name, finding, joint_name, law, sentence

# By whether the test record is a free motion.
_ERRORS = {
    True: "RMSE of the simulated free motion, from the release on,",
    False: "RMSE of the effort",
}
_SIMULATED = {
    True: "The test record simulated from its release on",
    False: "Windows of the test record simulated from their measured initial states with the measured inputs",
}
_SHEET = ("speed", "position", "load (size of the effort)")  # of the residuals that stand in a file


def pictures(d: Diagnosis) -> dict[str, str]:
    """Pictures of the report that stand alone, by file name."""
    over = residuals(d)
    rows = [over[name][j] for j in range(len(d.arm.coordinates)) for name in _SHEET]
    return {"effort.svg": sheet(efforts(d), 2), "residuals.svg": sheet(rows, len(_SHEET))}


def report(d: Diagnosis) -> str:
    """HTML that needs nothing beside it."""
    free = d.test.prepared.input is None
    replay = replayed(d)
    return rendered(
        "diagnosis.html.j2",
        arm=d.arm.name,
        verdict=d.verdict,
        missing=missing(d),
        reason=sentence(by_name(d.arm, d.reason)),
        causes=[_cause(d, k) for k in range(len(d.causes))],
        suspects=[_as_shown(d, c, f"suspect{k}") for k, c in enumerate(d.suspects)],
        worth=sentence(worth(d)) if d.causes else "",
        following=following(d),
        arm_drawing=named_joints(d),
        harms=harms(d),
        assumptions=[*assumptions(d), *compared(d)],
        remains=remains(d),
        errors=_errors(d),
        unit=d.errors.unit,
        simulation=_simulation(d),
        efforts=block(efforts(d)),
        residuals=[(name, block(charts)) for name, charts in residuals(d).items()],
        replay=block(replay) if replay else None,
        rivals=rivals(d),
        rankings=rankings(d.arm, d.ranking),
        error_text=_ERRORS[free],
        simulation_text=_SIMULATED[free],
        parameters=[(name, f"{e.value:.6g}", f"{e.std:.2g}", e.unit) for name, e in d.parameters.items()],
        hidden=[(name, by_name(d.arm, why)) for name, why in d.not_identifiable],
        experiment=described(d),
        log=d.log.lines(),
        records=[
            (r["name"], r["use"], str(r["samples"]), f"{r['rate']:g}") for r in d.log.to_json()["records"]
        ],
        settings=[(name, _said(value)) for name, value in d.settings.items()],
    )


def _said(value: object) -> str:
    """A setting for a person."""
    if isinstance(value, list):
        return ", ".join(_said(v) for v in value)
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _cause(d: Diagnosis, k: int) -> dict[str, Any]:
    """A cause for the page, with its law over the data."""
    c = d.causes[k]
    size = law_size(d, k)
    said = ""
    if size is not None:
        where = d.arm.coordinate_names[judged_joint(d, k)]
        sizes = f"{number(size[0], 2)} of the {number(size[1], 2)} {size[2]}"
        said = f"Its size on the test record: {sizes} of {where} (RMS)."
    return _as_shown(d, c, f"cause{k}") | {"size": said, "charts": block(law_charts(d, k))}


def _as_shown(d: Diagnosis, c: NamedCause, key: str) -> dict[str, Any]:
    """What the page says of a cause or a suspect."""
    definition = CATALOGUE[c.effect]
    meanings = {p.name: p.text for p in definition.accepted()}
    return {
        "key": key,
        "effect": c.effect,
        "title": at(d.arm, c.effect, c.joint),
        "finding": sentence(finding(d.arm, c.effect, c.joint, c.parameters)),
        "text": sentence(definition.text),
        "law": law(c.effect),
        "parameters": [
            (
                n,
                f"{e.value:.4g}",
                "" if np.isnan(e.std) else f"{e.std:.2g}",
                "" if e.unit == "1" else e.unit,
                meanings.get(n, ""),
            )
            for n, e in c.parameters.items()
        ],
        "delta_bic": f"{c.delta_bic:.1f}",
        "gain": f"{c.cross_gain:.1f}",
        "expected": f"{c.expected_gain:.1f}",
        "share": _share(c),
        "marks": [_mark(d, check) for check in c.checks],
        "failed": [
            f"{x.name} ({by_name(d.arm, x.text)})" for x in c.checks if x.decides and x.passed is False
        ],
        "confused_with": ", ".join(definition.confused_with),
        "experiment": sentence(definition.experiment),
        "reference": definition.reference,
    }


def _mark(d: Diagnosis, c: Check) -> tuple[str, str, str, str]:
    """Sign, class, name and figures of a check."""
    name, _, text = checked(d.arm, c)
    sign, kind = ("–", "unasked") if c.passed is None else ("✓", "yes") if c.passed else ("✗", "no")
    if not c.decides:
        text += "; reported, decides nothing"
    return sign, kind, name, text


def _share(c: NamedCause) -> str:
    """Effect of the cause on the error of the test record; empty where it is not known."""
    s = c.share
    if np.isnan(s.gain):
        return ""
    size, low, high, word = (
        (s.gain, s.low, s.high, "less") if s.gain >= 0 else (-s.gain, -s.high, -s.low, "more")
    )
    return f"{size:.1f} % {word} error on the test record than without it ({low:.1f} to {high:.1f} %)"


def _errors(d: Diagnosis) -> list[Sequence[str]]:
    e = d.errors
    if not d.causes:
        return [(joint_name(d.arm, j + 1), number(e.before[j])) for j in range(len(e.before))]
    return [
        (
            joint_name(d.arm, j + 1),
            number(e.before[j]),
            number(e.after[j]),
            Markup("{} <small>({} to {})</small>").format(
                *(f"{x:.1f}" for x in (e.gain[j], e.low[j], e.high[j]))
            ),
        )
        for j in range(len(e.before))
    ]


def _simulation(d: Diagnosis) -> list[Sequence[str]]:
    one, two = d.simulation
    if one is None or two is None:
        return []
    return [
        (
            joint_name(d.arm, j + 1),
            f"{one.f_gof[j]:.2f}",
            f"{two.f_gof[j]:.2f}",
            f"{one.mae[j]:.3g}",
            f"{two.mae[j]:.3g}",
            f"{one.rmse[j]:.3g}",
            f"{two.rmse[j]:.3g}",
        )
        for j in range(len(one.f_gof))
    ]
