"""Half a sample does to efforts what damping does: stiffness and damping of a belt at every rate, and the
instant that is found beside them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from belt_rig import DAMPING, LINK, RATIO, ROTOR, STIFFNESS, WHOLE, log, rig

import modelgen as mg
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import EVALUATED, build_model


@pytest.mark.parametrize("rate", [100.0, 250.0, 500.0, 2000.0])
@pytest.mark.parametrize("f", [1.0, 4.0])
def test_what_an_elastic_joint_adds_comes_when_it_does(rate: float, f: float) -> None:
    """Amplitude and phase of the torque along a sine, against the transfer function; no gravity."""
    arm = rig(STIFFNESS)
    t, w = np.arange(0.0, 30.0, 1.0 / rate), 2 * np.pi * f
    q = 0.02 * np.sin(w * t)
    motion = Motion(t, q[:, None], (0.02 * w * np.cos(w * t))[:, None], (-(w**2) * q)[:, None], (True,), 18.0)
    names = [b.name for b in build_model(arm, EVALUATED).grouping.base]
    theta = WHOLE * (np.array(names) == "ZZ1R")
    torque = Evaluator(arm).inputs(motion, theta)[:, 0]
    late = slice(len(t) // 2, None)
    found, moved = (np.mean(x[late] * np.exp(-1j * w * t[late])) for x in (torque, q))
    s, drive = 1j * w, RATIO**2 * ROTOR
    belt = STIFFNESS + DAMPING * s
    expected = drive * s**2 + belt * LINK * s**2 / (LINK * s**2 + belt)
    ratio = found * RATIO * 0.07 / moved / expected
    assert abs(ratio) == pytest.approx(1.0, abs=5e-3)
    assert abs(np.angle(ratio)) / w < 2e-5  # s


@pytest.mark.parametrize("rate", [250.0, 500.0])
def test_the_instant_is_found_beside_an_elastic_joint(rate: float) -> None:
    """Readings are of one instant, which nobody has said; nor can a rigid model tell."""
    logs = [log(k, rate=rate) for k in range(3)]
    found = mg.diagnose(rig(), logs[:2], logs[2], effects=["joint_flexibility"], experiment=False)
    (cause,) = found.causes
    stiffness, damping = cause.parameters["stiffness"], cause.parameters["damping"]
    instant = found.to_json()["log"]["effort_instant"]
    assert (instant["hold"], instant["known_from"]) == ("instant", "data")
    assert abs(instant["delay_samples"]) < 4.0 * instant["std_samples"]
    assert stiffness.value == pytest.approx(STIFFNESS, rel=0.01)
    assert damping.value == pytest.approx(DAMPING, rel=0.1)


def test_a_stated_instant_stays(tmp_path: Path) -> None:
    path = tmp_path / "mapping.yaml"
    path.write_text("schema: 1\nhold: following\n")
    logs = [log(k) for k in range(3)]
    found = mg.diagnose(
        rig(), logs[:2], logs[2], mapping=path, effects=["joint_flexibility"], experiment=False
    ).to_json()
    assert found["log"]["effort_instant"]["hold"] == "following"
