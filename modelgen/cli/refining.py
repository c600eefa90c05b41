"""modelgen refine: progress, refinement.json, the parameters for generate and simulate, a picture."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import Progress

from modelgen.cli.files import write_together
from modelgen.cli.output import print_json, print_table
from modelgen.dataset import Settings, choose, prepare, read
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.figures import COLOURS, figure, svg
from modelgen.identification.output_error.refine import Refinement, refine
from modelgen.simulation import Scores, plant


def run(
    arm: Arm,
    parameters: Mapping[str, float] | None,
    logs: Sequence[str],
    out: Path,
    *,
    mapping: Path | None,
    free: Sequence[str],
    window: float | None,
    as_json: bool,
) -> None:
    """Refine and write everything into `out`. Raises InputError."""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=None)
        made = plant(arm, parameters)
        records = [read(log, arm, mapping) for log in logs]
        chosen = choose(records, Settings())
        prepared = [prepare(record, chosen) for record in records]
        bar.update(task, description="refining")

        def progress(rounds: int, _: float) -> None:
            bar.update(task, description=f"refining, step {rounds}")

        found = refine(made, prepared, free=free, window=window, progress=progress)
    data = to_json(found)
    values = "".join(f"  {x.name}: {x.value:.12g}\n" for x in found.parameters)
    files = {
        "refinement.json": json.dumps(data, indent=2, allow_nan=False) + "\n",
        f"{arm.name}_parameters.yaml": f"schema: 1\narm: {arm.name}\nparameters:\n{values}",
        "refinement.svg": picture(found),
    }
    write_together("--out", out, files)
    if as_json:
        print_json(data)
        return
    rows = [
        [x.name, f"{x.start:.5g}", f"{x.value:.5g}", "held" if x.std is None else f"{x.std:.2g}", x.unit]
        for x in found.parameters
    ]
    print_table("", dict.fromkeys(("parameter", "start", "value", "std", "unit"), "right"), rows)
    table = [
        [
            str(j["joint"]),
            *(f"{j[k]:.4g}" for k in ("f_gof_before", "f_gof", "rmse_before", "rmse")),
            j["unit"],
        ]
        for j in data["joints"]
    ]
    headings = ("joint", "F_gof % before", "after", "RMSE before", "after ", "unit")
    print_table("simulated motion", dict.fromkeys(headings, "right"), table)
    if not found.converged:
        typer.echo(f"not converged after {found.rounds} steps", err=True)


def to_json(found: Refinement) -> dict[str, Any]:
    """refinement.json."""
    arm = found.plant.arm

    def by_joint(s: Scores, k: int, end: str) -> dict[str, Any]:
        f_gof = float(s.f_gof[k]) if np.isfinite(s.f_gof[k]) else 0.0
        return {f"f_gof{end}": f_gof, f"mae{end}": float(s.mae[k]), f"rmse{end}": float(s.rmse[k])}

    return {
        "schema": 1,
        "arm": arm.name,
        "parameters": [
            {"name": x.name, "start": x.start, "value": x.value, "std": x.std, "unit": x.unit}
            for x in found.parameters
        ],
        "joints": [
            {"joint": k + 1, "unit": "m" if arm.joints[i].type == "prismatic" else "rad"}
            | by_joint(found.before, k, "_before")
            | by_joint(found.after, k, "")
            for k, i in enumerate(arm.coordinates)
        ],
        "steps": found.rounds,
        "converged": found.converged,
    }


def picture(found: Refinement) -> str:
    """Measured and simulated positions of every joint, part after part, as SVG."""
    n = found.plant.n
    made, axes = figure(n, 1, (7.0, 1.8 * n + 0.4))
    begin = 0.0
    for k, (t, q, run) in enumerate(zip(found.t, found.measured, found.simulated, strict=True)):
        at = begin + t - t[0]
        begin = float(at[-1])
        for j in range(n):
            a = axes[j, 0]
            a.plot(at, q[:, j], color=COLOURS[0], label="measured" if k == 0 else None)
            a.plot(at, run[:, j], color=COLOURS[1], linewidth=0.8, label="simulated" if k == 0 else None)
    for j, i in enumerate(found.plant.arm.coordinates):
        unit = "m" if found.plant.arm.joints[i].type == "prismatic" else "rad"
        axes[j, 0].set_ylabel(f"q{j + 1} [{unit}]")
    axes[0, 0].legend(loc="upper right")
    axes[n - 1, 0].set_xlabel("t [s], part after part")
    return svg(made)
