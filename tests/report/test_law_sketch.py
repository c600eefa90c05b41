"""Sketches of laws against the laws as the literature has them."""

import re

import numpy as np
import pytest
from made_up_effects import in_the_catalogue

from modelgen.charts import Chart, drawn
from modelgen.effects import CATALOGUE
from modelgen.report.law_sketch import sketch

G = 9.81


def curve(chart: Chart) -> tuple[np.ndarray, np.ndarray]:
    (law,) = [c for c in chart.curves if c.role == "law"]
    return law.x, law.y


@pytest.mark.parametrize("effect", CATALOGUE)
def test_every_effect_has_a_sketch_with_units_and_a_text(effect: str) -> None:
    chart = sketch(effect)
    x, y = curve(chart)
    assert np.isfinite([x, y]).all()
    assert np.ptp(x) > 0.0
    assert np.abs(y).max() > 0.0
    assert all(re.search(r"\[.+\]$", label) for label in (chart.x_label, chart.y_label))
    assert effect in chart.text
    low, high = chart.spans()[1]
    assert low <= min(0.0, y.min()) <= max(0.0, y.max()) <= high
    assert drawn(chart) == drawn(sketch(effect))


LAWS = {
    "viscous_friction": lambda v: 0.001 * v,
    "coulomb_friction": lambda v: 0.1 * np.sign(v),
    "asymmetric_viscous_friction": lambda v: 0.0005 * abs(v),
    "stribeck_friction": lambda v: 0.1 * np.exp(-((v / 8.0) ** 2)) * np.sign(v),
    "nonlinear_viscous_friction": lambda v: 0.1 * np.abs(v / 100.0) ** 0.6 * np.sign(v),
    "friction_offset": lambda q: 0.05 + 0.0 * q,
    "load_dependent_friction": lambda load: 0.15 * load,
    "drive_inertia": lambda a: 0.0005 * a,
    "torque_ripple": lambda x: 0.05 * np.sin(0.25 * x),
    "spring": lambda q: 8.0 * q - 4.0,
    "joint_flexibility": lambda s: 4000.0 * s,
    "backlash": lambda s: 30000.0 * np.sign(s) * np.maximum(np.abs(s) - 0.005, 0.0),
    "torque_constant_saturation": lambda i: i * (1.0 - 0.002 * i**2),
}


@pytest.mark.parametrize("effect", LAWS)
def test_a_sketch_is_the_law(effect: str) -> None:
    x, y = curve(sketch(effect))
    np.testing.assert_allclose(y, LAWS[effect](x), rtol=1e-6, atol=1e-6 * np.abs(y).max())


def test_what_is_built_up_or_late_is_a_loop() -> None:
    """Presliding goes from one level to the other within some of its distance, a lag of the first order is
    late by its phase.
    """
    q, force = curve(sketch("presliding"))
    assert force.max() == pytest.approx(0.1, rel=1e-3)
    turned = q[force > 0.05].min() - q.min()  # dz/dx = 1 - z from -1 on: z = 1/2 after ln 4 distances
    assert 100.0 * turned == pytest.approx(6.0 * np.log(4.0), rel=0.05)
    given, made = curve(sketch("time_delay"))
    lag = np.arctan(2 * np.pi * 0.02)
    assert np.abs(made).max() == pytest.approx(10.0 * np.cos(lag), rel=1e-3)
    across = np.abs(made[np.argsort(np.abs(given))[:2]])
    np.testing.assert_allclose(across, 10.0 * np.cos(lag) * np.sin(lag), rtol=0.03)


def test_what_the_surroundings_do_follows_from_statics() -> None:
    """The arm is straight, and swings so slowly that gravity is nearly all of it."""
    q, torque = curve(sketch("payload_change"))  # 1 kg at the end of two links of half a metre
    np.testing.assert_allclose(torque, G * np.cos(q), atol=0.4)
    arm = 6.0 * (0.25 + 0.75)  # kg m
    q, torque = curve(sketch("encoder_offset"))
    np.testing.assert_allclose(torque, G * arm * (np.cos(q + 0.03) - np.cos(q)), atol=0.05)
    q, torque = curve(sketch("base_tilt"))
    assert np.abs(torque) == pytest.approx(np.abs(G * arm * (np.cos(q + 0.05) - np.cos(q))), abs=0.2)


def test_an_effect_that_is_added_has_its_sketch_by_itself() -> None:
    with in_the_catalogue() as added:
        for effect in added:
            _, y = curve(sketch(effect))
            assert np.abs(y).max() > 0.0
        v, force = curve(sketch("eddy_current_drag"))
        assert abs(v[np.argmax(force)]) == pytest.approx(40.0, rel=0.05)
        given, made = curve(sketch("amplifier_asymmetry"))
        np.testing.assert_allclose(made, given + 0.1 * np.abs(given))
