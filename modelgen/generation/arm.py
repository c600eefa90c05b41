"""Everything that is generated for one arm, in memory."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from modelgen.backends import PRINTERS, Provenance
from modelgen.backends.c import c_symbols
from modelgen.description.objects import Arm
from modelgen.errors import InputError
from modelgen.functions import Options, build_model
from modelgen.functions.objects import Model
from modelgen.generation.canonical import description_hash
from modelgen.generation.folders import ARTEFACTS, MARK
from modelgen.generation.sizes import size_rows
from modelgen.packaging import ROS2, packaging_files, ros2_files
from modelgen.version import __version__


@dataclass(frozen=True)
class GeneratedArm:
    """The files of one arm by path below its folder, and the figures of its model.

    `operations` maps the functions' names to their operations by kind; `symbols` are the names, in
    lower case, that the C code takes. `artefacts` are files of the folders of ARTEFACTS, which
    the manifest does not list.
    """

    name: str
    files: Mapping[str, str]
    joints: int
    standard_parameters: int
    base_parameters: int
    operations: Mapping[str, Mapping[str, int]]
    symbols: frozenset[str]
    artefacts: Mapping[str, str] = field(default_factory=dict)


def generate_arm(arm: Arm, options: Options, artefacts: Collection[str] = ()) -> GeneratedArm:
    """Build the arm's model and print it in every language, with these of ARTEFACTS. Raises InputError."""
    model, shown = build_model(arm, options), shown_options(options)
    made = print_model(model, arm, shown)
    built: dict[str, str] = {}
    for name in ARTEFACTS:
        if name in artefacts:
            if name == ROS2:
                built |= ros2_files(model, _provenance(arm, shown), made.files, options.identified)
            else:
                built |= _of_casadi(name, made)
    return replace(made, artefacts=built)


def _of_casadi(artefact: str, made: GeneratedArm) -> dict[str, str]:
    """Files of an artefact that CasADi makes of the arm's module."""
    # Loads CasADi, which nothing else needs.
    from modelgen.backends.casadi.artefacts import (  # noqa: PLC0415
        PLANT,
        SERIALISED,
        plant_files,
        serialised_files,
    )

    makers = {SERIALISED: serialised_files, PLANT: plant_files}
    return makers[artefact](made.name, made.files[f"{made.name}_casadi.py"])


def print_model(model: Model, arm: Arm, options: Mapping[str, str]) -> GeneratedArm:
    """Print a model in every language; `arm` is the description as the user gave it. Raises InputError."""
    provenance = _provenance(arm, options)
    try:
        files = {path: text for print_ in PRINTERS for path, text in print_(model, provenance).items()}
        files |= packaging_files(model, provenance, files, size_rows(model))
    except ValueError as error:
        raise InputError(str(error), arm.where) from error
    symbols = frozenset(c_symbols(model.arm.name, files))
    files[MARK] = _manifest(model.arm.name, provenance, files)
    return GeneratedArm(
        name=model.arm.name,
        files=files,
        joints=len(model.arm.coordinates),
        standard_parameters=len(model.standard),
        base_parameters=len(model.grouping.base),
        operations={function.name: dict(function.operations) for function in model.functions},
        symbols=symbols,
    )


def _provenance(arm: Arm, options: Mapping[str, str]) -> Provenance:
    return Provenance(f"modelgen {__version__}", description_hash(arm), dict(options))


def shown_options(options: Options) -> dict[str, str]:
    """Options beside the description, as the generated files state them."""
    shown = {}
    if options.without:
        shown["without"] = " and ".join(sorted(options.without))
    if options.gains != "known":
        shown["gains"] = options.gains
    if options.runtime_geometry:
        shown["geometry"] = "at run time"
    if options.sincos:
        shown["inputs"] = "sines and cosines"
    if not options.derivatives:
        shown["derivatives"] = "none"
    if not options.watch:
        shown["watch"] = "none"
    if options.jacobian_link is not None:
        shown["jacobian"] = options.jacobian_link
    if options.nominal:
        shown["nominal"] = "folded in"
    if options.batch:
        shown["batch"] = " and ".join(sorted(options.batch))
    if options.real != "double":
        shown["real"] = options.real
    if options.identified:
        values = json.dumps(dict(options.identified), sort_keys=True)
        shown["identified"] = hashlib.sha256(values.encode()).hexdigest()[:16]
    if options.noise is not None:
        shown["noise"] = hashlib.sha256(repr(options.noise).encode()).hexdigest()[:16]
    return shown


def _manifest(name: str, provenance: Provenance, files: Mapping[str, str]) -> str:
    """Manifest of the folder: its origin and files, without date or path, so that machines agree on it."""
    content = {
        "arm": name,
        "tool": provenance.tool,
        "description_sha256": provenance.description,
        "options": provenance.options,
        "files": {path: hashlib.sha256(files[path].encode()).hexdigest() for path in sorted(files)},
    }
    return json.dumps(content, indent=2) + "\n"
