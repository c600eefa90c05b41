"""Fixed steps through the arm's compiled C."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.backends import Provenance, c_files
from modelgen.errors import InputError
from modelgen.functions import Function
from modelgen.graph import count_operations
from modelgen.native import shared_library
from modelgen.numeric import Array
from modelgen.simulation.plant import Plant

MAIN = "simulation.c"
# How a run may end: enumeration of driver.c.
ENDS = {
    1: "left its stroke or its limits",
    2: "its state is not finite: the steps are too long, or the motion unstable",
    3: "a joint that sticks has no friction",
    4: "dry friction changes its direction without end",
}


class Stepper:
    """Classical Runge-Kutta steps with constant inputs, ended and begun again where friction changes.

    A step ends where a joint comes to rest or tears loose, which is located to rounding. Raises RuntimeError
    without a C compiler.
    """

    def __init__(self, plant: Plant, low: Array, high: Array) -> None:
        self.plant = plant
        self.low, self.high = np.ascontiguousarray(low), np.ascontiguousarray(high)
        self.width = 2 * plant.n + len(plant.model.states)
        self.library = _library(plant)

    def begin(self, t: float, y: Array, u: Array) -> NDArray[np.intc]:
        """Modes of the contacts at the beginning."""
        modes = np.zeros(max(1, len(self.plant.slip.contacts)), dtype=np.intc)
        u = np.ascontiguousarray(u, dtype=float)
        status = self.library.begin(
            ctypes.c_double(t), _at(y), _at(u), _at(self.plant.parameters), _at(modes)
        )
        if status:
            raise InputError(f"at the beginning: {ENDS[status]}")
        return modes

    def run(
        self, t: float, step: float, substeps: int, y: Array, modes: NDArray[np.intc], inputs: Array
    ) -> tuple[Array, int]:
        """States (S, 2n + z) at the samples, the first that of `y` (2n + z,), and how it ended (0: well).

        inputs: (S - 1, n), each held over `substeps` steps of `step` [s]. `y` and `modes` move along.
        """
        samples = len(inputs) + 1
        path = np.empty((samples, self.width))
        done = ctypes.c_long()
        inputs = np.ascontiguousarray(inputs, dtype=float)
        status = self.library.run(
            ctypes.c_long(samples),
            ctypes.c_long(substeps),
            ctypes.c_double(t),
            ctypes.c_double(step),
            _at(inputs),
            ctypes.c_long(self.plant.n),
            _at(self.plant.parameters),
            _at(self.low),
            _at(self.high),
            _at(y),
            _at(modes),
            _at(path),
            ctypes.byref(done),
        )
        return path[: done.value], int(status)


def _at(x: NDArray[np.generic]) -> ctypes.c_void_p:
    return ctypes.c_void_p(x.ctypes.data)


def _library(plant: Plant) -> ctypes.CDLL:
    return shared_library(sources(plant), MAIN)


def sources(plant: Plant, more: Sequence[Function] = ()) -> dict[str, str]:
    """C of the steps by path, of which MAIN includes the others. more: functions besides."""
    own = plant.slip
    functions = [own.accelerations, *([own.rates] if own.rates else []), *more]
    bounded = tuple(_bounded(f) for f in functions)
    model = replace(own.model, functions=bounded)
    files = c_files(model, Provenance("simulation", "0" * 64))
    name = plant.arm.name
    generated = [f for f in files if f.endswith(".c")]
    driver = Path(__file__).with_name("driver.c").read_text(encoding="utf-8")
    lines = [f'#include "{source}"' for source in generated]
    lines += _definitions(plant)
    lines += [_call("slip", f"{name}_{own.accelerations.name}", own.accelerations, acceleration=False)]
    rates = own.rates
    lines += [
        _call("drift", f"{name}_{rates.name}", rates)
        if rates
        else "static int drift(double t, const double *q, const double *dq, const double *ddq, "
        "const double *u, const double *p, const double *z, double *out) { "
        "(void)t, (void)q, (void)dq, (void)ddq, (void)u, (void)p, (void)z, (void)out; return 0; }"
    ]
    files[MAIN] = "\n".join([*lines, driver])
    return files


def _definitions(plant: Plant) -> list[str]:
    rows = plant.slip.contacts
    table: Sequence[Sequence[float]] = rows.tolist() if len(rows) else [[0.0] * plant.n]
    listed = ", ".join("{" + ", ".join(repr(float(x)) for x in row) + "}" for row in table)
    own = ", ".join(str(k) for k in plant.own) if plant.own else "-1"
    return [
        f"enum {{ N = {plant.n}, C = {len(rows)}, Z = {len(plant.model.states)} }};",
        f"static const double ROWS[][{plant.n}] = {{{listed}}};",
        f"static const int OWN[] = {{{own}}};",
    ]


def _call(name: str, function: str, made: Function, *, acceleration: bool = True) -> str:
    """A function of the simulation over the generated one, which takes all inputs that it may have."""
    given = {"input": "u", "parameters": "p", "state": "z", "time": "&t", "q": "q", "dq": "dq"}
    given["ddq"] = "ddq" if acceleration else "zeros"
    arguments = ", ".join(given.get(a.name, "zeros") for a in made.arguments)
    ddq = "const double *ddq, " if acceleration else ""
    most = max(a.size for a in made.arguments)
    return (
        f"static int {name}(double t, const double *q, const double *dq, {ddq}const double *u, "
        f"const double *p, const double *z, double *out) {{ static const double zeros[{most}] = {{0.0}}; "
        f"(void)t; (void)z; (void)zeros; return {function}({arguments}, out); }}"
    )


def _bounded(function: Function) -> Function:
    """Bounds as the emitted functions have them: what is beyond is no state of an arm."""
    arguments = tuple(replace(a, bound=1e9) for a in function.arguments)
    return replace(function, arguments=arguments, operations=count_operations(function.program))
