"""The archive of a unit: description, C sources, and a library for this machine where it has a compiler."""

from __future__ import annotations

import hashlib
import io
import platform
import sys
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from modelgen.backends.provenance import LICENCE
from modelgen.description.objects import Arm
from modelgen.effects import applied_effects, described
from modelgen.errors import InputError
from modelgen.exporting.account import APPROXIMATED, EXACT, LEFT_OUT, Row, described_rows
from modelgen.exporting.build import range_of
from modelgen.exporting.exported import Exported, heading
from modelgen.exporting.fmu.standard import Described, Standard
from modelgen.exporting.fmu.variables import Variable, variables
from modelgen.exporting.values import nominal, standard_of
from modelgen.functions import grouped
from modelgen.functions.parameters_file import base_vector
from modelgen.native import library_bytes
from modelgen.numeric import Array
from modelgen.simulation import fixed
from modelgen.simulation.friction_set import elastic, slip, unsmoothed
from modelgen.simulation.plant import Plant
from modelgen.simulation.simulate import STEP, STIFF, fastest

MAIN = "fmu.c"
_EPOCH = (1980, 1, 1, 0, 0, 0)  # of every entry, so that archives agree


def export_fmu(
    arm: Arm, parameters: Mapping[str, float] | None, remarks: Sequence[str], standard: Standard
) -> Exported:
    """The unit of an arm. Raises InputError as the other formats do, and for one too stiff for its steps."""
    plant, missing = _plant(arm, parameters)
    q = np.array([_start(*range_of(described(arm), i)) for i in arm.coordinates])
    step = _step(plant, q)
    names, units = _parameters(plant)
    listed = variables(plant, names, units, q, step)
    files = _sources(plant, q, step, standard)
    guid = _guid(files, listed)
    files[MAIN] = files[MAIN].replace(_PENDING, guid)
    rows = [*described_rows(arm), *_rows(arm, missing)]
    notes = [*remarks]
    library = None
    folder = standard.folders.get((sys.platform, platform.machine()))
    try:
        library = library_bytes(files, MAIN) if folder is not None else None
    except RuntimeError as error:
        notes.append(f"there is no compiled library in the unit, its tool must compile the sources: {error}")
    name = plant.arm.name
    table = heading(arm.name, arm.source, rows, notes)
    xml = standard.describe(Described(name, " ".join(arm.source.split()), guid, listed, table, MAIN))
    entries = {"modelDescription.xml": xml.encode()}
    entries |= {f"sources/{file}": text.encode() for file, text in files.items()}
    entries |= {file: text.encode() for file, text in standard.more(name, MAIN).items()}
    if folder is not None and library is not None:
        suffix = ".dylib" if sys.platform == "darwin" else ".so"
        entries[f"binaries/{folder}/{name}{suffix}"] = library
    return Exported(arm, "fmu", standard.title, xml, _archive(entries), tuple(rows), tuple(notes))


def _plant(arm: Arm, parameters: Mapping[str, float] | None) -> tuple[Plant, list[str]]:
    """The plant, and names of standard parameters that have no value and begin at zero."""
    if parameters is not None:
        made = slip(arm)
        base = base_vector(made.model, parameters)
        return Plant(made, base, base), []
    if arm.fluid_density:
        raise InputError(
            f"{arm.name}: an arm in a fluid needs --parameters, which hold its buoyancy", arm.where
        )
    known = standard_of(nominal(arm))
    made = slip(arm, standard=elastic(arm))
    missing = [p.name for p in made.model.standard if p.name not in known]
    standard = np.array([known.get(p.name, 0.0) for p in made.model.standard])
    base = np.array(list(grouped(made.model, standard.tolist()).values()))
    return Plant(made, standard if made.standard else base, base), missing


def _start(low: float, high: float) -> float:
    """Zero where the joint may be there, else the middle of its range."""
    return 0.0 if low <= 0.0 <= high else (low + high) / 2


def _step(plant: Plant, q: Array) -> float:
    """The longest step that is well inside of where the method is stable."""
    rate = fastest(plant, np.concatenate([q, np.zeros(plant.n + len(plant.model.states))]))
    if rate > STIFF:
        raise InputError(
            f"{plant.arm.name}: its equations are too stiff for the steps of a unit, {rate:.2g} 1/s; "
            f"expected at most {STIFF:g} 1/s: take out the stiffest effect"
        )
    return float(f"{min(STEP, 1.0 / max(rate, 1e-9)):.3g}")


def _parameters(plant: Plant) -> tuple[list[str], list[str]]:
    """Names and units of the parameters."""
    if plant.slip.standard:
        return [p.name for p in plant.model.standard], [p.unit for p in plant.model.standard]
    base = plant.model.grouping.base
    return [p.name for p in base], [p.unit for p in base]


def _rows(arm: Arm, missing: Sequence[str]) -> list[Row]:
    found = []
    for effect, sharp in zip(applied_effects(arm), applied_effects(unsmoothed(arm)), strict=True):
        joint = None if effect.joint is None else arm.joints[effect.joint]
        unit = "N" if joint is not None and joint.type == "prismatic" else "N m"
        zero = [p.name for p, symbol in effect.parameters if symbol.name in missing]
        status, text = EXACT, "as in the equations"
        if zero:
            status, text = LEFT_OUT, f"no value for {' and '.join(zero)}: zero to begin with"
        elif effect.values != sharp.values:
            status, text = APPROXIMATED, "its direction is not smoothed, a joint at rest sticks"
        name, error = None if joint is None else joint.name, 0.0 if status == EXACT else None
        found.append(Row(effect.effect.name, name, status, error, text, unit))
    return found


# -- the sources ------------------------------------------------------------------------------

_PENDING = "guid pending"


def _sources(plant: Plant, q: Array, step: float, standard: Standard) -> dict[str, str]:
    """C by name, all in one folder; MAIN includes the others."""
    motors = plant.model.function("motor_from_joint")
    files = {}
    licence = f"/* {LICENCE} */"
    for path, text in fixed.sources(plant, [motors]).items():
        files[path.rpartition("/")[2]] = text.replace('#include "src/', '#include "')
    files[fixed.MAIN] = f"{licence}\n{files[fixed.MAIN]}"
    name = plant.arm.name
    low, high = (np.where(np.isfinite(x), x, np.sign(x) * 1e300) for x in plant.strokes)
    lines = [
        licence,
        f"/* {name} as a unit after FMI {standard.version}. This file includes all others. */",
        f"#define begin {name}_begin",
        f"#define run {name}_run",
        f'#include "{fixed.MAIN}"',
        f"enum {{ P = {len(plant.parameters)} }};",
        f'#define GUID "{_PENDING}"',
        f"static const double STEP = {step!r};",
        _array("INITIAL", plant.parameters),
        _array("MIDDLE", q),
        _array("LOW", low),
        _array("HIGH", high),
        "static int motors(const double *q, const double *dq, double *out)",
        "{",
        "    const double zeros[N] = {0.0};",
        "    double rest[N];",
        f"    return {name}_motor_from_joint(q, dq, zeros, out, out + N, rest);",
        "}",
    ]
    own = [(Path(__file__).parent / f).read_text(encoding="utf-8") for f in ("unit.c", standard.source)]
    return {**files, MAIN: "\n".join([*lines, *own])}


def _array(name: str, values: Array) -> str:
    listed = ", ".join(repr(float(x)) for x in values)
    return f"static const double {name}[] = {{{listed}}};"


def _guid(files: Mapping[str, str], listed: Sequence[Variable]) -> str:
    """A name for exactly this unit, from all that it holds."""
    text = "\0".join([*(f"{name}\0{files[name]}" for name in sorted(files)), *map(repr, listed)])
    digest = hashlib.sha256(text.encode()).hexdigest()
    return "{" + "-".join((digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32])) + "}"


def _archive(entries: Mapping[str, bytes]) -> bytes:
    """The entries in their order, without dates."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content)
    return made.getvalue()
