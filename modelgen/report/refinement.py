"""The report of a refinement: motion before and after, parameters against where they started."""

from __future__ import annotations

from typing import Any

import numpy as np

from modelgen.charts import Chart, Curve, number, sheet
from modelgen.identification.output_error.refine import Refinement
from modelgen.numeric import Array
from modelgen.report.call import WHERE, Call
from modelgen.report.page import Command, Grid, Part, Parts, Run, Text, block, page
from modelgen.report.words import listed, sentence

_FAR = 2.0  # standard deviations


def motion(found: Refinement) -> list[Chart]:
    """Measured and simulated positions of every joint, part after part, and their difference."""
    arm = found.plant.arm
    t, measured, simulated = _joined(found)
    charts = []
    for j, name in enumerate(arm.coordinate_names):
        unit = arm.coordinate_units[j]
        curves = [
            Curve(t, measured[:, j], "measured", "measured"),
            Curve(t, simulated[:, j], "after", "simulated, refined"),
        ]
        text = f"Position of {name}, measured and simulated."
        charts.append(Chart(name, "time [s]", f"position [{unit}]", curves, text, zoom=True))
        error = [Curve(t, simulated[:, j] - measured[:, j], "after", "simulated, refined")]
        text = f"Simulated less measured position of {name}."
        charts.append(Chart(f"{name}, error", "time [s]", f"error [{unit}]", error, text, zoom=True))
    return charts


def picture(found: Refinement) -> str:
    """SVG of `motion`."""
    return sheet(motion(found), 2)


def report(found: Refinement, call: Call) -> str:
    """HTML that needs nothing beside it."""
    arm = found.plant.arm
    name, names = arm.name, arm.coordinate_names
    units = arm.coordinate_units
    rows = [
        (
            joint,
            f"{found.before.f_gof[k]:z.2f}",
            f"{found.after.f_gof[k]:z.2f}",
            f"{number(found.before.rmse[k])} {units[k]}",
            f"{number(found.after.rmse[k])} {units[k]}",
        )
        for k, joint in enumerate(names)
    ]
    heads = [("joint", "left"), ("F_gof % before", "right"), ("F_gof % after", "right")]
    heads += [("RMSE before", "right"), ("RMSE after", "right")]
    free = [x for x in found.parameters if x.std is not None]
    tuned = f"{len(free)} of {len(found.parameters)}"
    steps = f"after {found.rounds} steps"
    ended = f"It converged {steps}" if found.converged else f"It did not converge {steps}: {found.stopped}"
    answers: Parts = [
        (
            "What was found",
            [Text(f"{tuned} parameters were tuned until the simulated motion is the measured one. {ended}.")],
        ),
        (
            "How well it moves",
            [
                Grid("Simulated motion", heads, rows, folds=True),
                Text(
                    "Goodness of fit 100 (1 - |y - simulated| / |y - mean y|), and RMSE of the positions, of "
                    "whole parts simulated from their beginning.",
                    "quiet",
                ),
            ],
        ),
        ("What moved", [Text(_moved(free)), *_uncertain(found)]),
        (
            "What to do next",
            _following(call),
        ),
    ]
    table = [
        (
            x.name,
            f"{x.start:z.5g}",
            f"{x.value:z.5g}",
            "held" if x.std is None else f"{x.std:z.2g}",
            "" if not x.std else f"{(x.value - x.start) / x.std:+z.1f}",
            x.unit,
            "" if not x.std else f"{number(x.moves, 2)} {units[x.shown_by]} at {names[x.shown_by]}",
        )
        for x in found.parameters
    ]
    columns = [("parameter", "left"), ("start", "right"), ("refined", "right"), ("std", "right")]
    columns += [("moved by std", "right"), ("unit", "left"), ("std moves the motion by (RMS)", "left")]
    sections: Parts = [
        ("Measured against simulated motion", [block(motion(found))]),
        ("Parameters", [Grid("Parameters", columns, table, folds=True)]),
    ]
    return page(f"{name}: refined parameters", "Refinement", answers, sections)


def _following(call: Call) -> list[Part | str]:
    """The code, and what the model lacks."""
    generate = call.command("generate", "--parameters", call.beside(f"{call.arm.name}_parameters.yaml"))
    diagnose = call.diagnosing()
    parts: list[Part | str] = [
        Text(f"{call.first}{sentence(f'generate code with these values folded in, {WHERE}')}"),
        Command(generate),
    ]
    if diagnose:
        return [
            *parts,
            Text("Where the motion still differs by more than its noise, this names the cause."),
            Command(diagnose),
        ]
    named = [
        Run("Where the motion still differs by more than its noise, record a second motion, which nothing "),
        Run("is fitted to, and let "),
        Run("modelgen diagnose", "code"),
        Run(" name the cause: this record is for "),
        Run("--train", "code"),
        Run(", the second for "),
        Run("--test", "code"),
        Run("."),
    ]
    return [*parts, Text(named)]


def _moved(free: list[Any]) -> str:
    """Which parameters left their start by more than their uncertainty."""
    far = sorted(
        (x for x in free if x.std and abs(x.value - x.start) > _FAR * x.std),
        key=lambda x: -abs(x.value - x.start) / x.std,
    )
    if not far:
        return f"No parameter left its start by more than {_FAR:g} standard deviations."
    said = listed(f"{x.name} {number(x.start)} → {number(x.value)} {x.unit}".rstrip() for x in far[:6])
    more = f", and {len(far) - 6} more" if len(far) > 6 else ""
    return f"By more than {_FAR:g} standard deviations: {said}{more}."


def _uncertain(found: Refinement) -> list[Part]:
    """The parameter whose uncertainty moves the motion most, beside the errors that are there anyway."""
    errors = found.after.rmse
    free = [x for x in found.parameters if x.std]
    if not free:
        return []
    worst = max(free, key=lambda x: x.moves / max(float(errors[x.shown_by]), 1e-300))
    arm = found.plant.arm
    unit, name = arm.coordinate_units[worst.shown_by], arm.coordinate_names[worst.shown_by]
    return [
        Text(
            f"Most uncertain in the motion is {worst.name}: its standard deviation moves {name} by "
            f"{number(worst.moves, 2)} {unit} (RMS), beside an error of {number(errors[worst.shown_by], 2)} "
            f"{unit}."
        )
    ]


def _joined(found: Refinement) -> tuple[Array, Array, Array]:
    """Times, measured and simulated positions, part after part with a gap between two."""
    times, measured, simulated, begin = [], [], [], 0.0
    for t, q, run in zip(found.t, found.measured, found.simulated, strict=True):
        at = begin + t - t[0]
        begin = float(at[-1])
        gap = np.full((1, q.shape[1]), np.nan)
        times += [at, np.array([begin])]
        measured += [q, gap]
        simulated += [run, gap]
    return np.concatenate(times), np.concatenate(measured), np.concatenate(simulated)
