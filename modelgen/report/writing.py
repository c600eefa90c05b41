"""The files of a diagnosis."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

from modelgen.description import load
from modelgen.diagnosis.result import Diagnosis
from modelgen.effects import known_effects
from modelgen.effects.editing import extended_yaml
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.functions.parameters_file import parameters_yaml
from modelgen.generation import generate
from modelgen.report.call import Call
from modelgen.report.diagnosis import pictures, report
from modelgen.report.experiment import NAMES, plans
from modelgen.report.following import REDUCED, reduced_causes, reduced_name, whole_json


def write(
    d: Diagnosis, out: Path, *, code: bool = True, called: Path | None = None, call: Call | None = None
) -> None:
    """diagnosis.json, report.html, the extended description, its parameters and its code into `out`.

    All of them, or none. Where causes make the test record worse, the description without them too.

    code: False leaves the code out. called: the folder where they will be in the end, if that is not `out`.
    call: how the diagnosis was asked for, which the commands on the page need.
    Raises InputError.
    """
    name = d.arm.name
    new, there = out / ".new", out.exists()  # on the file system of `out`, whatever that is
    try:
        shutil.rmtree(new, ignore_errors=True)
        new.mkdir(parents=True)
        extended = extended_yaml(d.arm, d.added)
        (new / f"{name}_extended.yaml").write_text(extended, encoding="utf-8", newline="\n")
        reduced = reduced_name(d)
        if reduced:
            text = extended_yaml(d.arm, reduced_causes(d))
            (new / reduced).write_text(text, encoding="utf-8", newline="\n")
        values = {key: float(f"{e.value:z.12g}") for key, e in d.parameters.items()}
        text = parameters_yaml(name, values)
        (new / f"{name}_parameters.yaml").write_text(text, encoding="utf-8", newline="\n")
        if code:
            (arm,) = load(new / f"{name}_extended.yaml", known_effects()).values()
            generate([arm], new / "generated", Options(identified=values), processes=1)
        asked = replace(call or Call(d.arm), folder=called or out)
        text = json.dumps(whole_json(d, asked), indent=2, allow_nan=False) + "\n"
        (new / "diagnosis.json").write_text(text, encoding="utf-8", newline="\n")
        (new / "report.html").write_text(report(d, called or out, call), encoding="utf-8", newline="\n")
        for picture, text in {**pictures(d), **plans(d)}.items():
            (new / picture).write_text(text, encoding="utf-8", newline="\n")
        for stale in (*NAMES, f"{name}_{REDUCED}.yaml"):  # of a diagnosis before
            (out / stale).unlink(missing_ok=True)
        for path in sorted(new.iterdir()):
            target = out / path.name
            if target.is_dir():
                shutil.rmtree(target)
            path.replace(target)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error
    finally:
        shutil.rmtree(new, ignore_errors=True)
        if not there and out.is_dir() and not any(out.iterdir()):
            out.rmdir()
