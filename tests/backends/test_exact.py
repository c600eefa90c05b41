"""Values that are the same on every machine."""

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from arms_support import ARMS, inputs, model

from modelgen.backends.exact import ExactFunction
from modelgen.backends.numpy import NumpyFunction
from modelgen.backends.provenance import Provenance
from modelgen.description import EffectUse
from modelgen.functions import Options, build_model
from modelgen.functions.objects import Argument, Function, Output
from modelgen.graph import Expr, Graph, lower
from modelgen.packaging.self_test import self_test

PROVENANCE = Provenance("modelgen test", "0" * 64)


@pytest.mark.parametrize(
    ("name", "variant"), [("yaw3pitch", "default"), ("ariane4", "default"), ("yaw3pitch", "effects")]
)
def test_values_are_those_of_numpy_to_its_last_digits(name: str, variant: str) -> None:
    made = model(name, variant)
    for f in made.functions:
        given = inputs(made, f, np.random.default_rng(3))
        found = NumpyFunction(f)(*given)
        flat = np.concatenate([np.ravel(x) for x in (found if isinstance(found, tuple) else (found,))])
        if not np.isfinite(flat).all():
            continue
        known = {a.name: x for a, x in zip(f.arguments, given, strict=True)}
        values = ExactFunction(f)(known)
        if values is None:  # random parameters are those of no body, and may leave a pivot below zero
            assert f.name.startswith("forward_dynamics")
            continue
        exact = np.array([float(x) for x in values])
        assert np.abs(exact - flat).max() <= 1e-9 * max(1.0, np.abs(flat).max()), f.name


def _values(graph: Graph, value: Expr, x: list[float]) -> list[Decimal] | None:
    """Of a function of one input vector."""
    program = lower({"out": [value]})
    argument = Argument("x", len(x), "", "", 1e6)
    f = Function("f", "", (argument,), (Output("out", 1, 1, "", ""),), program, {})
    return ExactFunction(f)({"x": np.array(x)})


def test_arithmetic_has_seventy_digits() -> None:
    graph = Graph()
    a, b, c, d = (graph.input("x", k) for k in range(4))
    for x in np.random.default_rng(1).normal(size=(20, 4)):
        found = _values(graph, (a * b - c) * d / (a + 3.7) + b, list(x))
        p, q, r, s = map(Fraction, x)
        exact = (p * q - r) * s / (p + Fraction(3.7)) + q
        assert found is not None
        assert abs(Fraction(found[0]) - exact) < abs(exact) * Fraction(1, 10**70)


def test_functions_have_forty_digits() -> None:
    graph = Graph()
    a, b = (graph.input("x", k) for k in range(2))
    with mpmath.workdps(60):
        for name in ("sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "log", "tanh"):
            found = _values(graph, graph.call(name, a), [0.7, 0.0])
            assert found is not None
            exact = getattr(mpmath, name)(mpmath.mpf(0.7))
            assert abs(mpmath.mpf(str(found[0])) - exact) < mpmath.mpf(10) ** -40, name
        found = _values(graph, graph.call("atan2", a, b), [0.7, -0.3])
        assert found is not None
        exact = mpmath.atan2(mpmath.mpf(0.7), mpmath.mpf(-0.3))
        assert abs(mpmath.mpf(str(found[0])) - exact) < mpmath.mpf(10) ** -40


def test_what_has_no_value_gives_none_and_does_not_count_where_another_is_selected() -> None:
    graph = Graph()
    a, b = (graph.input("x", k) for k in range(2))
    nothing = [graph.call("acos", a), graph.call("log", -a), graph.call("sqrt", -a), 1.0 / b]
    nothing += [graph.call("exp", a * 1000.0), graph.call("pow", -a, 0.5), b / (a - 2.0)]
    for value in nothing:
        assert _values(graph, value, [2.0, 0.0]) is None
        assert _values(graph, graph.call("max", value, 0.0), [2.0, 0.0]) is None
        assert _values(graph, graph.call("select", b, value, a), [2.0, 0.0]) == [2]


def test_the_program_for_the_target_does_not_depend_on_the_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    made = model("ariane4")
    here = self_test(made, PROVENANCE)
    of_this_machine = np.linalg.cond

    def cond(matrix: Any) -> float:
        """As by another linear algebra, which differs in the last digits."""
        return float(of_this_machine(matrix)) * (1 + 1e-13)

    def elsewhere(*_: Any, **__: Any) -> Any:
        raise AssertionError("a vector unit's function")

    monkeypatch.setattr(np.linalg, "cond", cond)
    monkeypatch.setattr(NumpyFunction, "__call__", elsewhere)
    for name in ("sin", "cos", "sqrt"):
        monkeypatch.setattr(np, name, elsewhere)
    assert self_test(made, PROVENANCE) == here


def test_a_drive_without_inertia_before_an_elastic_joint_leaves_no_acceleration_to_compare() -> None:
    arm = ARMS["yaw3pitch"]
    elastic = EffectUse("joint_flexibility", {"stiffness": 5000.0, "damping": 10.0})
    first = replace(arm.joints[0], effects=(*arm.joints[0].effects, elastic))
    made = build_model(replace(arm, joints=(first, *arm.joints[1:])), Options(without=frozenset({"drives"})))
    program = self_test(made, PROVENANCE)
    assert "yaw3pitch_inverse_dynamics(" in program
    assert "yaw3pitch_forward_dynamics(" not in program
