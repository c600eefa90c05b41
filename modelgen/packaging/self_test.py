"""A program that compares every function with values computed here, on the host or on the target."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from decimal import Decimal, localcontext

import numpy as np
import sympy as sp

from modelgen.backends.c.dialect import arrays
from modelgen.backends.exact import CALLS, CONTEXT, ExactFunction
from modelgen.backends.provenance import Provenance
from modelgen.backends.text import render, wrapped_code
from modelgen.functions.objects import Argument, Function, Model
from modelgen.numeric import Array

STATES = 3
# Relative to the sum of the magnitudes; a solution of linear equations is allowed its condition too.
TOLERANCE = ((float(np.finfo(np.float32).eps), 1e-4), (float(np.finfo(np.float64).eps), 1e-11))  # eps, bound
_LEAST = 1e-6  # magnitude below which the differences are compared with it instead


# Values of inputs that a step takes, the same for every element.
STEP: Mapping[str, float] = {
    "dt": 0.001,
    "state": 0.001,
    "effect_state": 0.001,
    "gain": 30.0,
    "forgetting": 0.99,
}


def self_test(model: Model, provenance: Provenance) -> str:
    """The program's text."""
    arm = model.arm.name
    inputs: dict[str, Array] = {}
    checks: list[str] = []
    exact = {f.name: ExactFunction(f) for f in model.functions}
    for f in model.functions:
        for state in range(STATES):
            names, given = [], {}
            for a in f.arguments:
                name, given[a.name] = _input(model, f, a, state)
                inputs.setdefault(name, given[a.name])
                names.append(name)
            expected = exact[f.name](given)
            if expected is not None:
                condition = _condition(exact, f, given)
                checks.append(_check(model.arm.name, f, names, expected, condition, len(checks) + 1))
    declared = [
        wrapped_code(f"static const {arm}_real_t {name}[] = {{{_listed(value)}}};", "", "    ")
        for name, value in inputs.items()
    ]
    return render(
        "package/self_test.c.j2",
        arm=arm,
        macro=arm.upper(),
        provenance=provenance.head(arm),
        count=STATES,
        arrays=declared,
        largest=max(sum(arrays(f).values()) for f in model.functions),
        checks=checks,
    )


def _check(
    arm: str, f: Function, names: Sequence[str], expected: Sequence[Decimal], condition: float, number: int
) -> str:
    """The call of a function and the comparison of its result."""
    with localcontext(CONTEXT):
        weighted = [x * (1 + k % 7) for k, x in enumerate(expected)]
        total, magnitude = float(sum(weighted)), float(sum(map(abs, weighted)))
    single, double = (
        max(tolerance, 50 * eps * condition) * max(magnitude, _LEAST) for eps, tolerance in TOLERANCE
    )
    offset, outputs = 0, []
    for size in arrays(f).values():
        outputs.append(f"out + {offset}" if offset else "out")
        offset += size
    call = f"status = {arm}_{f.name}({', '.join([*names, *outputs])});"
    numbers = f"C({total!r}), C({magnitude!r})"
    test = f"if (!agrees(status, {len(expected)}, {numbers}, either(C({single:.3g}), C({double:.3g})))) {{"
    lines = [wrapped_code(call, "    ", "        "), wrapped_code(test, "    ", "        ")]
    return "\n".join([*lines, f"        return {number};", "    }"])


def _condition(exact: Mapping[str, ExactFunction], f: Function, given: Mapping[str, Array]) -> float:
    """Condition number of the mass matrix that a forward dynamics solves with, 0 elsewhere."""
    name = next((n for n in (f.name, *f.parts) if n.startswith("forward_dynamics")), None)
    if name is None:
        return 0.0
    suffix = name.removeprefix("forward_dynamics").removeprefix("_derivatives")
    elements = exact[f"mass_matrix{suffix}"](given)
    if elements is None:
        return 0.0
    n = math.isqrt(len(elements))
    return float(np.linalg.cond(np.reshape([float(x) for x in elements], (n, n))))


def _input(model: Model, f: Function, a: Argument, state: int) -> tuple[str, Array]:
    """Name of the array and its values."""
    if a.name == "parameters":
        standard = _standard(model)
        if f.name.endswith("_standard"):
            return "standard_parameters", standard
        return "parameters", _base(model, standard)
    if a.name == "geometry":
        return "geometry", np.array([float(model.arm.symbols[name]) for name in model.geometry])
    if a.length:
        return a.length.removeprefix("N_").lower(), np.array([_accumulated(a, k) for k in range(a.size)])
    if a.name in STEP:
        return a.name, np.full(a.size, STEP[a.name])
    name = f"{a.name}_{state}"
    if a.name in ("sin_q", "cos_q"):
        q = _span(model, "q", a.size, state)
        function = CALLS["sin" if a.name == "sin_q" else "cos"]
        return name, np.array([float(function(Decimal(float(x)))) for x in q])
    return name, _span(model, a.name, a.size, state)


def _accumulated(a: Argument, k: int) -> float:
    """An element of a state that a function carries along: a matrix within it is one that can be solved."""
    return 1.0 if k in a.diagonal else 0.001


def _span(model: Model, name: str, size: int, state: int) -> Array:
    """Values spread over the element's range, the same in every generation; (-1, 1) where it has none."""
    spans = [(-1.0, 1.0)] * size
    if name == "q":
        limits = (model.arm.joints[i].limits.position for i in model.arm.coordinates)
        spans = [(-2.0, 2.0) if limit is None else limit for limit in limits]
    # One array serves all functions, those that work beyond a lever's stroke too.
    for r in (r for f in model.functions for r in f.ranges):
        if r.argument == name:
            spans[r.index] = (r.low, r.high)
    shift = len(name)
    parts = [((5 * i + 7 * state + shift) % 16 + 0.5) / 16 for i in range(size)]
    return np.array([round(low + (high - low) * x, 5) for (low, high), x in zip(spans, parts, strict=True)])


def _standard(model: Model) -> Array:
    """Standard parameters of bodies that could exist: 2 kg, centres of mass a hand's breadth off the axes."""
    values: dict[str, float] = {}
    for i, joint in enumerate(model.arm.joints):
        mass, com = 2.0, (0.1, 0.05 + 0.01 * i, -0.08)
        x, y, z = com
        moments = {"XX": y * y + z * z, "YY": x * x + z * z, "ZZ": x * x + y * y}
        products = {"XY": -x * y, "XZ": -x * z, "YZ": -y * z}
        values |= {f"{k}{i + 1}": 0.02 + mass * v for k, v in moments.items()}
        values |= {f"{k}{i + 1}": mass * v for k, v in products.items()}
        values |= {f"M{axis}{i + 1}": mass * c for axis, c in zip("XYZ", com, strict=True)}
        values[f"M{i + 1}"] = mass
        values[f"IA{i + 1}"] = joint.drive.typical_inertia
    return np.array([float(f"{values.get(p.name, 0.015):.6g}") for p in model.standard])


def _base(model: Model, standard: Array) -> Array:
    symbols: Mapping[str, float] = model.arm.symbols
    found = []
    for base in model.grouping.base:
        total = 0.0
        for i, factor in base.terms:
            given = {s: symbols[str(s)] for s in factor.free_symbols} if isinstance(factor, sp.Expr) else {}
            total += float(factor.subs(given) if isinstance(factor, sp.Expr) else factor) * standard[i]
        found.append(float(f"{total:.9g}"))
    return np.array(found)


def _listed(values: Array) -> str:
    return ", ".join(f"C({float(v)!r})" for v in values)
