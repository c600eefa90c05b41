"""An elastic joint behind a lever: rotor, spring and link by Lagrange, in the actuator's own coordinate."""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from witness.arms import build

from modelgen.description import Arm, EffectUse, Inertial, Joint, LeveredDrive
from modelgen.functions import Options

L1, L2, SHORT, LONG, TURNS, CONSTANT, OFFSET = 0.35, 0.09, 0.29, 0.417, 160.0, 0.06, -1.4
MASS, REACH, ROTOR, INERTIA = 9.0, 0.4, 1.5e-6, 0.03
STIFFNESS = 900.0  # N m/rad at the joint in mid-stroke
PER_METRE = TURNS / (LONG - SHORT)


def motor(q: float) -> float:
    """Counts [unit] at an angle of the link."""
    return PER_METRE * (math.sqrt(L1**2 + L2**2 - 2 * L1 * L2 * math.cos(q - OFFSET)) - SHORT)


def ratio(q: float) -> float:
    """d motor / dq."""
    length = math.sqrt(L1**2 + L2**2 - 2 * L1 * L2 * math.cos(q - OFFSET))
    return PER_METRE * L1 * L2 * math.sin(q - OFFSET) / length


def angle(x: float) -> float:
    """The angle at which the link stood if it followed."""
    return float(brentq(lambda q: motor(q) - x, OFFSET + 0.05, OFFSET + math.pi - 0.05, xtol=1e-14))


def test_the_actuator_is_the_spring() -> None:
    values = {"stiffness": STIFFNESS, "damping": 0.0}
    drive = LeveredDrive(L1, L2, (SHORT, LONG), (0.0, TURNS), 1, OFFSET, CONSTANT)
    effects = (EffectUse("drive_inertia"), EffectUse("joint_flexibility", values))
    link = Inertial(MASS, (REACH, 0.0, 0.0), (0.0, 0.0, 0.0, INERTIA, 0.0, INERTIA))
    arm = Arm("one", (Joint("j1", "revolute", drive=drive, effects=effects),), (link,), (0.0, -9.81, 0.0))
    emitted = build(arm, Options())
    about = INERTIA + MASS * REACH**2
    theta = np.array([0, 0, 0, about, 0, about, MASS * REACH, 0, 0, MASS, ROTOR])
    spring = STIFFNESS / ratio(angle(TURNS / 2)) ** 2  # J/unit^2
    hold = MASS * 9.81 * REACH * math.cos(0.2) / ratio(0.2)  # J/unit

    def force(t: float) -> float:
        return hold * (1.0 + 0.6 * math.sin(9.0 * t))

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, q, dx, dq = y
        pull = spring * (x - motor(q))
        weight = MASS * 9.81 * REACH * math.cos(q)
        return [dx, dq, (force(t) - pull) / ROTOR, (ratio(q) * pull - weight) / about]

    span, dt = 0.5, 1e-4
    start = [motor(0.2) + hold / spring, 0.2, 0.0, 0.0]
    exact = solve_ivp(rates, (0.0, span), start, rtol=1e-10, atol=1e-11, dense_output=True).sol
    q = np.array([angle(start[0])])
    dq, state = np.zeros(1), np.array([q[0] - 0.2, 0.0])
    for k in range(round(span / dt)):
        given = [force((k + 0.5) * dt) / CONSTANT]
        ddq = emitted("forward_dynamics_standard", q, dq, given, theta, state=state)
        after = emitted("effects_step_standard", q, dq, [dt], theta, state, ddq=ddq)
        q, dq, state = q + dt * dq + dt**2 / 2 * ddq, dq + dt * ddq, after
    x, low, _, _ = exact(span)
    path = np.array([exact(t)[:2] for t in np.linspace(0, span, 200)])
    lags = np.array([angle(a) - b for a, b in path])
    assert np.ptp(path[:, 1]) > 0.1  # far enough for the lever's ratio to change
    assert abs(q[0] - angle(x)) < 5e-3 * np.ptp(path[:, 1])
    assert abs(state[0] - (angle(x) - low)) < 0.05 * np.ptp(lags)
    back = emitted("inverse_dynamics_standard", q, dq, ddq, theta, state=state)
    np.testing.assert_allclose(
        emitted("forward_dynamics_standard", q, dq, back, theta, state=state), ddq, rtol=1e-9
    )
