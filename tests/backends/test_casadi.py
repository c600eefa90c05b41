"""The CasADi module: it needs casadi alone, and its functions are those of NumPy."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import casadi as ca
import numpy as np
import pytest
from backends_support import Q, calls_function, function, planar_model
from c_support import flat, write

from modelgen.backends import NumpyFunction, Provenance, casadi_files
from modelgen.functions.objects import Argument, Function, Model, Output
from modelgen.graph import Graph

PROVENANCE = Provenance("modelgen test", "0" * 64)


def stateful() -> Function:
    """A function whose state goes in and comes out under one name."""
    g = Graph()
    state = g.input("state", 0) + 0.1 * g.input("q", 1)
    return function(
        "effects_step",
        (Q, Argument("state", 1, "m", "state", 1e3)),
        (Output("state", 1, 1, "m", "state"),),
        {"state": [state]},
    )


MODEL = planar_model(extra=(calls_function(),))


def load(model: Model) -> dict[str, ca.Function]:
    """The functions of the module's text."""
    (text,) = casadi_files(model, PROVENANCE).values()
    module = ModuleType("generated")
    exec(text, module.__dict__)  # noqa: S102 - the text under test
    made: dict[str, ca.Function] = module.functions()
    return made


@pytest.fixture(scope="module")
def functions() -> dict[str, ca.Function]:
    return load(MODEL)


def test_names_inputs_and_outputs_are_those_of_the_functions(functions: dict[str, ca.Function]) -> None:
    assert list(functions) == [f"planar_{f.name}" for f in MODEL.functions]
    for f in MODEL.functions:
        made = functions[f"planar_{f.name}"]
        assert made.name() == f"planar_{f.name}"
        assert made.name_in() == [a.name for a in f.arguments]
        assert made.name_out() == [o.name for o in f.outputs]
        assert [made.size_in(i) for i in range(made.n_in())] == [(a.size, 1) for a in f.arguments]
        assert [made.size_out(i) for i in range(made.n_out())] == [(o.rows, o.columns) for o in f.outputs]
        assert made.is_a("SXFunction")


@pytest.mark.parametrize("f", MODEL.functions, ids=lambda f: f.name)
def test_casadi_gives_what_numpy_gives(functions: dict[str, ca.Function], f: Function) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        inputs = [rng.uniform(-1, 1, a.size) for a in f.arguments]
        expected = flat(f, NumpyFunction(f)(*inputs))
        result = flat(f, functions[f"planar_{f.name}"](*inputs))
        np.testing.assert_allclose(result, expected, rtol=1e-12, atol=1e-14)


def test_zeros_of_a_matrix_are_structural_and_vectors_are_dense(functions: dict[str, ca.Function]) -> None:
    assert functions["planar_regressor"].sparsity_out(0).nnz() == 9
    for f in MODEL.functions:
        for i, output in enumerate(f.outputs):
            if output.columns == 1:
                assert functions[f"planar_{f.name}"].sparsity_out(i).is_dense()


def test_derivatives_are_exact(functions: dict[str, ca.Function]) -> None:
    """The Jacobian of the torque by the acceleration is the mass matrix."""
    q, dq, ddq = (ca.SX.sym(n, 2) for n in ("q", "dq", "ddq"))
    p = ca.SX.sym("p", 6)
    torque = functions["planar_inverse_dynamics"](q, dq, ddq, p)
    mass = ca.Function("mass", [q, p], [ca.jacobian(torque, ddq)])
    at = [0.3, -0.8], [3.0, 0.4, 1.1, 0.2, 0.7, -0.1]
    np.testing.assert_allclose(mass(*at).full(), functions["planar_mass_matrix"](*at).full(), rtol=1e-14)


def test_a_state_keeps_its_name() -> None:
    model = planar_model(extra=(stateful(),))
    model = replace(model, states=("wear",))
    step = load(model)["planar_effects_step"]
    assert float(step(q=[0, 2], state=1)["state"]) == pytest.approx(1.2)


def test_the_module_needs_casadi_alone(tmp_path: Path) -> None:
    write(casadi_files(MODEL, PROVENANCE), tmp_path)
    code = (
        "import sys; sys.modules['modelgen'] = None; import planar_casadi as m;"
        "print(m.functions()['planar_gravity']);"
        "assert m.function('planar_gravity') is m.functions()['planar_gravity'];"
        "assert not {'sympy', 'jinja2', 'pydantic'} & set(sys.modules)"
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip().startswith("planar_gravity:(q[2],parameters[6])->(input[2])")
