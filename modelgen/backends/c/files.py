"""The files of one arm in C."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping

from modelgen.backends.c.batch import BATCH, batches, lane_by_lane
from modelgen.backends.c.declarations import FunctionText, function_text, header_values, parameter_checks
from modelgen.backends.c.dialect import INDENT, OUTPUT_LIMIT, literal
from modelgen.backends.c.levels import levels
from modelgen.backends.c.source import statements, unrolled
from modelgen.backends.c.strokes import strokes
from modelgen.backends.documentation import function_sections, unit
from modelgen.backends.elements import base_parameters, local_names
from modelgen.backends.provenance import Provenance
from modelgen.backends.text import render, table, wrapped, wrapped_code
from modelgen.functions.objects import Function, Model

# Stands for the generation's number until every file of it is known.
_PENDING = "0xFFFFFFFFUL /* pending */"
_COMMENT = re.compile(r"/\*.*?\*/|\"[^\"\n]*\"", re.DOTALL)
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def c_files(model: Model, provenance: Provenance) -> dict[str, str]:
    """Text of the arm's C files by path below the arm's folder.

    The header and the sources carry the same number, made from the text of all of them, so that files
    of two generations do not compile together. Raises ValueError where a constant does not fit into
    single precision.
    """
    arm = model.arm.name
    common: dict[str, object] = {
        "arm": arm,
        "macro": arm.upper(),
        "provenance": provenance.head(arm),
        "generation": _PENDING,
    }
    texts = [function_text(model, function) for function in model.functions]
    common["checks"] = parameter_checks(model)
    files = {
        f"include/{arm}.h": render(
            "c/header.h.j2",
            **common,
            **header_values(model, texts),
            model=_identity(model, provenance),
            real=provenance.real,
        ),
        f"src/{arm}_private.h": render(
            "c/private.h.j2", **common, squares=_squares(model), limits=_limits(model)
        ),
        f"src/{arm}_check_parameters.c": render("c/check_parameters.c.j2", **common),
        f"src/{arm}_model.c": render("c/model.c.j2", **common),
        f"src/{arm}_sincos.c": render("c/sincos.c.j2", **common),
    }
    for function, text in zip(model.functions, texts, strict=True):
        files[f"src/{arm}_{function.name}.c"] = render(
            "c/function.c.j2", **common, **_values(model, function, text)
        )
    if model.nominal:
        rows = _nominal(model)
        files[f"src/{arm}_nominal_parameters.c"] = render("c/nominal.c.j2", **common, rows=rows)
    if model.levels is not None:
        files[f"src/{arm}_levels.c"] = render("c/levels.c.j2", **common, levels=levels(model))
    for stroke in strokes(model):
        files[f"src/{arm}_{stroke.name}.c"] = render("c/strokes.c.j2", **common, stroke=stroke)
    if model.batch:
        files[f"src/{arm}_lanes.h"] = render("c/lanes.h.j2", **common, **lane_by_lane())
    for batch in batches(model):
        files[f"src/{arm}_{batch.name}{BATCH}.c"] = render("c/batch.c.j2", **common, batch=batch)
    digest = hashlib.sha256("".join(files[name] for name in sorted(files)).encode()).hexdigest()
    return {name: text.replace(_PENDING, f"0x{digest[:8].upper()}UL") for name, text in files.items()}


def c_symbols(arm: str, files: Mapping[str, str]) -> set[str]:
    """Names in lower case that the arm's headers declare or define: functions, macros, enumerators."""
    prefix = f"{arm.lower()}_"
    return {
        word.lower()
        for name, text in files.items()
        if name.endswith(".h")
        for word in _IDENTIFIER.findall(_COMMENT.sub(" ", text))
        if word.lower().startswith(prefix)
    }


def _identity(model: Model, provenance: Provenance) -> str:
    """The description's hash, and the version where the description has one."""
    return f"{provenance.description} {model.arm.version}".rstrip()


def _limits(model: Model) -> dict[str, str]:
    """What the magnitudes of an output's elements may add up to, and at what values are held on the way."""
    arm = model.arm.name
    return {"output": literal(arm, OUTPUT_LIMIT), "held": literal(arm, 2 * OUTPUT_LIMIT)}


def _squares(model: Model) -> str:
    """The statement that compares a joint vector's sum of squares, without a loop; none for a long vector."""
    n = len(model.arm.coordinates)
    if not unrolled(n):
        return ""
    total = " + ".join(f"x[{i}] * x[{i}]" for i in range(n))
    return wrapped_code(f"return {total} <= limit;", INDENT, INDENT * 2)


def _nominal(model: Model) -> list[str]:
    """Nominal values of the base parameters, each with its name and unit."""
    return table(
        (f"{literal(model.arm.name, value)},", f"/* {p.name} {unit(p.unit)} */")
        for value, p in zip(model.nominal, base_parameters(model), strict=True)
    )


def _values(model: Model, function: Function, text: FunctionText) -> dict[str, object]:
    tables = []
    if function.name == "regressor_packed":
        for name, numbers in (("rows", model.packed.rows), ("columns", model.packed.columns)):
            listed = ", ".join(str(i) for i in numbers)
            tables.append((name, wrapped(listed, "    ")))
    return {
        "text": text,
        "sections": function_sections(model, function),
        "statements": statements(
            model.arm.name, function, local_names(model, function), len(model.arm.coordinates)
        ),
        "tables": tables,
    }
