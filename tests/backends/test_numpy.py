"""The NumPy backend: what a program means, shapes, samples in chunks, bad calls."""

import math
import tracemalloc

import numpy as np
import pytest
from backends_support import LENGTH, UNARY, calls_function, planar_functions

from modelgen.backends import NumpyFunction
from modelgen.backends import numpy as backend

FUNCTIONS = {f.name: f for f in planar_functions()}
RNG = np.random.default_rng(20240607)


def sample(name: str, count: int | None = None) -> list[np.ndarray]:
    lead = () if count is None else (count,)
    return [RNG.uniform(0.2, 1.2, (*lead, a.size)) for a in FUNCTIONS[name].arguments]


def test_every_function_of_the_graph_is_the_mathematical_one() -> None:
    calls = NumpyFunction(calls_function())
    witness = {
        **{name: getattr(math, name) for name in UNARY if hasattr(math, name)},
        "abs": abs,
        "sign": lambda x: (x > 0) - (x < 0),
    }
    for x, y in ((0.3, 0.4), (-0.7, 0.9), (0.0, 0.5), (0.9, 0.2)):
        unary = [witness[name](y if name in ("sqrt", "log") else x) for name in UNARY]
        binary = [math.atan2(x, y), y**x, min(x, y), max(x, y)]
        selected = [y if x > 0 else x * y, y + 1 if -x > 0 else -x * y, (x > 0) - (x < 0)]
        np.testing.assert_allclose(calls([x, y]), [*unary, *binary, *selected], rtol=1e-15, atol=1e-16)


def test_torques_follow_from_the_energy() -> None:
    """Lagrange's equations with derivatives of the emitted energy by central differences."""
    energy, dynamics = NumpyFunction(FUNCTIONS["energy"]), NumpyFunction(FUNCTIONS["inverse_dynamics"])
    q, dq, ddq, p = sample("inverse_dynamics")
    h = 1e-4

    def lagrangian(q: np.ndarray, dq: np.ndarray) -> float:
        kinetic, potential = energy(q, dq, p)
        return float(kinetic[0] - potential[0])

    def momentum(t: float) -> np.ndarray:
        at, speed = q + dq * t + ddq * t * t / 2, dq + ddq * t
        return np.array(
            [lagrangian(at, speed + h * e) - lagrangian(at, speed - h * e) for e in np.eye(2)]
        ) / (2 * h)

    force = np.array([lagrangian(q + h * e, dq) - lagrangian(q - h * e, dq) for e in np.eye(2)]) / (2 * h)
    torque = (momentum(h) - momentum(-h)) / (2 * h) - force
    np.testing.assert_allclose(dynamics(q, dq, ddq, p), torque, rtol=1e-6)


def test_forward_dynamics_undoes_inverse_dynamics() -> None:
    q, dq, ddq, p = sample("inverse_dynamics", 50)
    p[:, 0] += 20.0  # a first link heavy enough for a positive mass matrix
    torque = NumpyFunction(FUNCTIONS["inverse_dynamics"])(q, dq, ddq, p)
    back = NumpyFunction(FUNCTIONS["forward_dynamics"])(q, dq, torque, p)
    np.testing.assert_allclose(back, ddq, rtol=1e-10)


def test_the_regressor_times_the_parameters_is_the_torque() -> None:
    q, dq, ddq, p = sample("inverse_dynamics", 50)
    matrix = NumpyFunction(FUNCTIONS["regressor"])(q, dq, ddq)
    assert matrix.shape == (50, 2, 6)
    torque = NumpyFunction(FUNCTIONS["inverse_dynamics"])(q=q, dq=dq, ddq=ddq, parameters=p)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", matrix, p), torque, rtol=1e-12)


def test_shapes_with_and_without_samples() -> None:
    q = sample("forward_kinematics")[0]
    first, second = NumpyFunction(FUNCTIONS["forward_kinematics"])(q)
    assert first.shape == second.shape == (4, 4)
    np.testing.assert_array_equal(second[2:], [[0, 0, 1, 0], [0, 0, 0, 1]])
    np.testing.assert_allclose(second[:2, 3], LENGTH * np.array([np.cos(q[0]), np.sin(q[0])]))
    kinetic, potential = NumpyFunction(FUNCTIONS["energy"])(*sample("energy", 7))
    assert kinetic.shape == potential.shape == (7, 1)
    assert NumpyFunction(FUNCTIONS["gravity"])(*sample("gravity", 0)).shape == (0, 2)
    assert NumpyFunction(FUNCTIONS["gravity"])(*sample("gravity", 1)).shape == (1, 2)


def test_an_input_without_samples_is_the_same_for_all() -> None:
    q, p = sample("gravity", 30)
    gravity = NumpyFunction(FUNCTIONS["gravity"])
    np.testing.assert_array_equal(gravity(q, p[0]), gravity(q, np.tile(p[0], (30, 1))))


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_chunks_do_not_show(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    inputs = sample(name, 23)
    whole = NumpyFunction(FUNCTIONS[name])(*inputs)
    monkeypatch.setattr(backend, "_CHUNK", 5)
    np.testing.assert_array_equal(NumpyFunction(FUNCTIONS[name])(*inputs), whole)


def test_memory_is_little_more_than_the_result() -> None:
    inputs = sample("regressor", 200_000)
    regressor = NumpyFunction(FUNCTIONS["regressor"])
    tracemalloc.start()
    result = regressor(*inputs)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1.1 * result.nbytes


def test_what_is_undefined_is_nan_without_a_warning() -> None:
    values = NumpyFunction(calls_function())([2.0, -1.0])
    assert np.isnan(values[UNARY.index("asin")])
    assert np.isnan(values[UNARY.index("sqrt")])


@pytest.mark.parametrize(
    ("inputs", "named", "error", "message"),
    [
        ([[0, 0]], {}, TypeError, r"gravity\(q, parameters\): parameters missing"),
        ([[0, 0], [0] * 6, [0]], {}, TypeError, "found 3 inputs, expected 2"),
        ([[0, 0]], {"theta": [0] * 6}, TypeError, "theta is no input"),
        ([[0, 0]], {"q": [0, 0]}, TypeError, "q is given twice"),
        ([[0, 0, 0], [0] * 6], {}, ValueError, r"q has the shape \(3,\), expected \(2,\) or \(N, 2\)"),
        ([[[0, 0]] * 3, [[0] * 6] * 4], {}, ValueError, "parameters has 4 samples, another input 3"),
    ],
)
def test_a_wrong_call_says_what_is_wrong(
    inputs: list[object], named: dict[str, object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        NumpyFunction(FUNCTIONS["gravity"])(*inputs, **named)
