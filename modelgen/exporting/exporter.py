"""From an arm to a file of another format."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.errors import InputError, suggest
from modelgen.exporting.account import Account, Format, described_rows, loaded
from modelgen.exporting.build import machine_of
from modelgen.exporting.exported import Exported, heading
from modelgen.exporting.fmu import FMI2, STANDARDS, export_fmu
from modelgen.exporting.mjcf import MJCF
from modelgen.exporting.states import Efforts, States
from modelgen.exporting.urdf import URDF
from modelgen.exporting.values import Values, identified, nominal, standard_of
from modelgen.files import check_writable
from modelgen.functions import EVALUATED, Model, build_model
from modelgen.functions.nominal import base_matrix
from modelgen.functions.parameters_file import base_vector

Maker = Callable[[Arm, Mapping[str, float] | None, Sequence[str]], Exported]


def check_file(option: str, path: Path) -> None:
    """Raises InputError where `path` cannot become a file, or its folder does not exist."""
    check_writable(option, path)
    if not path.parent.is_dir():
        raise InputError(f"{option} {path}: there is no folder {path.parent}; make it first")


def check_format(name: str, fmi: str | None = None) -> None:
    """Raises InputError where there is no such format, or no such version of FMI of an FMU."""
    if name not in FORMATS:
        raise InputError(f"--to {name}: there is no such format{suggest(name, FORMATS)}")
    if fmi is not None and name != FMU:
        raise InputError(f"--fmi {fmi}: only --to {FMU} has a version of FMI; leave it out")
    if fmi is not None and fmi not in STANDARDS:
        raise InputError(f"--fmi {fmi}: there is no such version; expected {' or '.join(STANDARDS)}")


def export_model(
    arm: Arm,
    to: str,
    parameters: Mapping[str, float] | None = None,
    remarks: Sequence[str] = (),
    fmi: str | None = None,
) -> Exported:
    """The arm as a file that a simulator reads.

    parameters: base parameters by name; by default the description's nominal values. remarks: on where they
    are from. fmi: version of an FMU. Raises InputError for a format that does not exist, for links without
    inertials, and for parameters that are not the arm's.
    """
    check_format(to, fmi)
    made = FORMATS[to] if fmi is None else partial(export_fmu, standard=STANDARDS[fmi])
    return made(arm, parameters, remarks)


def _model(form: Format) -> Maker:
    """What makes files of links and joints."""

    def made(arm: Arm, parameters: Mapping[str, float] | None, remarks: Sequence[str]) -> Exported:
        plain = described(arm)
        states, changed = States(plain), []
        if parameters is None:
            values = nominal(plain)
        else:
            model = build_model(arm, EVALUATED)
            values = identified(model, parameters)
            changed = _changed(model, states, parameters, values)
        machine = machine_of(plain, replace(values, bodies=loaded(plain, values.bodies)))
        efforts = Efforts(plain, states, standard_of(values))
        account = Account(plain, machine, states, values.effects, efforts, form)
        rows = [*described_rows(arm), *account.rows()]
        notes = [*remarks, *changed, *_left(arm), *form.remarks(machine)]
        text = form.write(machine, heading(arm.name, arm.source, rows, notes))
        return Exported(arm, form.name, form.title, text, text.encode(), tuple(rows), tuple(notes))

    return made


def _changed(model: Model, states: States, given: Mapping[str, float], values: Values) -> list[str]:
    """What it takes to have bodies that could exist, in parameters and in efforts."""
    if not values.off:
        return []
    known, (worst, share) = standard_of(values), next(iter(values.off.items()))
    kept = base_matrix(model) @ np.array([known[p.name] for p in model.standard])
    wanted = states.efforts(model, base_vector(model, given))
    apart = np.abs(states.efforts(model, kept) - wanted).max(axis=0)
    part = apart / np.maximum(np.abs(wanted).max(axis=0), 1e-300)
    n = int(np.argmax(part))
    joint = model.arm.joints[model.arm.coordinates[n]]
    unit = "N" if joint.type == "prismatic" else "N m"
    return [
        "no bodies that could exist have these parameters: the nearest are used, whose efforts are at most "
        f"{apart[n]:.2g} {unit} off ({joint.name}, {part[n]:.1%} of its largest), and parameters {share:.1%} "
        f"({worst})"
    ]


def _left(arm: Arm) -> list[str]:
    return ["buoyancy is left out: the description has no volumes"] if arm.fluid_density else []


FMU = "fmu"
FORMATS: Mapping[str, Maker] = {
    MJCF.name: _model(MJCF),
    URDF.name: _model(URDF),
    FMU: partial(export_fmu, standard=FMI2),
}
