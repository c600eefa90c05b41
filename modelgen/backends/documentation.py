"""Texts of the generated files about a function: inputs, outputs, units, lengths, meaning."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.backends.elements import base_parameters, coordinates, elements
from modelgen.backends.text import UNBROKEN, operations, plain, table, wrapped
from modelgen.functions.objects import Argument, Function, Model, Output


@dataclass(frozen=True)
class Section:
    """A titled list."""

    title: str
    lines: tuple[str, ...]


def unit(text: str) -> str:
    """Write a unit in brackets, nothing where it is absent."""
    return f"[{text}]" if text else ""


def argument_row(model: Model, function: Function, argument: Argument) -> tuple[str, str, str, str]:
    """Name, length, unit (nothing where it differs by element), meaning and bound of an input."""
    of_unit = "" if elements(model, function, argument) else unit(argument.unit)
    text = f"{plain(argument.text)}; norm at most {argument.bound:g}"
    return argument.name, f"[{argument.size}]", of_unit, text


def output_text(output: Output) -> str:
    """Meaning and shape of an output."""
    shape = f"; {output.rows} x {output.columns}, row-major" if output.columns > 1 else ""
    return f"{plain(output.text)}{shape}"


def remarks(model: Model) -> list[str]:
    """Remarks on the source of the arm's figures, and the notes of its description."""
    texts = [f"Source of the figures: {model.arm.source}"] if model.arm.source else []
    texts += [f"Note: {note}" for note in model.arm.notes]
    return [line for text in texts for line in wrapped(plain(text), width=100).split("\n")]


def model_sections(model: Model) -> list[Section]:
    """The coordinates and parameters of an arm."""
    sections = [Section("Coordinates", _numbered(coordinates(model)))]
    sections.append(Section("Base parameters", _numbered(base_parameters(model))))
    symbols = [(name, f"{value!r}") for name, value in model.arm.symbols.items()]
    title = "Symbols of the geometry, values of the description"
    sections.append(Section(title, tuple(table(symbols))))
    return [section for section in sections if section.lines]


def function_sections(model: Model, function: Function) -> list[Section]:
    """Sections on one function: the elements of its inputs, the columns of its output."""
    sections = [Section("Coordinates", _numbered(coordinates(model)))]
    for argument in function.arguments:
        found = elements(model, function, argument)
        if found:
            sections.append(Section(f"Elements of {argument.name}", _numbered(found)))
    if any("regressor" in name for name in (function.name, *function.parts)):
        standard = function.name.endswith("_standard")
        of = "standard" if standard else "base"
        names = [p.name for p in (model.standard if standard else model.grouping.base)]
        listed = ", ".join(f"{i}{UNBROKEN}{name}" for i, name in enumerate(names))
        sections.append(
            Section(f"Columns of the matrix: {of} parameters", tuple(wrapped(listed, width=100).split("\n")))
        )
    return sections


def function_operations(function: Function) -> str:
    """The operations that one call costs."""
    return operations(function.operations)


def _numbered(found: tuple[object, ...]) -> tuple[str, ...]:
    rows = []
    for i, element in enumerate(found):
        name, of_unit, text = (getattr(element, key) for key in ("name", "unit", "text"))
        rows.append((str(i), name, unit(of_unit), plain(text)))
    return tuple(table(rows))
