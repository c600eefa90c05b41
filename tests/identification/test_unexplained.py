"""What a fit leaves unexplained is asked of the joint that has it, whatever the size of the others."""

from __future__ import annotations

import made_up_plants as plants
import numpy as np
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(
        plants.description(2, "{coulomb_friction: {magnitude: 0.011}}"), "arms.yaml", known_effects()
    )["made_up"]


def log(seed: int, factor: float) -> dict[str, np.ndarray]:
    """By Lagrange's equations. factor: of the second joint's currents."""
    random = np.random.default_rng(seed)
    t = np.arange(8000) / 500.0
    q, dq, ddq = plants.motion(t, random.uniform(0, 6.28, (2, len(plants.WAVES))))
    current = plants.PLAIN[2].currents(q, dq, ddq) + (0.0, 0.22) * np.sign(dq)
    current = current + 0.01 * random.normal(size=q.shape)
    motor = q * plants.RATIO + 1e-4 * random.normal(size=q.shape)
    columns = {"qm1": motor[:, 0], "qm2": motor[:, 1], "i1": current[:, 0], "i2": factor * current[:, 1]}
    return {"t": t} | columns


@pytest.mark.parametrize("factor", [1.0, 1e3, 1e-3])
def test_a_joint_in_another_unit_accuses_no_other(factor: float, arm: mg.Arm) -> None:
    found = mg.identify(arm, log(1, factor), log(2, factor))
    assert not [x for x in found.to_json()["doubts"] if "j1" in x and "unexplained" in x]
