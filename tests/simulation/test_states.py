"""Effects with states, against the differential equations that they come from."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from simulation_support import pendulum, slider

from modelgen.description import EffectUse
from modelgen.simulation import plant, simulate

MASS = 2.0
METHODS = ["fixed", "LSODA", "cvodes"]


@pytest.mark.parametrize("method", METHODS)
def test_presliding_moves_as_dahls_equation(method: str) -> None:
    """A mass on a spring in Dahl's friction, integrated anew."""
    distance, friction, stiffness = 0.02, 3.0, 60.0
    arm = slider(
        EffectUse("presliding", {"distance": distance, "magnitude": friction}),
        EffectUse("spring", {"stiffness": stiffness, "rest": 0.0}),
        mass=MASS,
    )

    def rate(t: float, y: np.ndarray) -> list[float]:
        x, v, z = y
        return [v, (-stiffness * x - friction * z) / MASS, (v - abs(v) * z) / distance]

    times = np.arange(601) / 200
    expected = solve_ivp(rate, (0, 3), [0.4, 0, 0], "DOP853", times, rtol=1e-11, atol=1e-12).y
    found = simulate(plant(arm), 0.4, 0.0, 3.0, 200.0, method=method, step=2e-4, rtol=1e-10, atol=1e-11)
    # |v| has a corner, which costs every integrator an order.
    np.testing.assert_allclose(found.q[:, 0], expected[0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(found.states[:, 0], expected[2], rtol=0, atol=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_a_drive_warms_as_its_friction_falls(method: str) -> None:
    """A mass on a spring in dry friction that its own motion halves, integrated anew up to its first stop."""
    time, speed, excess, stiffness = 2.0, 0.5, 2.0, 30.0
    arm = slider(
        EffectUse("friction_warm_up", {"time": time, "speed": speed, "dry": excess, "viscous": 0.5}),
        EffectUse("spring", {"stiffness": stiffness, "rest": 0.0}),
        mass=MASS,
    )

    def rate(t: float, y: np.ndarray) -> list[float]:
        x, v, heat = y
        friction = (1 - heat) * (excess * np.sign(v) + 0.5 * v)
        return [v, (-stiffness * x - friction) / MASS, (abs(v) / speed - heat) / time]

    times = np.arange(150) / 200
    expected = solve_ivp(rate, (0, 0.75), [0.4, -1e-9, 0], "DOP853", times, rtol=1e-11, atol=1e-12).y
    assert (expected[1][1:] < 0).all()
    found = simulate(plant(arm), 0.4, 0.0, 0.745, 200.0, method=method, step=2e-4, rtol=1e-10, atol=1e-11)
    np.testing.assert_allclose(found.q[:, 0], expected[0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(found.states[:, 0], expected[2], rtol=0, atol=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_an_elastic_joint_is_two_masses(method: str) -> None:
    """Rotor and pendulum with a spring between them; the coordinate is the rotor's."""
    inertia, stiffness, damping, length = 0.4, 300.0, 0.5, 0.3
    arm = pendulum(
        EffectUse("drive_inertia", {"inertia": inertia}),
        EffectUse("viscous_friction", {"coefficient": 0.3}),
        EffectUse("joint_flexibility", {"stiffness": stiffness, "damping": damping}),
        mass=MASS,
        length=length,
    )
    link = MASS * length**2

    def rate(t: float, y: np.ndarray) -> list[float]:
        rotor, load, v, w = y
        spring = stiffness * (rotor - load) + damping * (v - w)
        weight = MASS * 9.81 * length * np.sin(load)
        return [v, w, (-0.3 * v - spring) / inertia, (spring - weight) / link]

    times = np.arange(401) / 200
    expected = solve_ivp(rate, (0, 2), [0.8, 0.8, 0, 0], "DOP853", times, rtol=1e-11, atol=1e-12).y
    found = simulate(plant(arm), 0.8, 0.0, 2.0, 200.0, method=method, step=5e-4, rtol=1e-10, atol=1e-11)
    assert np.abs(expected[0] - expected[1]).max() > 0.005  # the spring bends
    # The lag's gravity and centrifugal terms are taken where the link is: exact but for its own speed.
    np.testing.assert_allclose(found.q[:, 0], expected[0], rtol=0, atol=1e-3 * np.ptp(expected[0]))


@pytest.mark.parametrize("method", ["fixed", "LSODA"])
def test_play_lets_the_rotor_run_free(method: str) -> None:
    """Inside its play the rotor accelerates as if it were alone."""
    inertia, push, play = 0.01, 0.5, 0.2
    arm = pendulum(
        EffectUse("drive_inertia", {"inertia": inertia}),
        EffectUse("backlash", {"play": play, "stiffness": 500.0, "damping": 0.5}),
        mass=MASS,
    )
    count = round(0.5 * np.sqrt(play * inertia / push) * 5000)
    effort = np.full((count + 1, 1), push)
    found = simulate(plant(arm), 0.0, 0.0, count / 5000, 5000.0, effort, method=method)
    np.testing.assert_allclose(found.q[:, 0], push / inertia * found.t**2 / 2, rtol=1e-6, atol=1e-9)


def test_play_closes_at_events() -> None:
    """Rotor, gap, mass on a level rail: before, in and after contact as three masses' equations say."""
    inertia, play, stiffness, damping = 0.5, 0.1, 400.0, 0.0
    arm = slider(
        EffectUse("drive_inertia", {"inertia": inertia}),
        EffectUse("backlash", {"play": play, "stiffness": stiffness, "damping": damping}),
        mass=MASS,
    )

    def rate(push: float, y: np.ndarray) -> list[float]:
        rotor, load, v, w = y
        gap = rotor - load
        force = stiffness * (gap - np.clip(gap, -play / 2, play / 2))
        return [v, w, (push - force) / inertia, force / MASS]

    times = np.arange(501) / 250
    tight = {"rtol": 1e-11, "atol": 1e-12, "max_step": 1e-3}
    # Inputs are held over a sample; so the witness holds them too.
    path = [np.zeros(4)]
    for begin, end in pairwise(times):
        held = 2.0 * np.sin(4 * begin)

        def steady(t: float, y: np.ndarray, held: float = held) -> list[float]:
            return rate(held, y)

        path.append(solve_ivp(steady, (begin, end), path[-1], "DOP853", **tight).y[:, -1])
    expected = np.array(path)
    effort = 2.0 * np.sin(4 * times)[:, None]
    found = simulate(plant(arm), 0.0, 0.0, 2.0, 250.0, effort, method="DOP853", rtol=1e-10, atol=1e-12)
    assert np.abs(expected[:, 0] - expected[:, 1]).max() > play / 2  # it has touched
    assert np.abs(expected[:, 0] - expected[:, 1]).min() < play / 2
    np.testing.assert_allclose(found.q[:, 0], expected[:, 0], rtol=0, atol=1e-7)
    np.testing.assert_allclose(found.states[:, 0], expected[:, 0] - expected[:, 1], rtol=0, atol=1e-7)
