"""Articulated bodies accelerate as the mass matrix says, and the Newton-Euler recursion takes them back."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from arms_support import ARMS
from peers.growing import arm as grown

from modelgen.base_parameters import group
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm, Joint
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.parametric import base_values, standard_values
from modelgen.graph import Expr
from modelgen.graph.evaluate import evaluate
from modelgen.graph.live import cost
from modelgen.model.articulated import accelerations
from modelgen.model.effect_forces import EffectForces
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, link_motions
from modelgen.numeric import Array


def by_bodies(d: Dynamics) -> tuple[list[Expr], list[Expr]]:
    """Accelerations for the inputs, and what must be positive."""
    e = d.equations
    rates = Rates(e.vector("dq"), e.zeros())
    effects = EffectForces(e, rates, d.values)
    ideal, gains, added = effects.effective(e.vector("input")), d.gains(), effects.efforts()
    efforts = [i * gain - extra for i, gain, extra in zip(ideal, gains, added, strict=True)]
    drives = [row[k] for k, row in enumerate(effects.masses())]
    links = e.link_values(d.values)
    return accelerations(e.frames, link_motions(e.frames, rates), links, efforts, drives)


def states(e: Equations, samples: int, names: list[str]) -> dict[str, Array]:
    """States within the limits, inputs, and parameters of heavy links whose last one is not lightest."""
    rng = np.random.default_rng(5)
    joints = [e.arm.joints[k] for k in e.arm.coordinates]
    ends = np.array([j.limits.position or (-2.0, 2.0) for j in joints])
    middle, half = ends.mean(axis=1), np.ptp(ends, axis=1) / 2
    heavy = [name.rstrip("R").rstrip("0123456789") in ("XX", "YY", "ZZ", "M", "IA") for name in names]
    return {
        "q": middle + 0.8 * half * rng.uniform(-1, 1, (samples, e.n)),
        "dq": rng.uniform(-1, 1, (samples, e.n)),
        "input": rng.uniform(-1, 1, (samples, e.n)),
        "parameters": rng.uniform(0.5, 1.0, (samples, len(names))) * np.where(heavy, 100.0, 0.1),
    }


@pytest.mark.parametrize("name", ["ariane4", "scara", "ur10e", "two_fingers", "iiwa14_bench"])
def test_shipped_arms_accelerate_as_by_the_mass_matrix(name: str) -> None:
    """Levers, gears, slides, trees and locked joints; with the parameters of a grouping."""
    grouping = group(Equations(ARMS[name]))
    e = Equations(slid(ARMS[name]))
    d = Dynamics(e, base_values(e, grouping))
    found, positive = by_bodies(d)
    expected, _ = d.forward_dynamics(e.vector("dq"), e.vector("input"))
    given = states(e, 20, [b.name for b in grouping.base])
    values = evaluate([*expected, *found, *positive], given, 20)
    n = e.n
    scale = np.abs(values[:, :n]).max(axis=1, keepdims=True)
    assert np.abs(values[:, n : 2 * n] - values[:, :n]).max() <= 1e-11 * scale.max()
    assert (values[:, 2 * n :] > 0).all()


def mixed() -> Arm:
    """A tree of twelve joints, two of them slides and one locked, turned about all axes."""
    arm = grown("chain", 12)
    joints: list[Joint] = list(arm.joints)
    for k, changes in {
        2: {"type": "prismatic", "alpha": pi / 2, "theta": 0.3},
        5: {"gamma": 0.4, "b": 0.1},
        6: {"locked": 0.7},
        7: {"type": "prismatic", "alpha": 1.1},
        9: {"antecedent": 4},
    }.items():
        joints[k] = replace(joints[k], **changes)
    return replace(arm, joints=tuple(joints))


def test_the_recursion_of_newton_and_euler_takes_the_accelerations_back_to_the_inputs() -> None:
    e = Equations(mixed())
    d = Dynamics(e, standard_values(e))
    found, positive = by_bodies(d)
    given = states(e, 10, [p.name for p in e.standard])
    values = evaluate([*found, *positive], given, 10)
    assert (values[:, e.n :] > 0).all()
    back = d.inverse_dynamics(e.vector("dq"), e.vector("ddq"))
    inputs = evaluate(back, {**given, "ddq": values[:, : e.n]}, 10)
    np.testing.assert_allclose(inputs, given["input"], atol=1e-9)


def test_the_operations_of_a_chain_grow_as_its_length() -> None:
    """Of the mass matrix and its solution as the square at the least: by 1.3 where these grow by one."""
    counts = []
    for n in (12, 16, 20):
        e = Equations(grown("chain", n))
        d = Dynamics(e, standard_values(e))
        chosen = d.forward_dynamics(e.vector("dq"), e.vector("input"))
        counts.append(cost(e.graph, [*chosen[0], *chosen[1]]))
    assert counts[2] - counts[1] < 1.05 * (counts[1] - counts[0])


def test_a_link_of_no_inertia_fails_its_guard() -> None:
    """Two parallel joints between which nothing has mass: one equation for two accelerations."""
    arm = grown("chain", 9)
    joints = tuple(replace(j, alpha=0.0, d=0.0, r=0.0) if k == 8 else j for k, j in enumerate(arm.joints))
    e = Equations(replace(arm, joints=joints))
    d = Dynamics(e, standard_values(e))
    _, positive = by_bodies(d)
    given = states(e, 5, [p.name for p in e.standard])
    given["parameters"][:, [p.name.endswith("8") for p in e.standard]] = 0.0
    with np.errstate(all="ignore"):  # what follows a guard is not computed in C
        found = evaluate(positive, given, 5)
    assert (~(found > 0)).any(axis=1).all()
