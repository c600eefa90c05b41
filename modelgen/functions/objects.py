"""Objects that are emitted: functions as programs with named inputs and outputs, and their model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from modelgen.base_parameters import Grouping
from modelgen.description.objects import Arm
from modelgen.graph import Program
from modelgen.model.parameters import StandardParameter

STATUS_STROKE = 1  # a lever has left its stroke
STATUS_PIVOT = 2  # a pivot of the mass matrix has vanished
# Least pivot of a mass matrix [kg m^2, kg]: its reciprocal is bounded, which a proof can use.
SMALLEST_PIVOT = 1e-12
STATUS_INPUT = 4  # an input is not finite or beyond its bound


def least_guarded(status: int) -> float:
    """Bounds that guarded values must exceed for a function to go on."""
    return SMALLEST_PIVOT if status == STATUS_PIVOT else 0.0


@dataclass(frozen=True)
class Argument:
    """An input vector. `bound` is the largest magnitude of an element that is accepted.

    elements: what each element is, where that differs and no other list says it. length: the size macro of
    a vector that has one of its own. diagonal: elements that are the diagonal of a matrix, if any.
    """

    name: str
    size: int
    unit: str
    text: str
    bound: float
    elements: tuple[str, ...] = ()
    length: str = ""
    diagonal: tuple[int, ...] = ()


@dataclass(frozen=True)
class Output:
    """An output: rows x columns, row-major where it is a flat array.

    length: as of `Argument`. checked: whether what comes out may be no number, so that it has to be tested.
    """

    name: str
    rows: int
    columns: int
    unit: str
    text: str
    length: str = ""
    checked: bool = False

    @property
    def size(self) -> int:
        """Number of elements."""
        return self.rows * self.columns


@dataclass(frozen=True)
class InputRange:
    """An element of an input must stay within [low, high], else `status` is set."""

    argument: str
    index: int
    low: float
    high: float
    status: int


@dataclass(frozen=True)
class Function:
    """One emitted function.

    Elements of an output that `program` does not set are zero. A statement ("guard", bit) of the
    program demands that its term is positive. With `stacked` the outputs are one array where a
    backend knows arrays only. `parts` names the functions whose work it does at once, if it does.
    """

    name: str
    text: str
    arguments: tuple[Argument, ...]
    outputs: tuple[Output, ...]
    program: Program
    operations: Mapping[str, int]
    ranges: tuple[InputRange, ...] = ()
    stacked: bool = False
    parts: tuple[str, ...] = ()

    def reads(self, *names: str) -> bool:
        """Whether one of the arguments has one of these names."""
        return any(a.name in names for a in self.arguments)


@dataclass(frozen=True)
class SparsityTable:
    """Rows and columns (from 0) of the structural non-zeros of the regressor, row after row."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


@dataclass(frozen=True)
class Levels:
    """For the observer by joint: gain [1/s], threshold [N m, N].

    For the monitor by parameter: its name; start, what it is where nothing changed; std, what identification
    leaves open of it. correlation: time over which errors of the inputs stay alike [s]; memory [s]; level:
    standard deviations.
    """

    gain: tuple[float, ...]
    threshold: tuple[float, ...]
    names: tuple[str, ...]
    start: tuple[float, ...]
    std: tuple[float, ...]
    correlation: float
    memory: float
    level: float


@dataclass(frozen=True)
class Model:
    """Everything that a backend needs of one arm."""

    arm: Arm
    standard: tuple[StandardParameter, ...]
    grouping: Grouping
    functions: tuple[Function, ...]
    packed: SparsityTable
    geometry: tuple[str, ...] = ()  # names of the run-time geometry, in the order of its input
    states: tuple[str, ...] = ()  # names of the effects' states
    nominal: tuple[float, ...] = ()  # values of the base parameters, where they were asked for
    levels: Levels | None = None  # of the functions that watch, where noise is known
    batch: tuple[str, ...] = ()  # names of functions that are wanted over many states too
    remarks: tuple[str, ...] = ()  # for the user: what can be told apart, and what cannot

    def function(self, name: str) -> Function:
        """The function of this name. Raises StopIteration where the arm has none."""
        return next(f for f in self.functions if f.name == name)
