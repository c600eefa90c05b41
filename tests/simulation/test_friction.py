"""Dry friction: exact solutions, rest that is rest, starts that are in time."""

from __future__ import annotations

from dataclasses import replace
from math import asin, cos, sin

import numpy as np
import pytest
from arms_support import ARMS
from scipy.optimize import brentq
from simulation_support import pendulum, shipped, slider

from modelgen.description import EffectUse, loads
from modelgen.simulation import plant, simulate

MASS, LENGTH, G = 2.0, 0.4, 9.81
METHODS = ["fixed", "DOP853", "cvodes"]


def dry(magnitude: float, **more: float) -> EffectUse:
    return EffectUse("coulomb_friction", {"magnitude": magnitude, **more})


def turning_points(q0: float, friction: float) -> list[float]:
    """Where the pendulum turns, until friction holds it: from one to the next, its energy falls by
    friction times way."""
    weight = MASS * G * LENGTH
    points = [q0]
    while weight * abs(sin(points[-1])) > friction:
        q = points[-1]
        side = -np.sign(q)

        def left(x: float, q: float = q) -> float:
            return float(weight * (cos(x) - cos(q)) - friction * abs(x - q))

        # On the far side the energy has been used up; at the start of the way it has not.
        bottom = side * asin(friction / weight)
        end = brentq(left, bottom, -q) if left(bottom) > 0 else brentq(left, q + side * 1e-9, bottom)
        points.append(float(end))
    return points


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("friction", [0.35, 1.3])
def test_pendulum_with_coulomb_friction(friction: float, method: str) -> None:
    """Amplitudes and the angle of rest to 1e-6 rad."""
    expected = turning_points(1.2, friction)
    made = plant(pendulum(dry(friction), mass=MASS, length=LENGTH))
    duration = 8.0 if friction > 1 else 16.0
    found = simulate(made, 1.2, 0.0, duration, 2000.0, method=method, rtol=1e-11, atol=1e-12)
    q, dq = found.q[:, 0], found.dq[:, 0]
    assert dq[-1] == 0.0
    assert abs(q[-1] - expected[-1]) < 1e-6
    moving = np.flatnonzero(dq)
    signs = np.sign(dq[moving])
    turns = moving[np.flatnonzero(np.diff(signs))]
    assert len(turns) == len(expected) - 2
    # A parabola through the samples about each turn: 2 kHz alone would be good for 1e-6 only.
    for k, point in zip(turns, expected[1:], strict=False):
        near = slice(k - 1, k + 3)
        fit = np.polyfit(found.t[near] - found.t[k], q[near], 3)
        at = min(np.roots(np.polyder(fit)).real, key=abs)
        assert abs(np.polyval(fit, at) - point) < 1e-6


@pytest.mark.parametrize("method", METHODS)
def test_spring_and_coulomb_friction(method: str) -> None:
    """Every half wave takes 2 F/k off the amplitude; the mass stops inside F/k of the spring's rest."""
    stiffness, friction = 80.0, 3.0
    made = plant(slider(dry(friction), EffectUse("spring", {"stiffness": stiffness, "rest": 0.0}), mass=MASS))
    found = simulate(made, 0.5, 0.0, 12.0, 1000.0, method=method, rtol=1e-11, atol=1e-12)
    step = 2 * friction / stiffness
    halves = int(np.ceil((0.5 - friction / stiffness) / step))
    rest = (-1) ** halves * (0.5 - halves * step)
    assert abs(found.q[-1, 0] - rest) < (1e-7 if method == "cvodes" else 1e-9)
    half_wave = np.pi * np.sqrt(MASS / stiffness)
    stopped = found.t[np.flatnonzero(found.dq[:, 0])[-1]]
    assert abs(stopped - halves * half_wave) < 2e-3


@pytest.mark.parametrize("method", METHODS)
def test_inside_its_band_an_arm_rests_exactly(method: str) -> None:
    made = plant(pendulum(dry(3.0), mass=MASS, length=LENGTH))
    angle = asin(2.99 / (MASS * G * LENGTH))
    for q0 in (angle, -angle, 0.1):
        found = simulate(made, q0, 0.0, 30.0, 100.0, method=method)
        assert (found.q == q0).all()
        assert (found.dq == 0.0).all()
    beyond = asin(3.01 / (MASS * G * LENGTH))
    found = simulate(made, beyond, 0.0, 2.0, 100.0, method=method)
    assert found.q[-1, 0] < beyond


@pytest.mark.parametrize("method", METHODS)
def test_a_growing_effort_starts_the_arm_when_it_should(method: str) -> None:
    """Held inputs at 200 Hz: the first sample whose effort exceeds weight plus friction moves it."""
    friction, q0 = 3.0, 0.2
    made = plant(pendulum(dry(friction), mass=MASS, length=LENGTH))
    weight = MASS * G * LENGTH * sin(q0)
    t = np.arange(801) / 200
    effort = 1.5 * t
    found = simulate(made, q0, 0.0, 4.0, 200.0, effort[:, None], method=method)
    first = np.flatnonzero(effort > weight + friction)[0]
    assert 0 < first < 800
    assert (found.q[: first + 1] == q0).all()
    assert found.q[first + 1, 0] > q0


def test_the_smoothing_width_changes_nothing() -> None:
    sharp, wide = (
        plant(pendulum(dry(0.5, smoothing=width), mass=MASS, length=LENGTH)) for width in (0.0, 0.5)
    )
    one, two = (simulate(p, 1.0, 0.0, 5.0, 100.0) for p in (sharp, wide))
    np.testing.assert_array_equal(one.q, two.q)


def test_static_friction_above_sliding_friction() -> None:
    """Stribeck's excess holds a weight that Coulomb's part alone would let go."""
    angle = asin(2.5 / (MASS * G * LENGTH))
    excess = EffectUse("stribeck_friction", {"magnitude": 1.0, "velocity": 0.05})
    held = simulate(plant(pendulum(dry(2.0), excess, mass=MASS, length=LENGTH)), angle, 0.0, 5.0, 100.0)
    let_go = simulate(plant(pendulum(dry(2.0), mass=MASS, length=LENGTH)), angle, 0.0, 5.0, 100.0)
    assert (held.q == angle).all()
    assert let_go.q[-1, 0] < angle


@pytest.mark.parametrize("name", ["ariane6", "ur10e"])
@pytest.mark.parametrize("method", ["fixed", "DOP853"])
def test_several_joints_stick_at_once(name: str, method: str) -> None:
    """Friction far beyond all weights: nothing moves, through any joint's push."""
    made = shipped(name)
    strong = made.parameters.copy()
    for k, base in enumerate(made.model.grouping.base):
        if base.name.startswith("FC"):
            strong[k] *= 1e6
    heavy = replace(made, parameters=strong, base=strong)
    q0 = np.full(made.n, 0.6)
    low, high = made.strokes
    q0 = np.clip(q0, np.where(np.isfinite(low), low + 0.1, -9), np.where(np.isfinite(high), high - 0.1, 9))
    found = simulate(heavy, q0, 0.0, 0.5, 200.0, method=method)
    assert (found.q == q0).all()
    assert ARMS[name].coordinates


SHARED = """
schema: 1
convention: khalil_kleinfinger
arms:
  wrist:
    gravity: [0, 0, 0]
    joints:
      - {name: a, alpha: 0, d: 0, r: 0, effects: [{coulomb_friction: {magnitude: 1}}]}
      - name: b
        alpha: 0
        d: 0.3
        r: 0
        effects:
          - coulomb_friction: {magnitude: 1}
          - transmission_coupling: {inertia: 0, viscous: 0, dry: 1, other: 1, ratio: 1}
    links:
      a: {mass: 1, com: [0.2, 0, 0], inertia: [0.01, 0, 0, 0.01, 0, 0.01]}
      b: {mass: 1, com: [0.2, 0, 0], inertia: [0.01, 0, 0, 0.01, 0, 0.01]}
"""


@pytest.mark.parametrize("method", ["fixed", "DOP853"])
@pytest.mark.parametrize(
    ("inputs", "holds"),
    [
        # b bears 1 and what turns with both 1, which a must bear too
        ((0.0, 1.9), True),
        ((0.0, 2.1), False),
        ((1.9, 0.9), True),
        ((1.9, -0.3), False),
        ((-1.9, -1.9), True),
        ((1.05, -1.05), False),
    ],
)
def test_three_contacts_of_two_joints_stick_as_long_as_any_share_of_the_load_lets_them(
    inputs: tuple[float, float], holds: bool, method: str
) -> None:
    u = np.tile(inputs, (51, 1))
    found = simulate(plant(loads(SHARED)["wrist"]), [0.3, 0.7], 0.0, 0.05, 1000, u, method=method)
    assert found.ended == ""
    assert bool((found.q == found.q[0]).all()) == holds


def test_steps_of_both_kinds_agree_where_three_contacts_come_to_rest_and_tear_loose() -> None:
    t = np.arange(401) / 500
    u = np.stack([2.5 * np.sin(17 * t), 2.5 * np.sin(31 * t)], axis=1)
    made = plant(loads(SHARED)["wrist"])
    one, other = (
        simulate(made, [0.3, 0.7], 0.0, 0.8, 500, u, method=m, rtol=1e-11, atol=1e-12)
        for m in ("fixed", "DOP853")
    )
    assert one.ended == other.ended == ""
    still = (one.dq == 0.0).all(axis=1)
    assert 0.02 < still.mean() < 0.98
    np.testing.assert_allclose(one.q, other.q, atol=1e-7)
