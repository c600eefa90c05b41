"""The report of a diagnosis: one HTML file with its pictures inside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.description import DirectDrive, LeveredDrive
from modelgen.diagnosis.objects import Diagnosis
from modelgen.diagnosis.rows import Array
from modelgen.diagnosis.selection import Ranked
from modelgen.effects import CATALOGUE
from modelgen.figures import COLOURS, figure, svg
from modelgen.resources import templates_folder

DRIVEN = (DirectDrive, LeveredDrive)
_WINDOWS = 12  # that the picture of the simulation shows
_SECONDS = 10.0  # of the test record that the pictures over time show


def pictures(d: Diagnosis) -> dict[str, str]:
    """Pictures of the report that stand alone, by file name."""
    return {"effort.svg": _effort(d)}


def report(d: Diagnosis) -> str:
    """HTML that needs nothing beside it."""
    environment = Environment(
        loader=FileSystemLoader(templates_folder()),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    template = environment.get_template("report/diagnosis.html.j2")
    text: str = template.render(
        arm=d.arm.name,
        verdict=d.verdict,
        sentence=_sentence(d),
        reason=d.reason,
        causes=[_cause(d, k) for k in range(len(d.causes))],
        fit=_fit(d),
        errors=_errors(d),
        unit=d.errors.unit,
        simulation=_simulation(d),
        effort_picture=_over_time(d),
        residual_pictures=_residuals(d),
        replay_picture=_replay(d),
        ranking=[_ranked(turn) for turn in d.selection.turns],
        free=d.test.prepared.input is None,
        parameters=[(name, f"{e.value:.6g}", f"{e.std:.2g}", e.unit) for name, e in d.parameters.items()],
        missing=d.not_identifiable,
        experiment=d.next_experiment,
        settings=[(name, _said(value)) for name, value in d.settings.items()],
    )
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


_SENTENCES = {
    "nothing_missing": "Nothing is missing that these records could show.",
    "outside_catalogue": "Something is missing that is not in the catalogue.",
    "cannot_tell": "These records cannot tell.",
}


def _sentence(d: Diagnosis) -> Markup:
    if d.verdict != "named":
        return Markup(_SENTENCES[d.verdict])
    found = [Markup("<b>{}</b> at {}").format(c.effect, _place(c.joint)) for c in d.causes]
    return Markup("The model lacks {}.").format(Markup(" and ").join(found))


# Why a candidate was not taken, by the gate that stayed shut.
_REFUSED = {
    "evidence": "too little evidence",
    "values": "values that the effect cannot have",
    "gain": "gains too little on records that its fit has not seen",
    "positions": "gains no more than errors of the positions could feign",
    "other joints": "makes other joints worse",
}
_SHOWN = 12  # candidates of a turn


def _ranked(turn: Sequence[Ranked]) -> list[Sequence[str]]:
    """The candidates of one turn with their evidence, the losing ones too."""
    rows: list[Sequence[str]] = []
    taken = False
    for r in turn[:_SHOWN]:
        word = _REFUSED.get(r.refused, "passes every gate too" if taken else "taken")
        taken = taken or not r.refused
        gain = "" if r.cross_gain is None else f"{r.cross_gain:.1f}"
        rows.append((r.effect, _place(r.joint), f"{r.delta_bic:.1f}", gain, word))
    return rows


def _said(value: object) -> str:
    """A setting for a person."""
    if isinstance(value, list):
        return ", ".join(_said(v) for v in value)
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _place(joint: int | None) -> str:
    return "the whole arm" if joint is None else f"joint {joint}"


def _cause(d: Diagnosis, k: int) -> dict[str, Any]:
    c = d.causes[k]
    return {
        "effect": c.effect,
        "text": CATALOGUE[c.effect].text,
        "place": _place(c.joint),
        "parameters": [
            (n, f"{e.value:.4g}", "" if np.isnan(e.std) else f"{e.std:.2g}", e.unit)
            for n, e in c.parameters.items()
        ],
        "delta_bic": f"{c.delta_bic:.1f}",
        "gain": f"{c.cross_gain:.1f}",
        "aliases": ", ".join(f"{e} ({_place(j)})" for e, j in c.aliases),
        "rivals": ", ".join(f"{e} ({_place(j)}, {b:.1f} behind)" for e, j, b in c.ambiguous_with),
        "experiment": CATALOGUE[c.effect].experiment,
        "reference": CATALOGUE[c.effect].reference,
    }


def _fit(d: Diagnosis) -> str:
    f = d.lack_of_fit
    if f is None:
        return "No period repeats in the training records, so the noise could not be measured."
    return (
        f"Lack of fit over {f.periods} repeated periods: {f.statistic:.2f}, threshold {f.threshold:.2f} "
        "(1 for a complete model)."
    )


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


def _over_time(d: Diagnosis) -> Markup:
    return _inline(_effort(d))


def _effort(d: Diagnosis) -> str:
    """Measured and predicted effort, and what is left, over the first seconds of the test record."""
    held, t = d.test, d.test.prepared.t
    shown = t <= t[0] + _SECONDS
    n = held.effort.shape[1]
    made, axes = figure(n, 2, (9.0, 1.9 * n))
    measured = held.effort * held.gain
    free = held.prepared.input is None
    units = _units(d)
    for j in range(n):
        before, after = (measured - r for r in d.residuals)
        left, right = axes[j]
        left.plot(t[shown], measured[shown, j], color="#999999", label="of the links" if free else "measured")
        left.plot(t[shown], before[shown, j], color=COLOURS[0], label="model as described")
        if d.causes:
            left.plot(t[shown], after[shown, j], color=COLOURS[1], label="extended model")
        left.set_ylabel(f"joint {j + 1} [{units[j]}]")
        right.plot(t[shown], d.residuals[0][shown, j], color=COLOURS[0], linewidth=0.8)
        if d.causes:
            right.plot(t[shown], d.residuals[1][shown, j], color=COLOURS[1], linewidth=0.8)
        right.set_ylabel("left over")
    axes[0, 0].legend(loc="upper right", fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return svg(made)


def _units(d: Diagnosis) -> list[str]:
    """Of the efforts that are left over, by joint."""
    if d.test.prepared.input is not None:
        return list(d.test.prepared.effort_unit) or ["A"] * len(d.arm.coordinates)
    joints = [d.arm.joints[i] for i in d.arm.coordinates]
    forces = ["N" if j.type == "prismatic" else "N m" for j in joints]
    return ["A" if isinstance(j.drive, DRIVEN) else u for j, u in zip(joints, forces, strict=True)]


def _residuals(d: Diagnosis) -> list[tuple[str, Markup]]:
    """What is left over against speed, position, load, motor angle and time, before and after."""
    held, p = d.test, d.test.prepared
    n = held.effort.shape[1]
    load = np.abs(held.effort * held.gain)
    against: list[tuple[str, Array]] = [
        ("joint velocity", p.picked(p.dq)),
        ("joint position", p.picked(p.q)),
        ("size of the effort", load),
        ("motor position", p.picked(p.motor)),
        ("time [s]", np.tile(p.t[:, None], (1, n))),
    ]
    if p.temperature is not None:
        against.append(("temperature [deg C]", p.picked(p.temperature)))
    pictures = []
    for name, x in against:
        made, axes = figure(1, n, (max(3.0, min(9.0, 3.0 * n)), 2.0))
        for j in range(n):
            m = held.moving[:, j]
            for k, r in enumerate(d.residuals[: 2 if d.causes else 1]):
                centre, mean = _binned(x[m, j], r[m, j], 120 if name == "motor position" else 24)
                axes[0, j].plot(centre, mean, color=COLOURS[k], marker=".", markersize=3)
            axes[0, j].axhline(0.0, color="#999999", linewidth=0.6)
            axes[0, j].set_xlabel(f"{name}, joint {j + 1}", fontsize=7)
        axes[0, 0].set_ylabel(f"left over [{_units(d)[0]}]", fontsize=7)
        pictures.append((name.split(" [")[0], _inline(svg(made))))
    return pictures


def _binned(x: Array, y: Array, bins: int = 24) -> tuple[Array, Array]:
    """Means over bins of equal width that hold five samples at least."""
    if len(x) < 5:
        return np.zeros(0), np.zeros(0)
    edges = np.linspace(x.min(), x.max() + 1e-12, bins + 1)
    place = np.clip(np.digitize(x, edges) - 1, 0, bins - 1)
    count = np.bincount(place, minlength=bins)
    total = np.bincount(place, weights=y, minlength=bins)
    full = count >= 5
    return ((edges[1:] + edges[:-1]) / 2)[full], total[full] / count[full]


def _replay(d: Diagnosis) -> Markup:
    """Measured and simulated positions of the first windows of the test record, and their difference."""
    shown = [s for s in d.simulation if s is not None]
    if not shown:
        return Markup()
    n = shown[0].measured.shape[2]
    made, axes = figure(n, 2, (9.0, 2.1 * n))
    labels = (("model as described", COLOURS[0]), ("extended model", COLOURS[1]))
    unit = ["m" if d.arm.joints[i].type == "prismatic" else "rad" for i in d.arm.coordinates]
    for j in range(n):
        left, right = axes[j]
        for scores, (label, colour) in zip(d.simulation, labels, strict=True):
            if scores is None or (label == "extended model" and not d.causes):
                continue
            for w in range(min(_WINDOWS, len(scores.t))):
                t, path, truth = scores.t[w], scores.simulated[w, :, j], scores.measured[w, :, j]
                if colour == COLOURS[0]:
                    left.plot(t, truth, color="#999999", linewidth=2.2, label="measured" if w == 0 else None)
                left.plot(t, path, color=colour, linewidth=0.9, label=label if w == 0 else None)
                right.plot(t, path - truth, color=colour, linewidth=0.9)
        left.set_ylabel(f"joint {j + 1} [{unit[j]}]")
        right.set_ylabel("off by")
    axes[0, 0].legend(loc="upper right", fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return _inline(svg(made))


def _inline(text: str) -> Markup:
    """From the svg element on, which stands in the page as it is."""
    return Markup(text[text.index("<svg") :])
