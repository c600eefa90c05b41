"""Figures of derivatives and combined functions: what is measured is right, and others are told apart."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from peers import control
from peers.arms import subject
from peers.measure import values

pytestmark = pytest.mark.skipif(
    shutil.which("gcc") is None or shutil.which("valgrind") is None, reason="needs gcc and valgrind"
)
CASE = subject("gravity_arm", 3)


def test_what_is_combined_costs_less_than_its_parts(tmp_path: Path) -> None:
    found = control.measured(CASE, None, tmp_path)
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
    control._agree(CASE, "somebody", mine, {"inverse_dynamics_alone": efforts})
    wrong = {"inverse_dynamics_alone": efforts + 1e-6 * np.abs(efforts).max()}
    with pytest.raises(RuntimeError, match=r"somebody and modelgen differ by .* in inverse_dynamics"):
        control._agree(CASE, "somebody", mine, wrong)
