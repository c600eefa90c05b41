"""Expressions become a `Function`: inputs in contract order, ranges, guards, operation counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import sympy as sp

from modelgen.base_parameters import Grouping
from modelgen.functions.arguments import arguments
from modelgen.functions.objects import STATUS_STROKE, Argument, Function, InputRange, Output
from modelgen.functions.options import Options
from modelgen.graph import Expr, Program, count_operations, lower
from modelgen.graph import inputs as read_inputs
from modelgen.graph.from_sympy import from_sympy
from modelgen.model.equations import Equations
from modelgen.transmission import STROKE_MARGIN, Transmission

Result = tuple[Output, Sequence[Expr]]


@dataclass
class Assembly:
    """Parts that the functions of one arm share.

    real: equations with the frames as described. base: the same with the last links' frames at the
    foot of the common normal, where the base parameters live. more: inputs of one function alone, by name.
    """

    options: Options
    real: Equations
    base: Equations
    grouping: Grouping
    more: Mapping[str, Argument] = field(default_factory=dict)

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return self.real.n

    @cached_property
    def known(self) -> Mapping[str, Argument]:
        """Every possible input by name."""
        count = len(self.grouping.base)
        sizes = [
            ("parameters", count, "base parameters"),
            ("standard_parameters", len(self.real.standard), "standard parameters"),
        ]
        return {**arguments(self.real, sizes), **self.more}

    def function(
        self,
        name: str,
        text: str,
        inputs: Sequence[str],
        results: Sequence[Result],
        *,
        drives: bool = True,
        guards: Sequence[tuple[Expr, int]] = (),
        order: Sequence[tuple[str, int]] | None = None,
        stacked: bool = False,
        ranges: Sequence[InputRange] = (),
    ) -> Function:
        """A function of the named inputs. `drives`: it makes sense within the levers' strokes only; `ranges`:
        of other inputs.
        """
        outputs = {output.name: list(expressions) for output, expressions in results}
        if drives:
            guards = [*guards, *self.stroke_guards(inputs, results)]
        program = lower(outputs, guards, order)
        return Function(
            name,
            text,
            tuple(self._arguments(inputs, program)),
            tuple(output for output, _ in results),
            program,
            count_operations(program),
            (*(self.ranges(inputs) if drives else ()), *ranges),
            stacked,
        )

    def of_state(self, name: str, checked: bool = False) -> Output:
        """What a state that the caller keeps (see `steps`) is after a step. checked: as of `Output`."""
        a = self.known[name]
        return Output("state_next", a.size, 1, a.unit, "state after the step", a.length, checked)

    def _arguments(self, inputs: Sequence[str], program: Program) -> list[Argument]:
        names: list[str] = []
        for name in inputs:
            names.append(name)
            if name == "q" and self.options.sincos:
                names += ["sin_q", "cos_q"]
        if self.options.runtime_geometry and self.real.arm.symbols:
            names.append("geometry")
        used = {vector for statement in program.statements for vector, _ in read_inputs(statement.term)}
        names += [x for x in ("state", "time", "load", "ddq", "input") if x in used and x not in names]
        found = []
        for name in names:
            if name == "standard_parameters":  # the same place in every signature
                found.append(replace(self.known[name], name="parameters"))
            else:
                found.append(self.known[name])
        return found

    def ranges(self, inputs: Sequence[str]) -> tuple[InputRange, ...]:
        """Strokes of the levers, a little widened, on q or q_m where the function has it.

        With run-time geometry the range of q is not known before: `stroke_guards` replaces it.
        """
        result = []
        for n, drive in enumerate(self.real.drives):
            motor = drive.transmission.motor_range()
            # its geometry is then an input, see stroke_guards
            guarded = self.options.runtime_geometry and bool(drive.transmission.drive.runtime)
            if "q" in inputs and not guarded:
                joint = drive.transmission.joint_range()
                if joint:
                    result.append(_range("q", n, joint, STROKE_MARGIN))
            if motor and "q_m" in inputs:
                result.append(_range("q_m", n, motor, 1e-3 * (motor[1] - motor[0])))
        return tuple(result)

    def stroke_guards(self, inputs: Sequence[str], results: Sequence[Result]) -> list[tuple[Expr, int]]:
        """Guards for run-time geometry: each lever must be on its stroke and on its side."""
        if not self.options.runtime_geometry:
            return []
        graphs = {e.graph for _, expressions in results for e in expressions}
        guards = []
        for equations in (self.real, self.base):
            if equations.graph not in graphs:
                continue
            for n, drive in enumerate(equations.drives):
                t = drive.transmission
                tests = t.drive.guards(t.q) if "q" in inputs else t.drive.motor_guards(t.q_m)
                guards += [(self._of_drive(equations, n, t, test), STATUS_STROKE) for test in tests]
        return guards

    def _of_drive(self, equations: Equations, n: int, t: Transmission, expression: sp.Expr) -> Expr:
        graph = equations.graph
        return from_sympy(
            graph,
            expression,
            {**equations.scalars.symbols, t.q: graph.input("q", n), t.q_m: graph.input("q_m", n)},
            lambda angle: equations.trigonometry.lookup(n, t.q, angle),
        )


def _range(name: str, index: int, span: tuple[float, float], margin: float) -> InputRange:
    return InputRange(name, index, span[0] - margin, span[1] + margin, STATUS_STROKE)


def vector(name: str, size: int, unit: str, text: str) -> Output:
    """A column vector."""
    return Output(name, size, 1, unit, text)


def from_the_tips(names: Sequence[str], n: int) -> list[tuple[str, int]]:
    """An order of computation for n x n outputs: joint after joint from the last on, as the bodies beyond
    them are put together.

    Of each joint its column down to the diagonal, then its row: few of its values are alive at a time.
    """
    found: list[tuple[str, int]] = []
    for k in reversed(range(n)):
        found += [(name, n * row + k) for name in names for row in reversed(range(k + 1))]
        found += [(name, n * k + column) for name in names for column in reversed(range(k))]
    return found
