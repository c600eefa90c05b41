"""Arms that ship, identified and diagnosed from records of their own model."""

import numpy as np
import pytest

import modelgen as mg


def recorded(arm: mg.Arm, seed: int) -> dict[str, np.ndarray]:
    """A periodic motion of 20 s at 100 Hz with the inputs of the nominal model, and noise of 1 %."""
    random, t, n = np.random.default_rng(seed), np.arange(2000) / 100.0, len(arm.coordinates)
    w = 2 * np.pi / 10.0 * np.arange(1, 5)
    a, phase = 0.05 * random.normal(size=(2, n, 4))
    turned = w * t[:, None, None] + 50.0 * phase
    q, dq, ddq = (
        x.sum(axis=2) for x in (a * np.sin(turned), a * w * np.cos(turned), -a * w**2 * np.sin(turned))
    )
    model = mg.build_model(arm)
    dynamics = model.functions["inverse_dynamics"]
    given = {"q": q, "dq": dq, "ddq": ddq, "parameters": np.asarray(model.nominal)}
    u = np.asarray(dynamics(**{x.name: given[x.name] for x in dynamics.function.arguments})).reshape(q.shape)
    u += 0.01 * u.std(axis=0) * random.normal(size=u.shape)
    columns = {f"q{j + 1}": q[:, j] for j in range(n)} | {f"i{j + 1}": u[:, j] for j in range(n)}
    return {"t": t, **columns}


@pytest.mark.parametrize("name", ["screw_axis"])
def test_nothing_is_missing_in_records_of_the_model_itself(name: str) -> None:
    """A screw that lifts a mass: no parameter of it is one of a link alone."""
    arm = mg.load_arms()[name]
    one, two, test = (recorded(arm, seed) for seed in range(3))
    found = mg.identify(arm, [one, two], test)
    nominal = np.asarray(mg.build_model(arm).nominal)
    for value, expected in zip(found.parameters.values(), nominal, strict=True):
        assert value.std is None or abs(value.value - expected) < 5.0 * value.std + 1e-9
    assert mg.diagnose(arm, [one, two], test, experiment=False, processes=1).verdict == "nothing_missing"
