"""Descriptions of units after FMI 3.0."""

from __future__ import annotations

from collections.abc import Mapping

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
    kept = {
        "modelIdentifier": unit.name,
        "canGetAndSetFMUState": "true",
        "canSerializeFMUState": "true",
    }
    outputs, rates = unit.numbers(is_output), unit.numbers(is_rate)
    structure = [
        *_unknowns("Output", outputs),
        *_unknowns("ContinuousStateDerivative", rates),
        *_unknowns("InitialUnknown", [*outputs, *rates]),
        *_unknowns("EventIndicator", unit.numbers(lambda v: v.indicates)),
    ]
    inside = [
        *comment(unit.table),
        # a joint that leaves its stroke ends the simulation
        *element("ModelExchange", needsCompletedIntegratorStep="true", **kept),
        *element("CoSimulation", canHandleVariableCommunicationStepSize="true", **kept),
        *unit.units(),
        *EXPERIMENT,
        *element("ModelVariables", [line for k, v in enumerate(unit.listed) for line in _variable(k, v)]),
        *element("ModelStructure", structure),
    ]
    root = element(
        "fmiModelDescription",
        inside,
        fmiVersion="3.0",
        modelName=unit.name,
        instantiationToken=unit.guid,
        description=unit.source or None,
        generationTool="modelgen",
        variableNamingConvention="flat",
    )
    return document(root)


def _unknowns(name: str, numbers: list[int]) -> list[str]:
    return [line for k in numbers for line in element(name, valueReference=str(k))]


def _variable(reference: int, v: Variable) -> list[str]:
    return element(
        "Float64",
        name=v.name,
        valueReference=str(reference),
        description=v.text,
        causality=v.causality,
        variability=v.variability,
        initial=initial(v),
        unit=v.unit or None,
        start=None if v.start is None else figure(v.start),
        derivative=None if v.rate_of is None else str(v.rate_of),
        reinit="true" if v.jumps else None,
    )


def _build(name: str, main: str) -> Mapping[str, str]:
    """How the sources are compiled."""
    sources = element("SourceFileSet", element("SourceFile", name=main), language="C99")
    configuration = element("BuildConfiguration", sources, modelIdentifier=name)
    root = element("fmiBuildDescription", configuration, fmiVersion="3.0")
    return {"sources/buildDescription.xml": document(root)}


FMI3 = Standard(
    version="3.0",
    source="fmi3.c",
    describe=_describe,
    more=_build,
    folders={
        ("linux", "x86_64"): "x86_64-linux",
        ("linux", "aarch64"): "aarch64-linux",
        ("darwin", "x86_64"): "x86_64-darwin",
        ("darwin", "arm64"): "aarch64-darwin",
    },
)
