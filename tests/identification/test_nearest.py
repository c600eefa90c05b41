"""Consistent parameters of arms of every kind, by what is true of a convex problem's answer alone."""

from dataclasses import replace

import numpy as np
import pytest
from witness.arms import random_arm
from witness.bodies import random_bodies
from witness.mechanism import Mechanism

from modelgen.functions import Model, Options, build_model
from modelgen.functions.nominal import base_matrix
from modelgen.identification.bodies import plain, violations
from modelgen.identification.consistent import PRIOR, _root, consistent
from modelgen.identification.nearest import Nearest
from modelgen.numeric import Array

NOISE = (0.0, 0.01, 0.1, 0.3)


def drawn(seed: int) -> tuple[Model, Array, Array, Array]:
    """An arm, standard parameters that could exist, noisy base parameters and their precision."""
    rng = np.random.default_rng(seed)
    model = build_model(replace(random_arm(seed, dressed=True), fluid_density=0.0), Options())
    truth = Mechanism(model.arm).standard(random_bodies(model.arm, rng), rng)
    base = base_matrix(model) @ truth
    size = np.maximum(np.abs(base), 1e-3 * np.abs(base).max()) * rng.uniform(0.3, 1.0, len(base))
    noise = NOISE[seed % len(NOISE)]
    theta = base + noise * size * rng.normal(size=len(base))
    return model, truth, theta, np.diag(1 / (max(noise, 1e-3) * size) ** 2)


@pytest.mark.parametrize("seed", range(8))
def test_links_could_exist_and_no_others_are_nearer(seed: int) -> None:
    model, truth, theta, precision = drawn(seed)
    found = consistent(model, theta, precision)
    assert violations(model, found.standard) == ()
    root = _root(precision)
    problem = Nearest(model, root @ base_matrix(model), root @ theta, plain(model, theta))
    # The arm that made the data could exist, and so could what lies on the way to it: none is better.
    least = problem.value(found.standard, 1 / PRIOR)
    for share in (1.0, 0.1, 1e-3):
        assert problem.value(found.standard + share * (truth - found.standard), 1 / PRIOR) >= least - 1e-6
    if seed % len(NOISE) == 0:
        assert found.distance < 0.05


@pytest.mark.parametrize("seed", range(4))
def test_what_no_body_is_near_has_an_answer_too(seed: int) -> None:
    """Efforts counted the other way round: bodies as light as can be, on the edge of what could exist."""
    model, _, theta, precision = drawn(seed)
    found = consistent(model, -theta, 1e4 * precision)
    assert np.isfinite(found.base).all()
    assert found.violated
    assert found.distance > 1.0
