"""Figures of derivatives and combined functions: what is measured is right, and others are told apart."""

import ctypes
import shutil
from pathlib import Path

import numpy as np
import pytest
from peers import build, control, pinocchio_control
from peers.arms import subject
from peers.measure import values

pytestmark = pytest.mark.skipif(
    shutil.which("gcc") is None or shutil.which("valgrind") is None, reason="needs gcc and valgrind"
)
CASE = subject("gravity_arm", 3)


def test_what_is_combined_costs_less_than_its_parts(tmp_path: Path) -> None:
    found = control.measured(CASE, control.Programs(), tmp_path)
    counts = found["instructions"][control.OURS]
    for name, parts in control.COMBINED.items():
        assert counts[name] < sum(counts[p] for p in parts)
    assert set(control.DERIVATIVES) < set(counts)


def test_what_differs_is_refused(tmp_path: Path) -> None:
    mine = values(control._ours(CASE, control._model(CASE), tmp_path))
    n = CASE.joints
    block = mine["inverse_dynamics_derivatives"]
    efforts = mine["inverse_dynamics"]
    assert block[:, :n] == pytest.approx(efforts, rel=1e-12)
    by_ddq = block[:, n + 2 * n * n :].reshape(-1, n, n)
    assert by_ddq.reshape(len(block), -1) == pytest.approx(mine["mass_matrix"], rel=1e-12)
    control._agree(CASE, control.MUJOCO, mine, {"inverse_dynamics_alone": efforts})
    wrong = {"inverse_dynamics_alone": efforts + 1e-6 * np.abs(efforts).max()}
    with pytest.raises(RuntimeError, match=r"MuJoCo and modelgen differ by .* in inverse_dynamics"):
        control._agree(CASE, control.MUJOCO, mine, wrong)


def test_derivatives_of_pinocchio_are_compared_block_by_block() -> None:
    n, samples = CASE.joints, 2
    block = np.arange(samples * (n + 3 * n * n), dtype=float).reshape(samples, -1)
    mine = {"forward_dynamics_derivatives": block}
    for place, name in enumerate(("_by_q", "_by_dq")):
        found = pinocchio_control.expected(CASE, f"forward_dynamics_derivatives{name}", mine)
        assert np.array_equal(found, block[:, n + place * n * n : n + (place + 1) * n * n])
    right = {"forward_dynamics_derivatives": block[:, :n]}
    control._agree(CASE, control.PINOCCHIO, mine, right)
    with pytest.raises(RuntimeError, match=r"Pinocchio, C\+\+ and modelgen differ"):
        control._agree(
            CASE, control.PINOCCHIO, mine, {"forward_dynamics_derivatives_by_q": block[:, : n * n]}
        )


def test_a_peer_s_sine_and_cosine_are_those_of_the_arm(tmp_path: Path) -> None:
    """What it computes is the same, and nothing of the C library is left in it."""
    control._ours(CASE, control._model(CASE), tmp_path)
    source = tmp_path / "peer.c"
    source.write_text("#include <math.h>\ndouble both(double x)\n{\n    return sin(x) + 2.0 * cos(x);\n}\n")
    flags = pinocchio_control._sines(CASE.arm.name, tmp_path, tmp_path)
    made = build.object_file(source, tmp_path / "peer.o", *flags, "-fPIC")
    undefined = build.run(["nm", "--undefined-only", str(made)])
    assert "sin" not in undefined
    assert "cos" not in undefined
    build.run(["gcc", "-shared", str(made), "-o", str(tmp_path / "peer.so"), "-lm"])
    both = ctypes.CDLL(str(tmp_path / "peer.so")).both
    both.restype, both.argtypes = ctypes.c_double, [ctypes.c_double]
    for x in (-3.0, 0.1, 1.6, 40.0):
        assert both(x) == pytest.approx(np.sin(x) + 2.0 * np.cos(x), abs=1e-15)
