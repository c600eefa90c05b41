"""Arms in water: buoyancy as a force at each centre of volume, pushed through Pinocchio."""

import functools
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from witness.arms import ARMS, Emitted, build, shipped
from witness.bodies import Body, random_bodies
from witness.compare import agree
from witness.geometry import number, poses
from witness.mechanism import states
from witness.rigid_bodies import RigidBodies

DENSITY = 1025.0
NAMES = ["ariane4", "ariane4_free", "wam7", "scara", "two_fingers"]
EACH = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in NAMES]


@functools.cache
def submerged(name: str) -> Emitted:
    return build(replace(ARMS[name], fluid_density=DENSITY))


def standard(bodies: list[Body], volumes: list[float], centres: np.ndarray) -> np.ndarray:
    """Fourteen parameters a link."""
    rows = [[*b.ten, *(v * c), v] for b, v, c in zip(bodies, volumes, centres, strict=True)]
    return np.concatenate(rows)


@pytest.mark.parametrize("name", EACH)
def test_the_fluid_pushes_up_at_the_centre_of_volume(name: str) -> None:
    emitted = submerged(name)
    arm = emitted.arm
    rng = np.random.default_rng(4)
    bodies = random_bodies(arm, rng)
    volumes = [float(v) for v in rng.uniform(0.5e-3, 4e-3, len(bodies))]
    centres = rng.uniform(-0.2, 0.2, (len(bodies), 3))
    witness = RigidBodies(arm, bodies, every_joint=True)
    q, dq, ddq = states(arm, 6)
    expected = []
    for sample in zip(q, dq, ddq, strict=True):
        forces = {}
        for i, frame in enumerate(poses(arm, sample[0])):
            up = frame[:3, :3].T @ (-DENSITY * volumes[i] * np.array(arm.gravity))  # in the link's axes
            forces[i] = pin.Force(up, np.cross(centres[i], up))
        expected.append(witness.effort(*sample, forces))
    theta = standard(bodies, volumes, centres)
    agree(emitted("inverse_dynamics_standard", q, dq, ddq, theta), expected)
    agree(emitted("inverse_dynamics", q, dq, ddq, emitted.base(theta)), expected)
    agree(emitted("regressor", q, dq, ddq) @ emitted.base(theta), expected)
    agree(emitted("forward_dynamics", q, dq, expected, emitted.base(theta)), ddq)
    agree(emitted("mass_matrix", q, emitted.base(theta)), [witness.mass_matrix(x) for x in q])


@pytest.mark.parametrize("name", EACH)
def test_a_neutrally_buoyant_arm_has_inertia_and_no_weight(name: str) -> None:
    emitted = submerged(name)
    bodies = random_bodies(emitted.arm, np.random.default_rng(4))
    volumes = [b.mass / DENSITY for b in bodies]
    theta = standard(bodies, volumes, np.array([b.com for b in bodies]))
    q, dq, _ = states(emitted.arm, 6)
    weight = emitted("gravity_standard", q, standard(bodies, [0.0] * len(bodies), np.zeros((len(bodies), 3))))
    for suffix, parameters in (("", emitted.base(theta)), ("_standard", theta)):
        assert np.abs(emitted(f"gravity{suffix}", q, parameters)).max() <= 1e-12 * np.abs(weight).max()
        mass = emitted(f"mass_matrix{suffix}", q, parameters)
        assert np.linalg.eigvalsh(mass).min() > 0
        kinetic, potential = emitted(f"energy{suffix}", q, dq, parameters)
        assert np.ptp(potential) <= 1e-11 * np.abs(weight).max()
        assert kinetic.min() > 0
    assert np.abs(weight).max() > 1


@pytest.mark.parametrize("name", EACH)
def test_what_can_be_told_in_air_can_be_told_in_water(name: str) -> None:
    dry, wet = shipped(name, "links"), submerged(name)
    names = {base.name.rstrip("R") for base in wet.model.grouping.base}
    assert {base.name.rstrip("R") for base in dry.model.grouping.base} <= names
    volumes = [base.name for base in wet.model.grouping.base if base.name.startswith("V")]
    assert volumes
    assert f"identifiable in the fluid besides those in air: {', '.join(volumes)}" in wet.model.remarks


def test_gravity_alone_cannot_tell_mass_from_volume() -> None:
    """MX1 of a planar arm shows in gravity only, with what it displaces; MX2 in the inertia too."""
    emitted = build(replace(ARMS["gravity_arm"], fluid_density=DENSITY))
    base = {b.name: b for b in emitted.model.grouping.base}
    assert list(base) == ["ZZ1R", "MX1R", "MY1R", "ZZ2", "MX2", "MY2", "VX2", "VY2"]
    names = [p.name for p in emitted.model.standard]
    factors = {names[k]: number(emitted.arm, f) for k, f in base["MX1R"].terms}
    d2 = 0.538534
    assert factors == pytest.approx({"MX1": 1, "M2": d2, "VX1": -DENSITY, "V2": -DENSITY * d2})
