"""From an arm to the text of a file: values, machine, effects, text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.errors import InputError, suggest
from modelgen.exporting.account import Account, Format, Row, described_rows, loaded
from modelgen.exporting.build import machine_of
from modelgen.exporting.machine import Machine
from modelgen.exporting.mjcf import MJCF
from modelgen.exporting.states import Efforts, States
from modelgen.exporting.urdf import URDF
from modelgen.exporting.values import identified, nominal, standard_of
from modelgen.files import check_writable
from modelgen.functions import build_model

FORMATS: Mapping[str, Format] = {form.name: form for form in (MJCF, URDF)}


@dataclass(frozen=True)
class Exported:
    """A file of another format. rows: what it has of each effect. notes: what the user must know besides."""

    arm: Arm
    form: Format
    text: str
    rows: tuple[Row, ...]
    notes: tuple[str, ...]


def format_of(name: str) -> Format:
    """The format of that name. Raises InputError."""
    if name not in FORMATS:
        raise InputError(f"--to {name}: there is no such format{suggest(name, FORMATS)}")
    return FORMATS[name]


def check_file(option: str, path: Path) -> None:
    """Raises InputError where `path` cannot become a file, or its folder does not exist."""
    check_writable(option, path)
    if not path.parent.is_dir():
        raise InputError(f"{option} {path}: there is no folder {path.parent}; make it first")


def export_model(
    arm: Arm, to: str, parameters: Mapping[str, float] | None = None, remarks: Sequence[str] = ()
) -> Exported:
    """The arm as the text of a file that a simulator reads.

    parameters: base parameters by name; by default the description's nominal values. remarks: on where they
    are from. Raises InputError for a
    format that does not exist, for links without inertials, and for parameters that are not the arm's.
    """
    form = format_of(to)
    plain = described(arm)
    values = nominal(plain) if parameters is None else identified(build_model(arm), parameters)
    machine = machine_of(plain, replace(values, bodies=loaded(plain, values.bodies)))
    states = States(plain)
    efforts = Efforts(plain, states, standard_of(values))
    rows = [*described_rows(arm), *Account(plain, machine, states, values.effects, efforts, form).rows()]
    notes = [*remarks, *values.notes, *_left(arm), *form.remarks(machine)]
    text = form.write(machine, _heading(machine, form, rows, notes))
    return Exported(arm, form, text, tuple(rows), tuple(notes))


def _left(arm: Arm) -> list[str]:
    return ["buoyancy is left out: the description has no volumes"] if arm.fluid_density else []


def _heading(machine: Machine, form: Format, rows: Sequence[Row], notes: Sequence[str]) -> list[str]:
    """What the file says of itself: what it has of each effect, in columns."""
    lines = [f"{machine.name}, written by modelgen."]
    if machine.source:
        lines.append(f"Source: {machine.source}")
    if rows:
        cells = [("effect", "joint", "here", "largest error", "as"), *(row.cells() for row in rows)]
        widths = [max(len(row[k]) for row in cells) for k in range(4)]
        lines.append("")
        for row in cells:
            padded = "  ".join(cell.ljust(width) for cell, width in zip(row[:4], widths, strict=True))
            lines.append(f"{padded}  {row[4]}")
    lines.append("")
    return [*lines, *(f"Note: {note}." for note in notes)]
