"""Currents that a robot publishes more seldom than its angles, each with a stamp of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from geared_link import PERIOD, GearedLink, sines

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

LINK = GearedLink(
    mass=6.0, moment=1.5, inertia=0.575, ratio=50.0, constant=0.08, viscous=8e-4, dry=0.02, rotor=2e-4
)
CENTRE, SECONDS = 0.3, 3 * PERIOD  # rad, s
ARM = loads(LINK.description(values=False), "arms.yaml", known_effects())["one"]


def log(path: Path, seed: int, angles: float, currents: float) -> Path:
    """A record whose angles and currents have rates [Hz] and instants of their own; noise 4 mA, 0.2 mrad."""
    random = np.random.default_rng(seed)
    phase = random.uniform(0.0, 2.0 * np.pi, 4)
    places = np.arange(0.0, SECONDS, 1.0 / angles)
    instants = np.arange(0.0013, SECONDS, 1.0 / currents)
    q, dq, ddq = sines(instants, phase)
    current = LINK.currents(CENTRE + q, dq, ddq) + 4e-3 * random.standard_normal(len(instants))
    read = LINK.ratio * (CENTRE + sines(places, phase)[0]) + 2e-4 * random.standard_normal(len(places))
    rows = [(t, f"{t:.6f},{x:.7f},") for t, x in zip(places, read, strict=True)]
    rows += [(t, f"{t:.6f},,{x:.6f}") for t, x in zip(instants, current, strict=True)]
    path.write_text("t,qm1,i1\n" + "\n".join(row for _, row in sorted(rows)) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("currents", [50.0, 100.0])
def test_what_lies_between_two_readings_of_a_current_is_no_cause(currents: float, tmp_path: Path) -> None:
    a, b, test = (log(tmp_path / f"{k}.csv", k, 500.0, currents) for k in range(3))
    found = mg.diagnose(ARM, train=[a, b], test=test)
    assert found.verdict == "nothing_missing", found
    fitted = mg.identify(ARM, train=[a, b], test=test)
    for name in ("ZZ1R", "MX1", "FV1", "FC1"):
        p, value = fitted.parameters[name], LINK.parameters[name]
        assert abs(p.value - value) < 4.0 * p.std, name
        assert p.std < 0.02 * value, name
