"""Forward dynamics in C of arms of any size, against the two equations of motion of a double pendulum."""

from pathlib import Path

import numpy as np
import pytest
from c_support import Library, shared_library, write

from modelgen.description import loads
from modelgen.functions import Options, build_model, nominal_standard
from modelgen.generation.arm import print_model

LENGTHS = (0.01, 0.1, 1.0, 30.0)  # m, of a link: a jumping robot's leg to a crane
STATUS_PIVOT = 2
GRAVITY = 9.81
Q, RATES = np.array([0.3, 0.4]), np.array([1.5, -2.0])


def masses(length: float) -> tuple[float, float]:
    """Mass [kg] and inertia about the centre of mass [kg m^2] of a link of wood, a tenth as thick as long."""
    mass = 600 * 0.01 * length**3
    return mass, mass * length**2 / 12


def library(length: float, folder: Path, *, second: bool = True) -> tuple[Library, np.ndarray]:
    """The C of a double pendulum and its standard parameters. second: whether its last link has a mass."""
    mass, inertia = masses(length)
    link = f"mass: {mass!r}, com: [{length / 2!r}, 0, 0], inertia: [0, 0, 0, {inertia!r}, 0, {inertia!r}]"
    none = "mass: 0, com: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0]"
    text = f"""
schema: 1
convention: khalil_kleinfinger
arms:
  leg:
    joints:
      - {{name: j1, alpha: pi/2}}
      - {{name: j2, d: {length!r} m}}
    links:
      j1: {{{link}}}
      j2: {{{link if second else none}}}
"""
    arm = loads(text)["leg"]
    model = build_model(arm, Options())
    write(print_model(model, arm, {}).files, folder)
    found = Library(shared_library(folder, "leg", "double"), model, "double")
    return found, np.array(list(nominal_standard(model).values()))


def pendulum(length: float) -> np.ndarray:
    """Accelerations of a double pendulum without input; angles from the horizontal (Goldstein 1980)."""
    mass, inertia = masses(length)
    (a, b), half = Q, length / 2
    own, coupled = inertia + mass * half**2, mass * length * half
    matrix = np.array(
        [
            [2 * own + mass * length**2 + 2 * coupled * np.cos(b), own + coupled * np.cos(b)],
            [own + coupled * np.cos(b), own],
        ]
    )
    swing = coupled * np.sin(b)
    turning = swing * np.array([-RATES[1] * (2 * RATES[0] + RATES[1]), RATES[0] ** 2])
    last = mass * GRAVITY * half * np.cos(a + b)
    weight = np.array([mass * GRAVITY * (half + length) * np.cos(a) + last, last])
    return np.linalg.solve(matrix, -turning - weight)


@pytest.mark.parametrize("length", LENGTHS)
def test_arms_of_any_size_move(length: float, tmp_path: Path) -> None:
    leg, standard = library(length, tmp_path)
    status, found = leg.call("forward_dynamics_standard", Q, RATES, np.zeros(2), standard)
    assert status == 0
    np.testing.assert_allclose(found["out"], pendulum(length), rtol=1e-9)


@pytest.mark.parametrize("length", LENGTHS)
def test_a_link_without_mass_has_no_acceleration_at_any_size(length: float, tmp_path: Path) -> None:
    leg, standard = library(length, tmp_path, second=False)
    status, found = leg.call("forward_dynamics_standard", Q, RATES, np.zeros(2), standard)
    assert status == STATUS_PIVOT
    assert not found["out"].any()
