"""Inverse dynamics at the joints, in N m: what the drives give at the inputs of inverse dynamics."""

from collections.abc import Callable

import numpy as np
import pytest
from arms_support import ARMS, inputs, model

from modelgen.backends import NumpyFunction
from modelgen.evaluation import with_effect
from modelgen.functions import Model, Options, build_model


def saturating() -> Model:
    arm = with_effect(ARMS["ariane4"], "torque_constant_saturation", 3, {"coefficient": 1e-7})
    return build_model(arm, Options(derivatives=False, watch=False))


@pytest.mark.parametrize("suffix", ["", "_standard"])
@pytest.mark.parametrize("make", [lambda: model("ariane4"), lambda: model("scara"), saturating])
def test_it_is_the_gain_times_the_input(make: Callable[[], Model], suffix: str) -> None:
    made = make()
    of = {f.name: NumpyFunction(f) for f in made.functions}
    effort = of[f"joint_effort{suffix}"]
    rng = np.random.default_rng(3)
    for _ in range(5):
        drawn = inputs(made, effort.function, rng)
        given = dict(zip((a.name for a in effort.function.arguments), drawn, strict=True))
        given["parameters"] = 1e-4 * given["parameters"]  # currents that saturate little
        inverse = of[f"inverse_dynamics{suffix}"]
        current = inverse(**{a.name: given[a.name] for a in inverse.function.arguments})
        if "effective_input" in of:
            current = of["effective_input"](current)
        gains = of["drive_gain"]
        expected = current * gains(**{a.name: given[a.name] for a in gains.function.arguments})
        np.testing.assert_allclose(effort(**given), expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())


def test_an_arm_without_drives_has_the_efforts_as_inputs() -> None:
    assert "joint_effort" not in [f.name for f in model("yaw3pitch").functions]
