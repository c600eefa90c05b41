"""modelgen calibrate: a lever's geometry, the description with it, and a picture."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import typer

from modelgen.calibration import Calibration, calibrate, calibrated_yaml, lever_of
from modelgen.cli.output import print_json, print_table
from modelgen.dataset import read_columns
from modelgen.description import Arm, load
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.figures import COLOURS, figure, svg


def run(file: Path, arm: Arm, joint: int, log: str, out: Path, *, length_std: float, as_json: bool) -> None:
    """Fit, write calibration.json, <arm>_calibrated.yaml and calibration.svg, print. Raises InputError."""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    lever = lever_of(arm, joint)
    columns = read_columns(log, (f"qm{joint}", f"q{joint}"))
    motor, measured = columns[f"qm{joint}"], columns[f"q{joint}"]
    try:
        found = calibrate(lever, joint, motor, measured, length_std)
    except InputError as error:
        raise InputError(f"{log}: {error}") from None
    made = data(arm, found)
    texts = {
        "calibration.json": json.dumps(made, indent=2, allow_nan=False) + "\n",
        f"{arm.name}_calibrated.yaml": calibrated_yaml(file, arm, joint, found.after),
        "calibration.svg": picture(found),
    }
    _write(out, texts, f"{arm.name}_calibrated.yaml")
    if as_json:
        print_json(made)
    else:
        _print(arm, found, out)


def data(arm: Arm, c: Calibration) -> dict[str, Any]:
    """The calibration as plain data."""

    def number(x: float) -> float | None:
        return x if np.isfinite(x) else None

    return {
        "schema": 1,
        "arm": arm.name,
        "joint": c.joint,
        "samples": len(c.motor),
        "rmse": {
            "unit": "rad",
            "before": number(c.rms_before),
            "before_best_offset": number(c.rms_shifted),
            "after": c.rms_after,
            "improvement_percent": number(c.improvement_percent),
        },
        "rev": {
            "before": c.before.rev,
            "value": c.after.rev,
            "rmse": {str(rev): x for rev, x in sorted(c.candidates.items())},
        },
        "parameters": [
            {"name": e.name, "before": e.before, "value": e.value, "std": e.std, "unit": e.unit}
            for e in c.estimates
        ],
        "samples_per_independent_one": c.correlation,
        "not_determined": list(c.weak),
    }


def picture(c: Calibration) -> str:
    """Measured angle and the errors of both levers over the motor coordinate, as SVG."""
    order = np.argsort(c.motor, kind="stable")
    x = c.motor[order]
    made, axes = figure(2, 1, (7.0, 5.0))
    angle, error = axes[0][0], axes[1][0]
    angle.plot(x, np.degrees(c.measured[order]), ".", ms=2, color=COLOURS[4], label="measured")
    for lever, name, colour in ((c.before, "as described", COLOURS[0]), (c.after, "calibrated", COLOURS[1])):
        q = lever.angle(x)
        angle.plot(x, np.degrees(q), color=colour, label=name)
        error.plot(x, np.degrees(c.measured[order] - q), ".", ms=2, color=colour, label=name)
    angle.set_ylabel(f"q{c.joint} [deg]")
    error.set_ylabel("error [deg]")
    error.set_xlabel(f"qm{c.joint} [motor unit]")
    angle.legend()
    return svg(made)


def _write(out: Path, texts: Mapping[str, str], description: str) -> None:
    new = out.with_name(f".{out.name}.new")
    try:
        shutil.rmtree(new, ignore_errors=True)
        new.mkdir(parents=True)
        for name, text in texts.items():
            (new / name).write_text(text, encoding="utf-8", newline="\n")
        load(new / description, known_effects())  # what is written must be readable
        out.mkdir(parents=True, exist_ok=True)
        for name in texts:
            (new / name).replace(out / name)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error
    finally:
        shutil.rmtree(new, ignore_errors=True)


def _print(arm: Arm, c: Calibration, out: Path) -> None:
    typer.echo(
        f"{arm.name}, joint {c.joint}: RMSE of the angle {c.rms_before:.4g} -> {c.rms_after:.4g} rad "
        f"({c.improvement_percent:.1f} % better), {len(c.motor)} samples"
    )
    if c.after.rev != c.before.rev:
        typer.echo(f"rev is {c.after.rev:+d}: the other branch leaves {c.candidates[c.before.rev]:.4g} rad")
    rows = [[e.name, f"{e.before:.6g}", f"{e.value:.6g}", f"{e.std:.2g}", e.unit] for e in c.estimates]
    sides = {"": "left", "described": "right", "calibrated": "right", "std": "right", "unit": "left"}
    print_table("", sides, rows)
    for words in c.weak:
        typer.echo(f"not determined: {words}")
    typer.echo(f"wrote {out / 'calibration.json'}, {arm.name}_calibrated.yaml, calibration.svg")
