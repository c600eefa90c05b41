"""The expression graph: programs mean what the arithmetic says, exactly."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy as sp
from backends_support import function as emitted
from hypothesis import given, settings
from hypothesis import strategies as st
from witness.program import run

from modelgen.backends import NumpyFunction
from modelgen.functions import Argument, Output
from modelgen.graph import Expr, Graph, Program, count_operations, lower
from modelgen.graph.evaluate import evaluate
from modelgen.graph.from_sympy import from_sympy

INPUTS = 4
# constants whose sums, products and quotients are exact in floating point
CONSTANTS = [0.0, 1.0, -1.0, 2.0, 0.5, -4.0, 3.0, -0.25]
DIVISORS = [1.0, -1.0, 2.0, -0.5, 4.0]
ARITHMETIC = ["add", "sub", "mul", "div", "neg", "scale", "shift", "shrink", "from", "over"]
FUNCTIONS = ["abs", "sign", "min", "max", "select"]

# An operation and its operands, taken modulo what exists already.
step = st.tuples(st.sampled_from(ARITHMETIC + FUNCTIONS), st.integers(0, 40), st.integers(0, 40))
recipes = st.lists(step, min_size=1, max_size=30)
points = st.lists(st.fractions(-3, 3, max_denominator=5), min_size=INPUTS, max_size=INPUTS)
EXACT: dict[str, Callable[..., Any]] = {
    "abs": abs,
    "sign": lambda x: Fraction((x > 0) - (x < 0)),
    "min": min,
    "max": max,
    "select": lambda c, a, b: a if c > 0 else b,
}


class Pair:
    """A value of the graph beside the exact number that it stands for."""

    def __init__(self, expr: Expr, number: Fraction) -> None:
        self.expr = expr
        self.number = number


def apply(name: str, j: int, a: Pair, b: Pair, c: Pair) -> Pair:
    """One step of a recipe, once in the graph and once in fractions."""
    constant, divisor = CONSTANTS[j % len(CONSTANTS)], DIVISORS[j % len(DIVISORS)]
    exact = Fraction(constant)
    x, y, u, v = a.expr, b.expr, a.number, b.number
    if name in FUNCTIONS:
        count = {"abs": 1, "sign": 1, "min": 2, "max": 2, "select": 3}[name]
        chosen = (a, b, c)[:count]
        expr = x.graph.call(name, *(p.expr for p in chosen))
        return Pair(expr, Fraction(EXACT[name](*(p.number for p in chosen))))
    if name == "div":  # by what is never zero; a constant must divide exactly
        if y.value is not None:
            return Pair(x / 2.0, u / 2)
        return Pair(x / (y * y + 1), u / (v * v + 1))
    if name == "over":
        if x.value is not None:
            return Pair(-x, -u)
        return Pair(constant / (x * x + 1), exact / (u * u + 1))
    return {
        "add": lambda: Pair(x + y, u + v),
        "sub": lambda: Pair(x - y, u - v),
        "mul": lambda: Pair(x * y, u * v),
        "neg": lambda: Pair(-x, -u),
        "scale": lambda: Pair(constant * x, exact * u),
        "shift": lambda: Pair(x + constant, u + exact),
        "shrink": lambda: Pair(x / divisor, u / Fraction(divisor)),
        "from": lambda: Pair(constant - x, exact - u),
    }[name]()


def made(recipe: list[tuple[str, int, int]], point: list[Fraction]) -> list[Pair]:
    """All values of a recipe, the last ones the most involved."""
    graph = Graph()
    return follow(recipe, [Pair(graph.input("x", k), value) for k, value in enumerate(point)])


def follow(recipe: list[tuple[str, int, int]], start: list[Pair]) -> list[Pair]:
    """`start` and what the recipe's steps make of it."""
    pairs = list(start)
    for name, i, j in recipe:
        a, b, c = (pairs[k % len(pairs)] for k in (i, j, i + j))
        pairs.append(apply(name, j, a, b, c))
    return pairs


def outputs(pairs: list[Pair]) -> list[Expr]:
    return [pair.expr for pair in pairs]


def runnable(program: Program, size: int) -> NumpyFunction:
    """A bare program in the NumPy backend."""
    graph = Graph()
    hull = emitted(
        "f", [Argument("x", INPUTS, "", "", 1e9)], [Output("y", size, 1, "", "")], {"y": [graph.one]}
    )
    return NumpyFunction(replace(hull, program=program))


@settings(max_examples=300)
@given(recipes, points)
def test_programs_compute_what_the_arithmetic_says(
    recipe: list[tuple[str, int, int]], point: list[Fraction]
) -> None:
    """Exactly, in fractions: no sign, order or shared value may be wrong."""
    pairs = made(recipe, point)[-6:]
    program = lower({"y": outputs(pairs)})
    done = run(program, {"x": point}, Fraction, EXACT)
    for k, pair in enumerate(pairs):
        assert done.outputs.get(("y", k), 0) == pair.number
    counts = count_operations(program)
    assert counts["add"] == done.done["add"] + done.done["sub"]
    assert all(counts[kind] == done.done[kind] for kind in ("mul", "neg", "div"))


@settings(max_examples=100)
@given(recipes, points)
def test_numpy_runs_programs_as_they_stand(recipe: list[tuple[str, int, int]], point: list[Fraction]) -> None:
    """The same floating-point numbers as statement by statement; `evaluate` to rounding."""
    pairs = made(recipe, point)[-6:]
    expressions = outputs(pairs)
    program = lower({"y": expressions})
    x = [float(value) for value in point]
    done = run(program, {"x": x})
    expected = [done.outputs.get(("y", k), 0.0) for k in range(len(pairs))]
    np.testing.assert_array_equal(runnable(program, len(pairs))(np.array(x)), expected)
    size = max(abs(p.number) for p in pairs)
    found = evaluate(expressions, {"x": np.array([x])}, 1)[0]
    if all(name not in FUNCTIONS for name, _, _ in recipe):  # a sign may hang on rounding
        np.testing.assert_allclose(found, [float(p.number) for p in pairs], atol=1e-9 * float(size) + 1e-9)


@settings(max_examples=150)
@given(recipes, points)
def test_the_same_values_again_are_the_same_nodes(
    recipe: list[tuple[str, int, int]], point: list[Fraction]
) -> None:
    """Nothing is computed twice, and negations stand at outputs and before functions only."""
    pairs = made(recipe, point)
    graph = pairs[0].expr.graph
    nodes = len(graph)
    again = follow(recipe, pairs[:INPUTS])
    assert [pair.expr.key for pair in again] == [pair.expr.key for pair in pairs]
    assert len(graph) == nodes
    counts = count_operations(lower({"y": outputs(pairs)}))
    assert counts["add"] + counts["mul"] + counts["div"] < nodes
    functions = sum(name in FUNCTIONS for name, _, _ in recipe)
    assert counts["neg"] <= len(pairs) + 3 * functions


# -- identities that hold by construction ----------------------------------------------------


def leaves(count: int = 4) -> list[Expr]:
    graph = Graph()
    return [graph.input("x", k) for k in range(count)]


def operations(*expressions: Expr) -> dict[str, int]:
    counted = count_operations(lower({"y": expressions}))
    return {kind: n for kind, n in counted.items() if n}


def test_a_difference_and_its_negative_are_one_node() -> None:
    a, b, *_ = leaves()
    assert (a - b).key == (b - a).key ^ 1
    assert (-a - b).key == (a + b).key ^ 1
    assert ((a - b) * (b - a)).key == ((a - b) * (a - b)).key ^ 1
    assert operations(a - b, b - a) == {"add": 1, "neg": 1}


def test_sums_and_products_commute() -> None:
    a, b, *_ = leaves()
    assert (a + b).key == (b + a).key
    assert (a * b).key == (b * a).key
    assert (a * -b).key == (-(a * b)).key


def test_zeros_ones_and_constants_disappear() -> None:
    a, b, *_ = leaves()
    assert (a + 0).key == (1 * a).key == (a - 0.0).key == (a / 1).key == a.key
    assert (a * 0).is_zero
    assert (a - a).is_zero
    assert (0 / (a + 1)).is_zero
    assert (a / a).value == 1.0
    assert (a / -a).value == -1.0
    assert (-1 * a).key == (-a).key
    assert (2 * (3 * a)).key == (6 * a).key
    assert (2 * a + 3 * a).key == (5 * a).key
    assert (2 * a - 2 * a).is_zero
    assert ((a + b) - b).key == a.key
    assert (b - (a + b)).key == (-a).key


def test_negations_vanish_into_the_signs_of_sums() -> None:
    a, b, c, d = leaves()
    assert operations(-(a - b)) == {"add": 1}
    assert operations(-(a - b) * c) == {"add": 1, "mul": 1}
    assert operations(-(2 * a * b)) == {"mul": 2}
    assert operations(-a * b - c * d) == {"mul": 2, "add": 1, "neg": 1}
    assert operations(-a) == {"neg": 1}
    assert operations(-(a * b)) == {"mul": 1, "neg": 1}
    assert operations(c * (a - b), d * (b - a)) == {"add": 1, "mul": 2, "neg": 1}


def test_odd_and_even_functions_take_the_sign_out() -> None:
    a, b, *_ = leaves()
    call = a.graph.call
    for name in ("sin", "tan", "asin", "atan", "tanh", "sign"):
        assert call(name, a - b).key == call(name, b - a).key ^ 1
    for name in ("cos", "abs"):
        assert call(name, a - b).key == call(name, b - a).key
    for name in ("exp", "sqrt"):
        assert call(name, a - b).key != call(name, b - a).key
    assert call("sign", -3 * a).key == (-call("sign", a)).key


def test_functions_of_constants_are_constants() -> None:
    graph = Graph()
    assert graph.call("sin", 0.3).value == math.sin(0.3)
    assert graph.call("atan2", 1.0, -2.0).value == math.atan2(1.0, -2.0)
    assert graph.call("select", 1.0, 2.0, 3.0).value == 2.0
    assert graph.call("select", 0.0, 2.0, 3.0).value == 3.0
    assert graph.call("sign", -0.2).value == -1.0


def test_what_is_not_finite_is_refused() -> None:
    graph = Graph()
    for value in (math.nan, math.inf, -math.inf):
        with pytest.raises(ValueError, match="a constant of the model is"):
            graph.const(value)
    with pytest.raises(ZeroDivisionError):
        graph.input("x", 0) / 0.0


def test_guards_come_before_what_they_guard_and_zeros_are_left_out() -> None:
    a, b, *_ = leaves()
    pivot = a + b
    program = lower({"y": [1.0 / pivot, a.graph.zero, a * b]}, [(pivot, 2), (a.graph.const(1.0), 4)])
    targets = [statement.target for statement in program.statements]
    assert ("y", 1) not in targets
    assert ("guard", 4) not in targets  # a constant needs no guard
    division = next(k for k, s in enumerate(program.statements) if "div" in str(s.term))
    assert targets.index(("guard", 2)) < division
    done = run(program, {"x": [3.0, -1.0]})
    assert done.guards == [(2, 2.0)]
    assert done.outputs == {("y", 0): 0.5, ("y", 2): -3.0}


def test_a_guard_that_no_output_needs_comes_first() -> None:
    a, b, c, _ = leaves()
    program = lower({"y": [c * b]}, [(a - b, 1)])
    assert [s.target for s in program.statements if isinstance(s.target, tuple)] == [("guard", 1), ("y", 0)]
    assert run(program, {"x": [1.0, 3.0, 2.0]}).guards == [(1, -2.0)]
    assert run(lower({"y": [c]}, [(-a, 2)]), {"x": [1.0, 3.0, 2.0]}).guards == [(2, -1.0)]


def test_outputs_come_in_the_order_asked_for() -> None:
    a, b, *_ = leaves()
    program = lower({"y": [a, b, a + b]}, order=[("y", 2), ("y", 0), ("y", 1)])
    found = [s.target for s in program.statements if isinstance(s.target, tuple)]
    assert found == [("y", 2), ("y", 0), ("y", 1)]


# -- from SymPy ------------------------------------------------------------------------------

X, Y = sp.symbols("x y", real=True)
EXPRESSIONS = [
    X**3 - 2 * X * Y + Y / 3,
    1 / (X**2 + Y**2 + 1) ** 2,
    sp.sqrt(X**2 + 1) * Y,
    1 / sp.sqrt(X**2 + Y**2 + 1),
    (X**2 + 1) ** sp.Rational(3, 2) + (X**2 + 1) ** sp.Rational(-3, 2),
    sp.sqrt(X**2 + 3) + X / (X**2 + 3) - Y / sp.sqrt(X**2 + 3),
    (X**2 + 0.5) ** 2.5,
    (X**2 + 0.5) ** 0.3,
    (X**2 + 0.5) ** Y,
    sp.Abs(X) * sp.sign(Y) + sp.sign(X * Y),
    sp.exp(-X * X) * sp.tanh(3 * Y) + sp.log(X**2 + 2),
    sp.atan2(Y, X + 3) + sp.atan(X * Y) + sp.acos(X / 5) - sp.asin(Y / 5),
    sp.sin(X - 0.3) * sp.cos(0.3 - X) + sp.tan(Y / 4),
    sp.Max(X, Y, X * Y) - sp.Min(X, 0.5, Y),
    sp.Piecewise((X, X > Y), (Y**2, True)),
    sp.Piecewise((X, Y < 0.5), (2 * X, Y < 1), (3 * X, True)),
    sp.Piecewise((5, X >= 1), (-5, X <= -1), (X, True)),
    sp.Piecewise((sp.sin(X), X * Y > 0), (sp.cos(Y), X > 1), (0, True)),
    sp.pi * X + sp.E * Y + sp.Rational(1, 7),
    sp.Integer(3),
]


def grid() -> np.ndarray:
    """Points with the borders of the cases above among them."""
    side = np.array([-2.5, -1.0, -0.4, 0.0, 0.5, 1.0, 1.7])
    return np.array([(x, y) for x in side for y in side])


@pytest.mark.parametrize("expression", EXPRESSIONS, ids=str)
def test_sympy_expressions_keep_their_value(expression: sp.Expr) -> None:
    graph = Graph()
    converted = from_sympy(graph, expression, {X: graph.input("v", 0), Y: graph.input("v", 1)})
    points = grid()
    found = evaluate([converted], {"v": points}, len(points))[:, 0]
    expected = [float(expression.subs({X: float(x), Y: float(y)})) for x, y in points]
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-13)


def test_an_angle_that_is_known_is_not_looked_up_again() -> None:
    """sin(x + c) by the sum of angles from sine and cosine of x."""
    graph = Graph()
    x = graph.input("v", 0)
    sine, cosine = graph.call("sin", x), graph.call("cos", x)

    def known(angle: sp.Expr) -> tuple[Expr, Expr] | None:
        shift = angle - X
        if shift.has(X):
            return None
        s, c = math.sin(shift), math.cos(shift)
        return sine * c + cosine * s, cosine * c - sine * s

    expression = sp.sin(X + 0.7) * sp.cos(X - 0.2) + sp.cos(X) ** 2
    converted = from_sympy(graph, expression, {X: x}, known)
    assert count_operations(lower({"y": [converted]}))["trig"] == 2
    points = np.linspace(-3, 3, 20)[:, None]
    found = evaluate([converted], {"v": points}, 20)[:, 0]
    np.testing.assert_allclose(found, sp.lambdify(X, expression)(points[:, 0]), rtol=1e-13, atol=1e-14)
    other = from_sympy(graph, sp.sin(2 * X), {X: x}, known)
    assert count_operations(lower({"y": [other]}))["trig"] == 1


def test_a_quotient_has_one_division_and_a_root_none_besides_its_own() -> None:
    graph = Graph()
    x, y = graph.input("v", 0), graph.input("v", 1)

    def counts(expression: sp.Expr) -> dict[str, int]:
        return operations(from_sympy(graph, expression, {X: x, Y: y}))

    assert counts(X / (X + 1) / (Y + 2) ** 2)["div"] == 1
    root = X**2 + Y**2 + 1
    assert counts(X / sp.sqrt(root) + Y / root + sp.sqrt(root) ** -3) == {
        "mul": counts(X / sp.sqrt(root) + Y / root + sp.sqrt(root) ** -3)["mul"],
        "add": 4,
        "div": 1,
        "sqrt": 1,
    }


@pytest.mark.parametrize(
    ("expression", "error", "message"),
    [
        (sp.gamma(X), TypeError, "gamma has no counterpart in generated code"),
        (X + sp.Symbol("z"), KeyError, "z"),
        (sp.Piecewise((X, sp.Eq(X, Y)), (Y, True)), TypeError, "condition Eq"),
        (sp.floor(X), TypeError, "floor has no counterpart"),
    ],
)
def test_what_cannot_be_emitted_is_named(expression: sp.Expr, error: type[Exception], message: str) -> None:
    graph = Graph()
    with pytest.raises(error, match=message):
        from_sympy(graph, expression, {X: graph.input("v", 0), Y: graph.input("v", 1)})


def test_a_value_to_which_a_billion_billion_ways_lead_is_written_in_time() -> None:
    """In each of 60 steps two ways part and meet again, and the first difference may have either sign."""
    graph = Graph()
    a, b, c, d = (graph.input("x", i) for i in range(4))
    x = a - b
    for _ in range(60):
        x = (x * c) * (x * d)
    done = run(lower({"y": [-x]}), {"x": [0.75, 0.25, 4.0, 0.5]})
    assert done.outputs["y", 0] == -0.5
