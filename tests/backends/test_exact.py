"""Values that are the same on every machine."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from arms_support import ARMS, inputs, model

from modelgen.backends.exact import exact_values
from modelgen.backends.numpy import NumpyFunction
from modelgen.backends.provenance import Provenance
from modelgen.description import EffectUse
from modelgen.functions import Options, build_model
from modelgen.packaging import self_test as packaging_self_test
from modelgen.packaging.self_test import self_test

PROVENANCE = Provenance("modelgen test", "0" * 64)


@pytest.mark.parametrize(
    ("name", "variant"), [("yaw3pitch", "default"), ("ariane4", "default"), ("yaw3pitch", "effects")]
)
def test_values_are_those_of_numpy_to_its_last_digits(name: str, variant: str) -> None:
    made = model(name, variant)
    for f in made.functions:
        given = inputs(made, f, np.random.default_rng(3))
        found = NumpyFunction(f)(*given)
        flat = np.concatenate([np.ravel(x) for x in (found if isinstance(found, tuple) else (found,))])
        if not np.isfinite(flat).all():
            continue
        known = {a.name: x for a, x in zip(f.arguments, given, strict=True)}
        values = exact_values(f, known)
        if values is None:  # random parameters are those of no body, and may leave a pivot below zero
            assert f.name.startswith("forward_dynamics")
            continue
        exact = np.array([float(x) for x in values])
        assert np.abs(exact - flat).max() <= 1e-9 * max(1.0, np.abs(flat).max()), f.name


class Elsewhere(NumpyFunction):
    """As on a machine whose functions differ in the last digit."""

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        found = super().__call__(*args, **kwargs)
        return tuple(x * (1 + 2e-16) for x in found) if isinstance(found, tuple) else found * (1 + 2e-16)


def test_the_program_for_the_target_does_not_depend_on_the_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    made = model("ariane4")
    here = self_test(made, PROVENANCE)
    monkeypatch.setattr(packaging_self_test, "NumpyFunction", Elsewhere)
    assert self_test(made, PROVENANCE) == here


def test_a_drive_without_inertia_before_an_elastic_joint_leaves_no_acceleration_to_compare() -> None:
    arm = ARMS["yaw3pitch"]
    elastic = EffectUse("joint_flexibility", {"stiffness": 5000.0, "damping": 10.0})
    first = replace(arm.joints[0], effects=(*arm.joints[0].effects, elastic))
    made = build_model(replace(arm, joints=(first, *arm.joints[1:])), Options(without=frozenset({"drives"})))
    program = self_test(made, PROVENANCE)
    assert "yaw3pitch_inverse_dynamics(" in program
    assert "yaw3pitch_forward_dynamics(" not in program
