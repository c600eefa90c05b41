"""What the versions of the standard have in common: what is described, and lines of a description."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from modelgen.exporting.fmu.variables import Variable
from modelgen.exporting.xml_lines import element


@dataclass(frozen=True)
class Described:
    """A unit. guid: its name for machines; listed: its variables; table: lines of a comment; main: source."""

    name: str
    source: str
    guid: str
    listed: Sequence[Variable]
    table: Sequence[str]
    main: str

    def numbers(self, which: Callable[[Variable], bool]) -> list[int]:
        """Numbers from 0 of some of the variables: their value references."""
        return [k for k, variable in enumerate(self.listed) if which(variable)]

    def units(self) -> list[str]:
        """The element of the units that occur."""
        names = sorted({v.unit for v in self.listed if v.unit})
        return element("UnitDefinitions", [line for name in names for line in element("Unit", name=name)])


@dataclass(frozen=True)
class Standard:
    """A version of the standard.

    source: its C. describe: gives modelDescription.xml. more: further files by path, from the unit's name and
    its main source. folders: of compiled libraries, by system and processor.
    """

    version: str
    source: str
    describe: Callable[[Described], str]
    more: Callable[[str, str], Mapping[str, str]]
    folders: Mapping[tuple[str, str], str]

    @property
    def title(self) -> str:
        """What people call such a file."""
        return f"FMU (FMI {self.version})"


EXPERIMENT = element("DefaultExperiment", startTime="0", stopTime="1", stepSize="0.001")


def is_output(v: Variable) -> bool:
    """Whether it is one."""
    return v.causality == "output"


def is_rate(v: Variable) -> bool:
    """Whether it is the time derivative of a state."""
    return v.rate_of is not None


def initial(v: Variable) -> str | None:
    """How it gets its first value, where it is not given."""
    return "calculated" if v.causality in ("output", "local") else None


def document(root: Sequence[str]) -> str:
    """The text of a file."""
    return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', *root]) + "\n"
