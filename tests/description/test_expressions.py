"""Expressions of the description: right where they are arithmetic, refused where they are anything else."""

import contextlib
import math
import operator
import time
from collections.abc import Callable

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from modelgen.description import geometry_symbol
from modelgen.description.expressions import ExpressionError, evaluate

SYMBOLS = {"d3": 0.443, "lead": 0.005}


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("90 deg", "angle", math.pi / 2),
        ("-106.39 deg", "angle", math.radians(-106.39)),
        ("90deg", "angle", math.pi / 2),
        ("pi/2 rad", "angle", math.pi / 2),
        ("-pi/2", "angle", -math.pi / 2),
        ("(30 + 15) deg", "angle", math.pi / 4),
        ("50 mm", "length", 0.05),
        ("5 cm", "length", 0.05),
        ("2 m", "length", 2.0),
        ("1e-3", "plain", 0.001),
        ("2*pi/0.005", "plain", 1256.6370614359173),
        ("2**-2", "plain", 0.25),
        ("-2**2", "plain", -4.0),
        ("2**3**2", "plain", 512.0),
        ("10 - 4 - 3", "plain", 3.0),
        ("sqrt(2)*cos(pi/4)", "plain", 1.0),
        ("atan(1)*4", "plain", math.pi),
        ("0.5 deg", "any", math.pi / 360),
        ("5 mm", "any", 0.005),
        (7, "length", 7.0),
    ],
)
def test_values_are_in_si_units(text: str, kind: str, value: float) -> None:
    result = evaluate(text, kind)
    assert result.value == pytest.approx(value, rel=1e-14)
    assert isinstance(result.scalar, float)


def test_a_unit_is_part_of_a_name_that_ends_like_it() -> None:
    assert evaluate("d3m", "length", {"d3m": 2.0, "d3": 5.0}).value == 2.0
    assert evaluate("beam + 1", "length", {"beam": 2.0}).value == 3.0


@pytest.mark.parametrize(
    ("text", "kind", "message"),
    [
        ("90 mm", "angle", "'mm' is a unit of length, expected an angle (deg, rad)"),
        ("90 deg", "length", "'deg' is a unit of angle, expected a length (mm, cm, m)"),
        ("90 deg", "plain", "expected a plain number"),
        ("deg", "angle", "a number is missing before the unit 'deg'"),
        ("30 deg + 5 deg", "angle", "a unit stands once, at the end"),
        ("2 kg", "plain", "no unit is read here; write the number alone, in SI units"),
        ("0.38 in", "length", "'in' is none of the units mm, cm, m"),
        ("5e-3 ft/s", "plain", "no unit is read here"),
        ("30*deg", "angle", "no arithmetic expression"),
        ("5 + 30 deg", "angle", "could belong to the last term or to the sum"),
        ("90°", "angle", 'degrees are written "90 deg"'),
        ("2^3", "plain", "a power is written **"),
        ("d4", "length", "the name 'd4' is not known, available: pi, d3, lead"),
        ("sinh(1)", "plain", "the function 'sinh' is not known, available: sin, cos"),
        ("sin", "plain", "needs its argument in parentheses"),
        ("sin(1)(2)", "plain", "only numbers"),
        ("sin()", "plain", "takes one argument"),
        ("1 +", "plain", "no arithmetic expression"),
        ("", "plain", "no arithmetic expression"),
        ("1/0", "plain", "divides by zero"),
        ("0**-1", "plain", "divides by zero"),
        ("1/(d3 - d3)", "plain", "divides by zero"),
        ("asin(2)", "plain", "asin(2) does not exist"),
        ("sqrt(-1)", "plain", "sqrt(-1) does not exist"),
        ("(-8)**0.5", "plain", "root of a negative number"),
        ("1e400", "plain", "not finite"),
        ("1e300*1e300", "plain", "not finite"),
        ("1e300**2", "plain", "too large"),
        ("9**9**9", "plain", "exponent must lie within"),
        ("2**d3", "plain", "an exponent must be a number"),
        (float("nan"), "plain", "not finite"),
        (float("-inf"), "plain", "not finite"),
        ("1" * 201, "plain", "at most 200"),
        ("True", "plain", "only numbers"),
        ("1j", "plain", "only numbers"),
        ("1 if d3 else 2", "plain", "only numbers"),
        ("d3.real", "plain", "only numbers"),
        ("__import__('os')", "plain", "cannot be part of an expression"),
        ("[1][0]", "plain", "cannot be part of an expression"),
        ("7 // 2", "plain", "only numbers"),
    ],
)
def test_anything_else_is_refused(text: str | float, kind: str, message: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        evaluate(text, kind, SYMBOLS)
    assert message in str(caught.value)


def test_a_symbol_keeps_its_name() -> None:
    d3 = geometry_symbol("d3")
    assert evaluate("d3", "length", SYMBOLS).scalar == d3
    assert evaluate("2*d3 + 1", "length", SYMBOLS).scalar == 2 * d3 + 1
    assert evaluate("d3**2/4", "length", SYMBOLS).scalar == d3**2 / 4
    assert evaluate("2*d3", "length", SYMBOLS).value == pytest.approx(0.886)
    millimetres = evaluate("(d3 + 1) mm", "length", SYMBOLS)
    assert millimetres.value == pytest.approx(1.443e-3)
    assert millimetres.scalar.subs(d3, 0.443) == pytest.approx(1.443e-3)


def test_a_symbol_that_cancels_leaves_a_number() -> None:
    assert evaluate("d3 - d3 + 2", "length", SYMBOLS).scalar == 2.0


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9**9**9",
        "(((9**60)**60)**60)**60",
        "((((2*d3)**60)**60)**60)**60",
        "(((((3*lead)**64)**64)**64)**64)**64",
        "((d3+1)**8)**8*(d3+2)**9",
        "(" * 99 + "1" + ")" * 99,
        "-" * 199 + "1",
        "+".join(["d3"] * 66),
        "sin(" * 30 + "d3" + ")" * 30,
        "9" * 200,
        "1/d3" * 50,
    ],
)
def test_no_text_keeps_the_reader_busy(text: str) -> None:
    start = time.process_time()
    with contextlib.suppress(ExpressionError):
        assert math.isfinite(evaluate(text, "plain", SYMBOLS).value)
    assert time.process_time() - start < 1.0


Term = tuple[str, float]
NUMBERS = st.floats(0.1, 9.9).map(lambda x: round(x, 3)).map(lambda x: (repr(x), x))
NAMES = st.sampled_from([("d3", 0.443), ("lead", 0.005), ("pi", math.pi)])
BINARY: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
UNARY: dict[str, Callable[[float], float]] = {"sin": math.sin, "cos": math.cos, "atan": math.atan}


def _grow(terms: st.SearchStrategy[Term]) -> st.SearchStrategy[Term]:
    def binary(parts: tuple[Term, str, Term]) -> Term:
        (a, x), sign, (b, y) = parts
        return f"({a} {sign} {b})", BINARY[sign](x, y) if sign != "/" or y != 0.0 else math.inf

    def unary(parts: tuple[str, Term]) -> Term:
        name, (a, x) = parts
        return f"{name}({a})", UNARY[name](x) if math.isfinite(x) else math.inf

    def negative(part: Term) -> Term:
        return f"-{part[0]}", -part[1]

    return st.one_of(
        st.tuples(terms, st.sampled_from(list(BINARY)), terms).map(binary),
        st.tuples(st.sampled_from(list(UNARY)), terms).map(unary),
        terms.map(negative),
    )


@given(st.recursive(NUMBERS | NAMES, _grow, max_leaves=8).filter(lambda term: len(term[0]) <= 200))
def test_python_computes_the_same(term: Term) -> None:
    text, expected = term
    if not math.isfinite(expected):
        with pytest.raises(ExpressionError):
            evaluate(text, "plain", SYMBOLS)
        return
    result = evaluate(text, "plain", SYMBOLS)
    assert result.value == expected
    if result.expression is not None:
        # SymPy reorders sums and cancels: rounding, magnified where terms cancel.
        values = {geometry_symbol(name): sp.Float(x, 30) for name, x in SYMBOLS.items()}
        value = float(result.expression.subs(values).evalf(30))
        assert value == pytest.approx(expected, rel=1e-6, abs=1e-9 * max(1.0, abs(expected)))
