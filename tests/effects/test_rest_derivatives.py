"""Derivatives of every law at rest are finite: an optimiser begins there."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from diagnosis_support import ARM

from modelgen.backends.casadi.function import casadi_function
from modelgen.description import Arm, EffectUse
from modelgen.effects import CATALOGUE
from modelgen.errors import InputError
from modelgen.functions import Options, build_model

EXPONENTS = (0.3, 0.7, 1.0, 1.6, 2.0)


def uses() -> list[tuple[str, dict[str, float]]]:
    """Every effect of the catalogue with usual values, powers with others too."""
    found = []
    for name, effect in CATALOGUE.items():
        own = {p.name for p in effect.accepted()}
        values = {key: value for key, value in effect.shown.items() if key in own}
        found.append((name, values))
        if "exponent" in own:
            found += [(name, values | {"exponent": e}) for e in EXPONENTS]
            if "smoothing" in own:
                found += [(name, values | {"exponent": e, "smoothing": 0.5}) for e in EXPONENTS]
    return found


def with_use(name: str, values: dict[str, float]) -> Arm:
    """The bench arm with the effect at its second joint, or as a whole."""
    use = EffectUse(name, values)
    if CATALOGUE[name].scope == "arm":
        return replace(ARM, effects=(use,))
    first, second = ARM.joints
    kept = tuple(u for u in second.effects if u.name != name)
    return replace(ARM, joints=(first, replace(second, effects=(*kept, use))))


@pytest.mark.parametrize(("name", "values"), uses(), ids=lambda x: x if isinstance(x, str) else "")
def test_the_slope_at_rest_is_finite(name: str, values: dict[str, float]) -> None:
    try:
        model = build_model(with_use(name, values), Options())
    except InputError as error:
        pytest.skip(str(error))
    for wanted in ("inverse_dynamics", "forward_dynamics"):
        function = casadi_function(next(f for f in model.functions if f.name == wanted))
        given = {"q": [0.3, -0.4], "dq": [0.0, 0.0], "ddq": [0.5, 0.2], "input": [0.1, 0.2]}
        inputs = [
            given.get(function.name_in(i), np.full(function.size1_in(i), 0.8)) for i in range(function.n_in())
        ]
        slopes = function.factory(
            "slopes", function.name_in(), [f"jac:{function.name_out(0)}:{x}" for x in ("q", "dq")]
        )
        for slope in slopes(*inputs):
            assert np.isfinite(ca.DM(slope).full()).all(), (name, values, wanted)
