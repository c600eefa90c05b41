"""Evaluation of emitted functions in NumPy, vectorised over samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from modelgen.functions.objects import Function
from modelgen.graph import Program, Term, read
from modelgen.numeric import Array

_CHUNK = 4096  # samples at a time: the live values then stay in the processor's cache


def _select(condition: Any, one: Any, other: Any, out: Array) -> None:
    out[...] = np.where(condition > 0.0, one, other)


def _store(value: Any, out: Array) -> None:
    out[...] = value


_CALLS: Mapping[str, Callable[..., Any]] = {
    "": _store,
    "select": _select,
    "neg": np.negative,
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": np.log,
    "tanh": np.tanh,
    "abs": np.abs,
    "sign": np.sign,
    "pow": np.power,
    "min": np.minimum,
    "max": np.maximum,
}


class NumpyFunction:
    """A function of a model, to be called with arrays.

    An input of size m is an array of shape (N, m) with one row per sample, or (m,) where it is the same
    for all samples. With N samples an output of r x c elements has the shape (N, r, c), or (N, r) where
    c is 1; without samples (every input one-dimensional) the first axis is missing. Several outputs come
    as a tuple. Units are those of the function's arguments. The inputs are not checked against ranges:
    where C would report a status, the result is NaN or extrapolated.
    """

    def __init__(self, function: Function) -> None:
        self.function = function
        self._tape = _tape(function.program)

    def __call__(self, *args: ArrayLike, **kwargs: ArrayLike) -> Any:
        """The outputs; inputs by position or by name.

        Raises TypeError for a missing or unknown input, ValueError for one of the wrong shape.
        """
        inputs, samples = self._inputs(args, kwargs)
        count = 1 if samples is None else samples
        results = {o.name: np.empty((count, o.size)) for o in self.function.outputs}
        # Samples run along the last axis inside a chunk, so that every operation reads memory in order.
        length = min(count, _CHUNK)
        registers = np.empty((self._tape.registers, length))
        columns = {o.name: np.zeros((o.size, length)) for o in self.function.outputs}
        with np.errstate(all="ignore"):
            for begin in range(0, count, _CHUNK):
                end = min(begin + _CHUNK, count)
                part = {
                    name: np.ascontiguousarray((x[begin:end] if len(x) > 1 else x).T)
                    for name, x in inputs.items()
                }
                used = slice(0, end - begin)
                _run(self._tape, part, registers[:, used], {n: c[:, used] for n, c in columns.items()})
                for name, column in columns.items():
                    results[name][begin:end] = column[:, used].T
        shaped = []
        for output in self.function.outputs:
            shape = (output.rows, output.columns) if output.columns > 1 else (output.rows,)
            lead = () if samples is None else (samples,)
            shaped.append(results[output.name].reshape(lead + shape))
        return shaped[0] if len(shaped) == 1 else tuple(shaped)

    def _inputs(
        self, args: tuple[ArrayLike, ...], kwargs: dict[str, ArrayLike]
    ) -> tuple[dict[str, Array], int | None]:
        expected = [a.name for a in self.function.arguments]
        if len(args) > len(expected):
            raise TypeError(f"{self._call()}: found {len(args)} inputs, expected {len(expected)}")
        given = dict(zip(expected, args, strict=False))
        for name, value in kwargs.items():
            if name not in expected or name in given:
                raise TypeError(f"{self._call()}: {name} is {'given twice' if name in given else 'no input'}")
            given[name] = value
        missing = [name for name in expected if name not in given]
        if missing:
            raise TypeError(f"{self._call()}: {', '.join(missing)} missing")
        arrays: dict[str, Array] = {}
        samples: int | None = None
        for argument in self.function.arguments:
            array = np.asarray(given[argument.name], dtype=np.float64)
            if array.ndim not in (1, 2) or array.shape[-1] != argument.size:
                raise ValueError(
                    f"{self._call()}: {argument.name} has the shape {array.shape}, "
                    f"expected ({argument.size},) or (N, {argument.size})"
                )
            if array.ndim == 2:
                if samples not in (None, len(array)):
                    raise ValueError(
                        f"{self._call()}: {argument.name} has {len(array)} samples, another input {samples}"
                    )
                samples = len(array)
            arrays[argument.name] = np.atleast_2d(array)
        return arrays, samples

    def _call(self) -> str:
        return f"{self.function.name}({', '.join(a.name for a in self.function.arguments)})"


# An operand: a number, the register that holds it, or an element of an input.
_Operand: TypeAlias = float | int | tuple[str, int]


@dataclass(frozen=True)
class _Step:
    """One operation into a register, or (`operation` empty) one operand into an element of an output."""

    operation: str
    operands: tuple[_Operand, ...]
    register: int
    output: tuple[str, int] | None = None


@dataclass(frozen=True)
class _Tape:
    """Operations on places: registers, then elements of outputs, numbers, elements of inputs.

    steps: what is called, the places of its operands, the place of its result.
    """

    steps: tuple[tuple[Callable[..., Any], tuple[int, ...], int], ...]
    registers: int
    outputs: tuple[tuple[str, int], ...]
    numbers: tuple[float, ...]
    inputs: tuple[tuple[str, int], ...]


def _tape(program: Program) -> _Tape:
    """The program with a place for everything, so that a run looks nothing up."""
    steps, registers = _steps(program)
    operands = [o for step in steps for o in step.operands]
    outputs = list(dict.fromkeys(step.output for step in steps if step.output is not None))
    numbers = list(dict.fromkeys(repr(o) for o in operands if isinstance(o, float)))  # 0.0 is not -0.0
    inputs = list(dict.fromkeys(o for o in operands if isinstance(o, tuple)))
    first = registers + len(outputs)
    of_number = {text: first + k for k, text in enumerate(numbers)}
    of_input = {element: first + len(numbers) + k for k, element in enumerate(inputs)}

    def place(o: _Operand) -> int:
        return o if isinstance(o, int) else of_number[repr(o)] if isinstance(o, float) else of_input[o]

    placed = [
        (
            _CALLS[step.operation],
            tuple(place(o) for o in step.operands),
            step.register if step.output is None else registers + outputs.index(step.output),
        )
        for step in steps
    ]
    return _Tape(tuple(placed), registers, tuple(outputs), tuple(map(float, numbers)), tuple(inputs))


def _steps(program: Program) -> tuple[list[_Step], int]:
    """Operations on registers, and how many; a register is free again after its value's last use."""
    last_use: dict[int, int] = {}
    wanted = [s for s in program.statements if not (isinstance(s.target, tuple) and s.target[0] == "guard")]
    for position, statement in enumerate(wanted):
        for number in read(statement.term):
            last_use[number] = position
    steps: list[_Step] = []
    free: list[int] = []
    holder: dict[int, int] = {}
    count = 0

    def evaluate(term: Term) -> _Operand:
        nonlocal count
        tag = term[0]
        if tag == "const":
            return float(term[1])
        if tag == "in":
            return term[1], term[2]
        if tag == "let":
            return holder[term[1]]
        parts = term[2:] if tag == "call" else term[1:]
        operands = tuple(evaluate(part) for part in parts)
        for part, operand in zip(parts, operands, strict=True):
            if part[0] not in ("const", "in", "let"):
                assert isinstance(operand, int)
                free.append(operand)
        if not free:
            free.append(count)
            count += 1
        register = free.pop()
        steps.append(_Step(term[1] if tag == "call" else tag, operands, register))
        return register

    for position, statement in enumerate(wanted):
        value = evaluate(statement.term)
        if isinstance(statement.target, int):
            if not isinstance(value, int) or statement.term[0] == "let":
                raise ValueError(f"t{statement.target} names what has a name already")
            holder[statement.target] = value
            last_use.setdefault(statement.target, position)
        else:
            steps.append(_Step("", (value,), -1, statement.target))
            if isinstance(value, int) and statement.term[0] != "let":
                free.append(value)
        used = {*read(statement.term), *([statement.target] if isinstance(statement.target, int) else [])}
        free += [holder[number] for number in sorted(used) if last_use[number] == position]
    return steps, count


def _run(tape: _Tape, inputs: Mapping[str, Array], registers: Array, results: Mapping[str, Array]) -> None:
    """All steps for one chunk of samples."""
    places: list[Any] = [
        *registers,
        *(results[name][k] for name, k in tape.outputs),
        *tape.numbers,
        *(inputs[name][k] for name, k in tape.inputs),
    ]
    for call, operands, result in tape.steps:
        if len(operands) == 2:
            call(places[operands[0]], places[operands[1]], out=places[result])
        else:
            call(*[places[o] for o in operands], out=places[result])
