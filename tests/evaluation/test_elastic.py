"""Elastic joints along a motion, against the steady answer of an oscillator and the least of an energy."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from modelgen.description import Arm, load
from modelgen.evaluation import Evaluator, Motion
from modelgen.evaluation.inertia_floor import carried

UPRIGHT = """
schema: 1
convention: khalil_kleinfinger
arms:
  arm:
    joints:
    - {name: a, drive: {type: direct, ratio: 50.0, torque_constant: 0.1}}
    links:
      a: {mass: 4.0, com: [0.3, 0.0, 0.0], inertia: [0.01, 0.0, 0.0, 0.05, 0.0, 0.05]}
"""
INERTIA = 0.05 + 4.0 * 0.3**2
L1, L2, SHORT, LONG, TURNS, CONSTANT = 0.35, 0.09, 0.29, 0.417, 160.0, 0.06
LEVERED = f"""
schema: 1
convention: khalil_kleinfinger
arms:
  arm:
    joints:
    - name: a
      alpha: 1.5707963267948966
      drive: {{type: levered, l1: {L1}, l2: {L2}, length: [{SHORT}, {LONG}], motor: [0.0, {TURNS}], rev: 1,
               offset: -1.4, torque_constant: {CONSTANT}}}
    links:
      a: {{mass: 9.0, com: [0.4, 0.0, 0.0], inertia: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]}}
"""


def arm(text: str, tmp_path: Path) -> Arm:
    file = tmp_path / "arms.yaml"
    file.write_text(text, encoding="utf-8")
    return load(file)["arm"]


def parameters(p: Evaluator, **values: float) -> np.ndarray:
    """Base parameters by name, the others zero."""
    return np.array([values.get(b.name, 0.0) for b in p.base.base])


@pytest.mark.parametrize("natural", [1.5, 2.0, 4.0])  # Hz
def test_it_swings_with_the_motion_alone(natural: float, tmp_path: Path) -> None:
    """I lag'' + d lag' + k lag = I q'' has one steady answer; nothing else rings at the start."""
    found_at, w, size = arm(UPRIGHT, tmp_path), 2 * math.pi * 0.4, 0.5
    t = np.arange(5000) / 500
    q = size * np.sin(w * t + 0.7)[:, None]
    m = Motion(t, q, size * w * np.cos(w * t + 0.7)[:, None], -(w**2) * q)
    stiffness = INERTIA * (2 * math.pi * natural) ** 2
    damping = 0.02 * 2 * math.sqrt(stiffness * INERTIA)
    p = Evaluator(found_at)
    base = parameters(p, ZZ1R=INERTIA)
    rigid = p.inputs(m, base)
    elastic = p.contribution("joint_flexibility", 1, m, {"stiffness": stiffness, "damping": damping}, base)
    answer = -INERTIA * w**2 / (stiffness - INERTIA * w**2 + 1j * damping * w)
    turn = np.exp(1j * (w * t + 0.7))
    expected = -INERTIA * w**2 * size * ((1 - answer) * turn).imag / (50.0 * 0.1)
    lag = size * answer
    swing = abs(INERTIA * w**2 * lag / 5.0)
    np.testing.assert_allclose((rigid + elastic)[:, 0], expected, atol=0.05 * swing)


def length(q: float) -> float:
    return math.sqrt(L1**2 + L2**2 - 2 * L1 * L2 * math.cos(q + 1.4))


def test_it_rings_at_its_own_frequency_at_the_rate_of_a_log(tmp_path: Path) -> None:
    """At 100 Hz, driven near its resonance: what 1 % of the stiffness shifts there shows fourfold."""
    found_at, w, size = arm(UPRIGHT, tmp_path), 2 * math.pi * 7.0, 0.01
    t = np.arange(1000) / 100
    q = size * np.sin(w * t)[:, None]
    m = Motion(t, q, size * w * np.cos(w * t)[:, None], -(w**2) * q)
    stiffness = INERTIA * (2 * math.pi * 8.0) ** 2
    damping = 0.05 * 2 * math.sqrt(stiffness * INERTIA)
    p = Evaluator(found_at)
    base = parameters(p, ZZ1R=INERTIA)
    found = p.contribution("joint_flexibility", 1, m, {"stiffness": stiffness, "damping": damping}, base)
    # the drive feels k lag + d lag' in place of I q''
    lag = -INERTIA * w**2 * size / (stiffness - INERTIA * w**2 + 1j * damping * w)
    felt = (stiffness + 1j * damping * w) * lag + INERTIA * w**2 * size
    expected = np.imag(felt * np.exp(1j * w * t)) / (50.0 * 0.1)
    late = t > 5.0  # after what the start has left
    error = np.linalg.norm(found[late, 0] - expected[late]) / np.linalg.norm(expected[late])
    assert error < 0.06


@pytest.mark.parametrize("q", [-0.4, 0.0, 0.5])
@pytest.mark.parametrize("stiffness", [200.0, 2000.0])
def test_a_lever_hangs_on_its_actuator(q: float, stiffness: float, tmp_path: Path) -> None:
    """The actuator is the spring; the lever works where the link hangs, which has the least energy."""
    p = Evaluator(arm(LEVERED, tmp_path))
    middle = math.acos((L1**2 + L2**2 - ((SHORT + LONG) / 2) ** 2) / (2 * L1 * L2)) - 1.4
    ratio = (length(middle + 1e-6) - length(middle - 1e-6)) / 2e-6
    spring = stiffness / ratio**2  # N/m

    def energy(link: float) -> float:
        return 0.5 * spring * (length(q) - length(link)) ** 2 + 9.0 * 9.81 * 0.4 * math.sin(link)

    link = minimize_scalar(energy, bounds=(q - 0.5, q + 0.5), method="bounded", options={"xatol": 1e-12}).x
    current = spring * (length(q) - length(link)) * (LONG - SHORT) / TURNS / CONSTANT
    still = np.zeros((400, 1))
    m = Motion(np.arange(400) / 200, still + q, still, still)
    base = parameters(p, ZZ1=9.0 * 0.4**2, MX1=9.0 * 0.4)
    values = {"stiffness": stiffness, "damping": 1.0}
    found = p.inputs(m, base) + p.contribution("joint_flexibility", 1, m, values, base)
    np.testing.assert_allclose(found, current, rtol=1e-5)


@pytest.mark.parametrize("share", [-0.3, 0.02, 0.3])
def test_links_lighter_than_nothing_have_a_part_of_what_is_moved(share: float, tmp_path: Path) -> None:
    """A rigid model of an elastic arm may have all inertia in the drive and less than none in the link: with
    a twentieth of the whole, which is known all the same, its swings can be simulated. Others stay.
    """
    found_at = arm(LEVERED, tmp_path)
    p = Evaluator(found_at)
    w, t = 2 * math.pi * 0.4, np.arange(2000) / 500
    q = 0.5 * np.sin(w * t)[:, None]
    m = Motion(t, q, 0.5 * w * np.cos(w * t)[:, None], -(w**2) * q)
    of_link = parameters(p, ZZ1=1.0, MX1=1.0, MY1=1.0)
    force = np.array([(length(x + 1e-6) - length(x - 1e-6)) / 2e-6 for x in q[:, 0]]) * TURNS / (LONG - SHORT)
    drive = 1e-4 * np.median(force**2)
    link = share / (1 - share) * drive
    base = parameters(p, IA1=1e-4, MX1=3.0, ZZ1=link)

    def links(motion: Motion, values: np.ndarray) -> np.ndarray:
        return p.inputs(motion, values * of_link)

    def drives(motion: Motion, values: np.ndarray) -> np.ndarray:
        return p.inputs(motion, values * (1 - of_link))

    held = carried(found_at, p.base, 1, m, base, links, drives)
    expected = parameters(p, IA1=1e-4, MX1=3.0, ZZ1=max(link, 0.05 * (link + drive)))
    np.testing.assert_allclose(held, expected, rtol=1e-3)
    swings = p.contribution("joint_flexibility", 1, m, {"stiffness": 400.0, "damping": 4.0}, base)
    assert np.isfinite(swings).all()
    assert np.abs(swings).max() < np.abs(p.inputs(m, base)).max()
