"""What probing says an effect would add is what the arm with that effect does."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from evaluation_support import motion
from scipy.interpolate import CubicHermiteSpline, CubicSpline
from witness.arms import ARMS, WHOLE, Emitted, build, shipped
from witness.compare import agree
from witness.mechanism import states

from modelgen.backends.casadi.function import casadi_function
from modelgen.effects import CATALOGUE, Family
from modelgen.evaluation import Evaluator, Motion, places, with_effect
from modelgen.evaluation import states as series

VALUES = {
    "stribeck_friction": {"velocity": 4e3},
    "nonlinear_viscous_friction": {"exponent": 0.6, "scale": 30.0},
    "friction_warm_up": {"time": 7.0, "speed": 30.0},
    "torque_ripple": {"harmonic": 3.0, "revolution": 500.0},
    "presliding": {"distance": 20.0},
    "transmission_coupling": {"other": 1.0, "ratio": -1.0},
    "backlash": {"play": 0.01, "stiffness": 3e4, "damping": 300.0},
    "joint_flexibility": {"stiffness": 3e4, "damping": 300.0},
    "lever_geometry": {"l2": 2e-4},
    "payload_change": {"mass": 0.8, "x": 0.1},
    "base_tilt": {"x": 0.02, "y": -0.01},
    "drive_gain_error": {"error": 0.1},
    "torque_constant_saturation": {"coefficient": 1e-5},
    "encoder_offset": {"offset": 0.01},
}
LINKS = np.tile([0.3, 0.01, 0.02, 0.4, -0.01, 0.35, 0.2, 0.1, -0.1, 3.0], 10)


@cache
def evaluator(arm: str) -> Evaluator:
    return Evaluator(ARMS[arm])


def in_the_middle(m: Motion) -> Motion:
    """The motion in the middle of its steps, which a step of what rings has as its load."""
    t = np.minimum(m.t + 0.5 * m.step, m.t[-1])
    q, dq = (CubicHermiteSpline(m.t, *x)(t) for x in ((m.q, m.dq), (m.dq, m.ddq)))
    return replace(m, q=q, dq=dq, ddq=CubicSpline(m.t, m.ddq)(t))


def with_states(emitted: Emitted, m: Motion, theta: np.ndarray, start: np.ndarray) -> dict[str, np.ndarray]:
    """States along the motion from `start` (s,), stepped one sample after the other by `effects_step`."""
    extra: dict[str, np.ndarray] = {"time": m.t[:, None]}
    if not emitted.model.states:
        return extra
    state = np.atleast_2d(start)
    found = []
    takes = [a.name for a in emitted.functions["effects_step_standard"].arguments]
    for k in range(len(m.t)):
        found.append(state[0])
        more = {"ddq": m.ddq[k : k + 1]} if "ddq" in takes else {}
        state = np.atleast_2d(
            emitted(
                "effects_step_standard", m.q[k : k + 1], m.dq[k : k + 1], [[m.step]], theta, state, **more
            )
        )
    return {**extra, "state": np.array(found)}


def call(emitted: Emitted, name: str, *inputs: np.ndarray, **more: np.ndarray) -> np.ndarray:
    takes = [a.name for a in emitted.functions[name].arguments]
    return np.asarray(emitted(name, *inputs, **{k: v for k, v in more.items() if k in takes}))


@pytest.mark.parametrize("arm", ["ariane4", "scara"])
@pytest.mark.parametrize("effect", CATALOGUE)
def test_an_effect_adds_what_the_arm_with_it_does(
    effect: str, arm: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if effect == "time_delay" or not places(ARMS[arm], effect):
        pytest.skip("has no place here, or moves the record instead")
    found_at = places(ARMS[arm], effect)
    # where a slide stands along the vertical makes no difference to it
    joint = 2 if effect == "encoder_offset" else found_at[len(found_at) // 2]
    chosen = {p.name for p in CATALOGUE[effect].nonlinear}
    shown = {name: value for name, value in CATALOGUE[effect].shown.items() if name in chosen}
    values = VALUES.get(effect, shown)
    # an upright arm hides what nominal links have: tests/evaluation/test_tilted_gravity.py
    p = (
        Evaluator(replace(ARMS[arm], links=(None,) * len(ARMS[arm].joints)))
        if effect == "base_tilt"
        else evaluator(arm)
    )
    m = motion(arm)
    emitted = build(with_effect(ARMS[arm], effect, joint, values), WHOLE)
    before = shipped(arm)
    names = [s.name for s in before.model.standard]
    theta = np.ones(len(emitted.model.standard))
    new = {s.name for s in emitted.model.standard} - set(names)
    # a tilt shows parameters that an upright arm hides: these are zero for who does not know them
    shown = {b.representative for b in before.model.grouping.base}
    for k, s in enumerate(emitted.model.standard):
        link = k < 10 * len(ARMS[arm].joints)
        if s.name not in new:
            theta[k] = (LINKS[k] if link else 1e-7) if k in shown else 0.0
    plain = np.array([theta[[s.name for s in emitted.model.standard].index(name)] for name in names])
    base = before.base(plain)
    starts = [np.zeros(len(emitted.model.states))]  # a transmission's: tests/evaluation/test_elastic.py
    run = series.Series.__call__

    def noted(*given: Any, **more: Any) -> np.ndarray:
        states = run(*given, **more)
        starts.append(states[0])
        return states

    monkeypatch.setattr(series.Series, "__call__", noted)
    linear = CATALOGUE[effect].linear
    everything = {**values, **{x.name: 1.0 for x in linear}}
    found = p.contribution(effect, joint, m, everything, base)
    rings = CATALOGUE[effect].family is Family.ELASTIC
    extra = with_states(emitted, in_the_middle(m) if rings else m, theta, starts[-1])
    if "load_standard" in emitted.functions:
        extra["load"] = emitted("load_standard", m.q, theta)
    given = call(emitted, "inverse_dynamics_standard", m.q, m.dq, m.ddq, theta, **extra)
    alone = before("inverse_dynamics_standard", m.q, m.dq, m.ddq, plain)
    agree(p.inputs(m, base), alone, 1e-9)
    scale = np.abs(given).max() + np.abs(alone).max()
    np.testing.assert_allclose(found, given - alone, atol=1e-9 * scale)
    assert np.abs(found).max() > 1e-9 * scale
    if linear:
        columns = p.columns(effect, joint, m, values, base)
        assert columns.shape == (len(m.t), p.n, len(linear))
        np.testing.assert_allclose(columns.sum(axis=2), found, atol=1e-9 * scale)


def test_a_delay_moves_the_inputs_in_time() -> None:
    p, m = evaluator("ur10e"), motion("ur10e")
    base = np.ones(len(p.base.base))
    found = p.contribution("time_delay", None, m, {"delay": 15 * m.step}, base)
    now = p.inputs(m, base)
    np.testing.assert_allclose(found[:-15], now[15:] - now[:-15], atol=1e-9 * np.abs(now).max())


def test_places_follow_the_drives() -> None:
    assert places(ARMS["ariane6"], "lever_geometry") == [1, 2, 3, 5]
    assert places(ARMS["ur10e"], "lever_geometry") == []
    assert places(ARMS["ur10e"], "viscous_friction") == []  # there already
    assert places(ARMS["ur10e"], "base_tilt") == [None]
    assert places(ARMS["gravity_arm"], "drive_gain_error") == []
    assert places(ARMS["gravity_link1"], "transmission_coupling") == []


def test_a_fluid_that_drags_on_some_links_may_drag_on_the_others() -> None:
    arm = replace(ARMS["ur10e"], effects=())
    assert places(arm, "fluid_drag") == [None, 1, 2, 3, 4, 5, 6]
    some = with_effect(arm, "fluid_drag", 2, {"coefficient": 3.0})
    assert places(some, "fluid_drag") == [1, 3, 4, 5, 6]


def test_a_function_in_memory_is_the_emitted_one() -> None:
    emitted = build(ARMS["ariane4"], WHOLE)
    q, dq, ddq = states(ARMS["ariane4"], 3)
    for name, inputs in (("regressor", (q, dq, ddq)), ("motor_from_joint", (q, dq, ddq))):
        function = casadi_function(emitted.functions[name])
        expected = emitted(name, *inputs)
        for k in range(3):
            found = function(*(x[k] for x in inputs))
            for a, b in zip(
                found if isinstance(found, tuple) else [found],
                expected if isinstance(expected, tuple) else [expected],
                strict=True,
            ):
                np.testing.assert_allclose(np.squeeze(np.array(a)), np.squeeze(b[k]), rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("effect", ["presliding", "backlash"])
def test_without_a_compiler_the_states_are_the_same(effect: str, monkeypatch: pytest.MonkeyPatch) -> None:
    m, parameters = motion("ariane4"), np.ones(len(evaluator("ariane4").base.base))
    compiled = evaluator("ariane4").contribution(effect, 2, m, VALUES[effect], parameters)
    monkeypatch.setattr(series, "compiler", lambda: None)
    agree(Evaluator(ARMS["ariane4"]).contribution(effect, 2, m, VALUES[effect], parameters), compiled, 1e-12)


@pytest.mark.parametrize("pause", [1, 900])
def test_a_drive_is_as_warm_as_the_record_before_left_it(pause: int) -> None:
    """Two motions with a rest of `pause` samples between them, against all of it as one."""
    e, step = evaluator("yaw3pitch"), 0.01
    base = np.zeros(len(e.base.base))
    t = step * np.arange(2000 + pause)
    speed = np.where((t >= 1000 * step) & (t < (1000 + pause) * step), 0.0, 1.0 + np.sin(3.0 * t))
    dq = np.repeat(speed[:, None], len(e.arm.coordinates), axis=1)
    q = np.cumsum(dq, axis=0) * step
    whole = Motion(t, q, dq, np.gradient(dq, step, axis=0))

    def part(begin: int, end: int, before: Motion | None = None) -> Motion:
        every = (whole.t, whole.q, whole.dq, whole.ddq)
        return Motion(*(x[begin:end] for x in every), before=before)

    def added(m: Motion) -> np.ndarray:
        return e.columns("friction_warm_up", 1, m, VALUES["friction_warm_up"], base)

    first = part(0, 1001)  # the rest has begun
    second = part(1000 + pause, 2000 + pause, before=first)
    own, cold = added(second), added(part(1000 + pause, 2000 + pause))
    assert own == pytest.approx(added(whole)[1000 + pause :], rel=1e-9)
    assert np.abs(own[:50]).sum() < 0.999 * np.abs(cold[:50]).sum()
