"""modelgen identify: progress, identification.json, the parameters for generate, a picture."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.progress import Progress

from modelgen.cli.output import print_json, print_table
from modelgen.dataset import Prepared, Settings, choose, described, gather, prepare, spectra_svg, split
from modelgen.dataset import preset as processing
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.figures import COLOURS, figure, svg
from modelgen.functions import Options
from modelgen.identification import Identification, Validation, identify, to_json


def run(
    arm: Arm,
    train: Sequence[str],
    test: Sequence[str],
    out: Path,
    options: Options,
    mapping: Path | None,
    cutoff: float | None,
    how: Mapping[str, Any],
    *,
    preset: str,
    as_json: bool,
) -> None:
    """Identify and write everything into `out`. how: options of `identify`. Raises InputError."""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    if "drives" in options.without:
        raise InputError("--without drives: the input is the drives' own; expected --without effects")
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=None)
        training, testing = gather(train, test, arm, mapping)
        if not testing:
            if len(training) > 1:
                raise InputError("found no test record, expected one: --test LOG")
            first, second = split(training[0])
            training, testing = [first], [second]
        if cutoff is not None and preset != "default":
            raise InputError(f"--cutoff {cutoff:g}: --preset {preset} has its own, expected one of both")
        asked = Settings(cutoff=cutoff) if preset == "default" else processing(preset, 1 / training[0].step)
        chosen = choose(training, asked)
        bar.update(task, description="identifying")
        prepared = [prepare(r, chosen) for r in training]
        found = identify(
            prepared,
            arm,
            options,
            test=[prepare(r, chosen) for r in testing],
            **how,
        )
    data = to_json(found) | {"cutoff_hz": chosen.cutoff, "processing": described(prepared[0])}
    _write(found, data, prepared[0], out)
    if as_json:
        print_json(data)
        return
    rows = [
        [
            e.name,
            f"{e.value:.5g}",
            "" if e.std is None else f"{e.std:.2g}",
            "" if e.relative is None else f"{e.relative:.1f}",
            e.unit,
            "yes" if e.essential else "no",
        ]
        for e in found.estimates
    ]
    headings = ("parameter", "value", "std", "std %", "unit", "essential")
    print_table("", dict.fromkeys(headings, "right"), rows)
    assert found.test is not None
    t = found.test
    table = [
        [str(j + 1), f"{t.rmse[j]:.4g}", t.unit[j], f"{t.nrmse_percent[j]:.1f}"] for j in range(len(t.rmse))
    ]
    print_table("test records", dict.fromkeys(("joint", "RMSE", "unit", "NRMSE %"), "right"), table)
    typer.echo("\n".join([*data["processing"], data["verdict"]]))


def picture(found: Validation) -> str:
    """Measured and predicted effort of every joint as SVG."""
    n = found.measured.shape[1]
    made, axes = figure(n, 1, (7.0, 1.6 * n + 0.4))
    for j in range(n):
        axes[j, 0].plot(found.measured[:, j], color=COLOURS[0], label="measured")
        axes[j, 0].plot(found.predicted[:, j], color=COLOURS[1], label="predicted", linewidth=0.8)
        axes[j, 0].set_ylabel(f"joint {j + 1} [{found.unit[j]}]")
    axes[0, 0].legend(loc="upper right")
    axes[n - 1, 0].set_xlabel("row of the test records")
    return svg(made)


def _write(found: Identification, data: object, first: Prepared, out: Path) -> None:
    """Every file whole: written beside its place, then moved."""
    values = "".join(f"  {e.name}: {e.value:.12g}\n" for e in found.estimates)
    files = {
        "identification.json": json.dumps(data, indent=2, allow_nan=False) + "\n",
        f"{found.arm.name}_parameters.yaml": f"schema: 1\narm: {found.arm.name}\nparameters:\n{values}",
    }
    files["spectra.svg"] = spectra_svg(first)
    if found.test is not None:
        files["test.svg"] = picture(found.test)
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            new = out / f".{name}.new"
            new.write_text(text, encoding="utf-8", newline="\n")
        for name in files:
            (out / f".{name}.new").replace(out / name)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error
