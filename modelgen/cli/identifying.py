"""modelgen identify: progress, identification.json, the parameters for generate, a picture."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

from modelgen.cli.output import print_json, print_table
from modelgen.dataset import (
    Chosen,
    Prepared,
    Settings,
    Stream,
    check_separate,
    choose,
    described,
    gather,
    parse,
    prepare,
    read,
    spectra_svg,
    split,
)
from modelgen.dataset import preset as processing
from modelgen.dataset.periods import period_of, with_whole_rows
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.figures import COLOURS, figure, svg
from modelgen.functions import Options
from modelgen.identification import Identification, Validation, identify, identify_streamed, to_json
from modelgen.identification.without_drives import Alternative, without_drives

STREAMED = 512 * 1024**2  # bytes of training logs beyond which they are streamed


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
    stream: bool,
    compare: bool,
    as_json: bool,
) -> None:
    """Identify and write everything into `out`. how: options of `identify`. Raises InputError."""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    if "drives" in options.without:
        raise InputError("--without drives: the input is the drives' own; expected --without effects")
    if cutoff is not None and preset != "default":
        raise InputError(f"--cutoff {cutoff:g}: --preset {preset} has its own, expected one of both")
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=None)

        def asked(rate: float) -> Settings | Chosen:
            return Settings(cutoff=cutoff) if preset == "default" else processing(preset, rate)

        others: tuple[Alternative, ...] = ()
        if stream or sum(Path(parse(s).path).stat().st_size for s in train if _exists(s)) > STREAMED:
            if compare:
                raise InputError("--compare-drives: found streamed logs, expected shorter ones, read at once")
            found, first, chosen = _streamed(arm, train, test, options, mapping, asked, how, bar, task)
        else:
            training, testing = gather(train, test, arm, mapping)
            if not testing:
                if len(training) > 1:
                    raise InputError("found no test record, expected one: --test LOG")
                one, two = split(training[0])
                training, testing = [one], [two]
            chosen = with_whole_rows(
                choose(training, asked(1 / training[0].step)), [period_of(r, None) for r in training]
            )
            bar.update(task, description="identifying")
            prepared = [prepare(r, chosen) for r in training]
            found = identify(prepared, arm, options, test=[prepare(r, chosen) for r in testing], **how)
            first = prepared[0]
            if compare:
                bar.update(task, description="identifying without the drives")
                others = without_drives(training, testing, arm, chosen, found)
    data = to_json(found) | {"cutoff_hz": chosen.cutoff, "processing": described(first)}
    if compare:
        data["without_drives"] = [
            {"model": o.name, "rmse": o.test.rmse.tolist(), "nrmse_percent": o.test.nrmse_percent.tolist()}
            for o in others
        ]
    _write(found, data, first, out, others)
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
    _print_test(found.test)
    if others:
        _print_comparison(found.test, others)
    typer.echo("\n".join([*data["processing"], data["verdict"]]))


def _print_test(t: Validation) -> None:
    table = [
        [str(j + 1), f"{t.rmse[j]:.4g}", t.unit[j], f"{t.nrmse_percent[j]:.1f}"] for j in range(len(t.rmse))
    ]
    print_table("test records", dict.fromkeys(("joint", "RMSE", "unit", "NRMSE %"), "right"), table)


def _print_comparison(t: Validation, others: Sequence[Alternative]) -> None:
    """RMSE by model, and by how much the arm as described is below it."""
    columns = {"model": "left"} | {f"joint {j + 1} [{u}]": "right" for j, u in enumerate(t.unit)}
    table = [["the arm as described", *(f"{x:.4g}" for x in t.rmse)]]
    for other in others:
        pairs = zip(other.test.rmse, t.rmse, strict=True)
        table.append([other.name, *(f"{x:.4g} ({100 * (y / x - 1):+.0f} %)" for x, y in pairs)])
    print_table("RMSE on the test records, and what the described drives change", columns, table)


def _exists(spec: str) -> bool:
    return Path(parse(spec).path).is_file()


def _streamed(
    arm: Arm,
    train: Sequence[str],
    test: Sequence[str],
    options: Options,
    mapping: Path | None,
    asked: Callable[[float], Settings | Chosen],
    how: Mapping[str, Any],
    bar: Progress,
    task: TaskID,
) -> tuple[Identification, Prepared, Chosen]:
    """The same block by block; the first block stands for the record in pictures."""
    if not test:
        raise InputError("a streamed log is not split: found no test record, expected --test LOG")
    check_separate(train, test)
    head = Stream(train[0], arm, None, mapping)
    first = head.settled(asked(1 / head.axis.step))
    chosen = first.settings
    streams = [first, *(Stream(spec, arm, chosen, mapping) for spec in train[1:])]
    testing = [prepare(read(spec, arm, mapping), chosen) for spec in test]
    bar.update(task, description=f"identifying, {sum(s.samples for s in streams):,} samples")
    found = identify_streamed(
        streams,
        arm,
        options,
        test=testing,
        progress=lambda done, total: bar.update(task, completed=done, total=total),
        **how,
    )
    return found, next(iter(streams[0])), chosen


def picture(found: Validation, others: Sequence[Alternative] = ()) -> str:
    """Measured and predicted effort of every joint as SVG; predictions of other models beside."""
    n = found.measured.shape[1]
    made, axes = figure(n, 1, (7.0, 1.6 * n + 0.4))
    one = bool((np.diff(found.t) > 0).all())  # records one after the other have no common time
    t = found.t if one else np.arange(len(found.t))
    for j in range(n):
        axes[j, 0].plot(t, found.measured[:, j], color=COLOURS[0], label="measured")
        for k, other in enumerate(others):
            axes[j, 0].plot(
                t, other.test.predicted[:, j], color=COLOURS[2 + k], label=other.name, linewidth=0.7
            )
        axes[j, 0].plot(t, found.predicted[:, j], color=COLOURS[1], label="predicted", linewidth=0.8)
        axes[j, 0].set_ylabel(f"joint {j + 1} [{found.unit[j]}]")
    axes[0, 0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2 + len(others), fontsize=7)
    axes[n - 1, 0].set_xlabel("time [s]" if one else "row of the test records")
    return svg(made)


def _write(
    found: Identification, data: object, first: Prepared, out: Path, others: Sequence[Alternative]
) -> None:
    """Every file whole: written beside its place, then moved."""
    values = "".join(f"  {e.name}: {e.value:.12g}\n" for e in found.estimates)
    files = {
        "identification.json": json.dumps(data, indent=2, allow_nan=False) + "\n",
        f"{found.arm.name}_parameters.yaml": f"schema: 1\narm: {found.arm.name}\nparameters:\n{values}",
    }
    files["spectra.svg"] = spectra_svg(first)
    if found.test is not None:
        files["test.svg"] = picture(found.test, others)
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            new = out / f".{name}.new"
            new.write_text(text, encoding="utf-8", newline="\n")
        for name in files:
            (out / f".{name}.new").replace(out / name)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error
