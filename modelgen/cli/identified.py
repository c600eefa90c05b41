"""What modelgen identify writes and prints."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import typer

from modelgen.cli.files import write_together
from modelgen.cli.output import print_json, print_table
from modelgen.dataset import Chosen, Prepared, described, spectra_svg
from modelgen.effects.editing import with_torque_constants
from modelgen.identification import Identification, Validation, to_json
from modelgen.identification.folds import Folds
from modelgen.identification.output import errors
from modelgen.identification.without_drives import Alternative
from modelgen.report.identification import models, page, predictions, table


@dataclass(frozen=True)
class Outcome:
    """others: models beside the identification. first: a training record, for the spectra. folds: parts of
    the training records held out in turn.
    """

    found: Identification
    others: Sequence[Alternative]
    first: Prepared
    chosen: Chosen
    folds: Folds | None = None

    @cached_property
    def data(self) -> dict[str, Any]:
        """identification.json."""
        beside = [{"model": o.name, **errors(o.test)} for o in self.others]
        return (
            to_json(self.found)
            | {"cutoff_hz": self.chosen.cutoff, "processing": described(self.first)}
            | ({"without_drives": beside} if beside else {})
            | ({} if self.folds is None else {"folds": self._folds(self.folds)})
        )

    @staticmethod
    def _folds(folds: Folds) -> dict[str, Any]:
        return {
            "parts": [{"test": name, **errors(test)} for name, test in folds.parts],
            "rmse": folds.rmse.tolist(),
            "nrmse_percent": folds.nrmse_percent.tolist(),
        }


def write(o: Outcome, file: Path, out: Path) -> None:
    """Every file, or none. file: the description. Raises InputError."""
    found, data = o.found, o.data
    name = found.arm.name
    values = "".join(f"  {e.name}: {e.value:.12g}\n" for e in found.estimates)
    spectra = spectra_svg(o.first)
    files = {
        "identification.json": json.dumps(data, indent=2, allow_nan=False) + "\n",
        f"{name}_parameters.yaml": f"schema: 1\narm: {name}\nparameters:\n{values}",
        "spectra.svg": spectra,
        "report.html": page(found, o.others, data["verdict"], data["processing"], spectra),
    }
    if found.test is not None:
        files["test.svg"] = predictions(found.test, o.others)
    if found.gains:
        constants = {g.joint: g.value for g in found.gains}
        files[f"{name}_identified.yaml"] = with_torque_constants(file, found.arm, constants)
    write_together(f"--out {out}", out, files)


def show(o: Outcome, *, as_json: bool) -> None:
    """On stdout."""
    data, found = o.data, o.found
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
            "yes" if e.essential else "left out" if e.dropped else "no",
        ]
        for e in found.estimates
    ]
    headings = ("parameter", "value", "std", "std %", "unit", "essential")
    print_table("", dict.fromkeys(headings, "right"), rows)
    if found.gains:
        rows = [[str(g.joint), f"{g.described:.6g}", f"{g.value:.6g}", f"{g.std:.2g}"] for g in found.gains]
        print_table("torque constants", dict.fromkeys(("joint", "described", "found", "std"), "right"), rows)
    if found.test is not None:
        _show_test(found.test, o)
    if o.folds is not None:
        heads = {"held out": "left"} | {f"joint {j + 1}": "right" for j in range(len(o.folds.rmse))}
        rows = [[name, *(f"{x:.1f}" for x in part.nrmse_percent)] for name, part in o.folds.parts]
        rows.append(["all together", *(f"{x:.1f}" for x in o.folds.nrmse_percent)])
        print_table("NRMSE % of parts of the training records, each held out in its turn", heads, rows)
    typer.echo("\n".join([*data["processing"], data["verdict"]]))


def _show_test(test: Validation, o: Outcome) -> None:
    rows = [[str(j + 1), a, test.unit[j], b] for j, (a, b) in enumerate(table(test))]
    print_table("test records", dict.fromkeys(("joint", "RMSE", "unit", "NRMSE %"), "right"), rows)
    if o.others:
        heads = {"model": "left"} | {f"joint {j + 1} [{unit}]": "right" for j, unit in enumerate(test.unit)}
        rows = [[name, *cells] for name, cells in models(test, o.others)]
        print_table("RMSE on the test records (NRMSE %), and what the described drives change", heads, rows)
