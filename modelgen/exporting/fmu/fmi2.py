"""Descriptions of units after FMI 2.0."""

from __future__ import annotations

from modelgen.exporting.fmu.standard import (
    EXPERIMENT,
    Described,
    Standard,
    document,
    initial,
    is_output,
    is_rate,
)
from modelgen.exporting.fmu.variables import Variable
from modelgen.exporting.xml_lines import comment, element, figure


def _describe(unit: Described) -> str:
    sources = element("SourceFiles", element("File", name=unit.main))
    kept = {
        "modelIdentifier": unit.name,
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
    }
    outputs, rates = ([*_unknowns(unit.numbers(which))] for which in (is_output, is_rate))
    structure = [
        *element("Outputs", outputs),
        *element("Derivatives", rates),
        *element("InitialUnknowns", [*outputs, *rates]),
    ]
    inside = [
        *comment(unit.table),
        *element("ModelExchange", sources, **kept),
        *element("CoSimulation", sources, canHandleVariableCommunicationStepSize="true", **kept),
        *unit.units(),
        *EXPERIMENT,
        *element("ModelVariables", [line for k, v in enumerate(unit.listed) for line in _variable(k, v)]),
        *element("ModelStructure", structure),
    ]
    root = element(
        "fmiModelDescription",
        inside,
        fmiVersion="2.0",
        modelName=unit.name,
        guid=unit.guid,
        description=unit.source or None,
        generationTool="modelgen",
        variableNamingConvention="flat",
        numberOfEventIndicators=str(len(unit.numbers(lambda v: v.indicates))),
    )
    return document(root)


def _unknowns(numbers: list[int]) -> list[str]:
    return [line for k in numbers for line in element("Unknown", index=str(k + 1))]


def _variable(reference: int, v: Variable) -> list[str]:
    real = element(
        "Real",
        unit=v.unit or None,
        start=None if v.start is None else figure(v.start),
        derivative=None if v.rate_of is None else str(v.rate_of + 1),
        reinit="true" if v.jumps else None,
    )
    return element(
        "ScalarVariable",
        real,
        name=v.name,
        valueReference=str(reference),
        description=v.text,
        causality=v.causality,
        variability=v.variability,
        initial=initial(v),
    )


FMI2 = Standard(
    version="2.0",
    source="fmi2.c",
    describe=_describe,
    more=lambda name, main: {},
    folders={
        ("linux", "x86_64"): "linux64",
        ("darwin", "x86_64"): "darwin64",
        ("darwin", "arm64"): "darwin64",
    },
)
