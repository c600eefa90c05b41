"""Functions at the nearest point of the strokes: what they are called with is moved there first."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.backends.c.dialect import INDENT, arrays, literal
from modelgen.backends.c.lengths import argument_length, array_lengths
from modelgen.backends.text import wrapped_code
from modelgen.functions.objects import STATUS_STROKE, Argument, Function, InputRange, Model

NEAREST = "_nearest"  # suffix of the functions
# Functions that move an input onto the strokes, by the input.
ONTO = {"q": "onto_strokes", "q_m": "motors_onto_strokes"}


@dataclass(frozen=True)
class End:
    """Ends of a stroke: element of the input, and literals."""

    index: int
    low: str
    high: str


@dataclass(frozen=True)
class Stroke:
    """A function that moves an input onto the strokes. limit: of the input's norm, squared."""

    name: str
    argument: str
    text: str
    size: str
    limit: str
    signature: str
    ends: tuple[End, ...]


@dataclass(frozen=True)
class Wrapper:
    """An inline function that calls another one at the nearest point of the strokes."""

    name: str
    argument: str
    stroke: str
    size: str
    signature: str
    call: str


def strokes(model: Model) -> list[Stroke]:
    """One for each input that has a range. Raises ValueError as `literal` does."""
    arm = model.arm.name
    found: dict[str, Stroke] = {}
    for function in model.functions:
        for argument, ranges in _ranged(function):
            if argument.name in found:
                continue
            size = argument_length(model, function, argument)
            name = ONTO[argument.name]
            signature = (
                f"{arm}_status_t {arm}_{name}(\n{INDENT}const {arm}_real_t {argument.name}[{size}],\n"
                f"{INDENT}{arm}_real_t nearest[{size}])"
            )
            limit = literal(arm, argument.bound**2)
            ends = tuple(End(r.index, literal(arm, r.low), literal(arm, r.high)) for r in ranges)
            found[argument.name] = Stroke(name, argument.name, argument.text, size, limit, signature, ends)
    return list(found.values())


def wrappers(model: Model) -> list[Wrapper]:
    """One for each function that has such an input."""
    arm = model.arm.name
    found = []
    for function in model.functions:
        for argument, _ in _ranged(function):
            declared = [
                f"const {arm}_real_t {a.name}[{argument_length(model, function, a)}]"
                for a in function.arguments
            ]
            lengths = array_lengths(model, function)
            declared += [f"{arm}_real_t {name}[{length}]" for name, length in lengths.items()]
            listed = ",\n".join(f"{INDENT}{one}" for one in declared)
            given = ["nearest" if a is argument else a.name for a in function.arguments]
            call = f"return beyond | {arm}_{function.name}({', '.join([*given, *arrays(function)])});"
            found.append(
                Wrapper(
                    function.name,
                    argument.name,
                    ONTO[argument.name],
                    argument_length(model, function, argument),
                    f"{arm}_status_t {arm}_{function.name}{NEAREST}(\n{listed})",
                    wrapped_code(call, INDENT, INDENT * 2),
                )
            )
    return found


def _ranged(function: Function) -> list[tuple[Argument, list[InputRange]]]:
    """The inputs that must lie within strokes."""
    found = []
    for argument in function.arguments:
        own = [r for r in function.ranges if r.argument == argument.name and r.status == STATUS_STROKE]
        if own:
            found.append((argument, own))
    return found
