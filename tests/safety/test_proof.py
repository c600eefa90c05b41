"""Frama-C's EVA proves the absence of run-time errors; `make prove` does so for every function."""

import shutil
from pathlib import Path

import pytest
from arms_support import model
from safety.eva import Claim, claims, prove, prove_sincos, written

from modelgen.functions import Function, Model

pytestmark = [
    pytest.mark.xdist_group("safety_proof"),
    pytest.mark.skipif(shutil.which("frama-c") is None, reason="needs frama-c (Debian: frama-c-base)"),
]
# One of each kind: stroke and lever, pivots, matrix with zeros, inverse of the drive.
SELECTED = [
    ("ariane4", "gravity"),
    ("ariane4", "forward_dynamics"),
    ("ariane4", "joint_from_motor"),
    ("ariane4", "inverse_dynamics_derivatives"),
    ("ariane4", "momentum_observer_step"),
    ("ariane4", "monitor_step"),
    ("ur10e", "inverse_dynamics"),
    ("ur10e", "forward_dynamics"),
    ("ur10e", "forward_dynamics_derivatives"),
    ("ur10e", "jacobian"),
]


def function(made: Model, name: str) -> Function:
    (found,) = [f for f in made.functions if f.name == name]
    return found


@pytest.mark.parametrize(("arm", "name"), SELECTED)
def test_no_run_time_error(arm: str, name: str, tmp_path: Path) -> None:
    made = model(arm)
    folder = written(made, tmp_path)
    for claim in claims(function(made, name))[-1:]:  # double; make prove does float as well
        proof = prove(made, function(made, name), claim, folder)
        assert proof.alarms == 0, f"{proof}\n{proof.log[-3000:]}"


@pytest.mark.parametrize("real", ["float", "double"])
def test_no_run_time_error_in_the_sine_and_cosine(tmp_path: Path, real: str) -> None:
    made = model("ur10e")
    proof = prove_sincos("ur10e", written(made, tmp_path), real)
    assert proof.alarms == 0, proof.log[-3000:]


@pytest.mark.parametrize(
    ("name", "guard", "without"),
    [
        ("forward_dynamics", "> ARIANE4_C(1.0e-12)", "> ARIANE4_C(0.0)"),
        ("gravity", "out[0] = ARIANE4_C(0.0);", ";"),
        ("gravity", "parameters[MX2R]", "parameters[24]"),
    ],
)
def test_a_guard_left_out_is_an_alarm(name: str, guard: str, without: str, tmp_path: Path) -> None:
    made = model("ariane4")
    folder = written(made, tmp_path)
    path = folder / f"src/ariane4_{name}.c"
    text = path.read_text(encoding="utf-8")
    assert guard in text
    path.write_text(text.replace(guard, without), encoding="utf-8")
    proof = prove(made, function(made, name), Claim("double", finite=True), folder)
    assert proof.alarms is not None
    assert proof.alarms > 0
