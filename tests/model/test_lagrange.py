"""A two-link arm by Lagrange's equations, its second joint on a screw and a lever, from scratch in SymPy.

Everything that moves has its own kinetic energy: links, rotor, the screw that turns and the rod that
travels with its nut. That the last two merge into one coefficient is a result, not an input.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp
from witness.arms import build
from witness.compare import agree

from modelgen.description import Arm, DirectDrive, EffectUse, Joint, LeveredDrive
from modelgen.functions import Options

# links: mass [kg], centre of mass [m], inertia about it [kg m^2]
M1, X1, Y1, J1 = 4.0, 0.21, 0.03, 0.09
M2, X2, Y2, J2 = 2.5, 0.17, -0.04, 0.05
LENGTH, G = 0.45, 9.81
# joint 1: gear ratio, rotor inertia, viscous and dry friction at the rotor, torque constant
RATIO, ROTOR, VISCOUS1, DRY1, KT1 = 80.0, 3e-5, 2e-4, 0.04, 0.06
# joint 2: screw
LEAD, SCREW, ROD, KT2 = 0.005, 8e-6, 1.7, 0.05  # m, kg m^2, kg, N m/A at the screw
VISCOUS_TURN, VISCOUS_SLIDE, DRY_TURN, DRY_SLIDE = 3e-4, 40.0, 0.01, 12.0
L1, L2, SHORT, LONG = 0.3, 0.08, 0.23, 0.37
OFFSET = -0.9


@functools.cache
def lagrange(rev: int) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Currents, and kinetic and potential energy, over q1 q2 dq1 dq2 ddq1 ddq2."""
    t = sp.Symbol("t")
    q = [sp.Function(f"q{i}")(t) for i in (1, 2)]
    dq = [sp.diff(x, t) for x in q]

    def turned(angle: Any, x: float, y: float) -> sp.Matrix:
        return sp.Matrix([sp.cos(angle) * x - sp.sin(angle) * y, sp.sin(angle) * x + sp.cos(angle) * y])

    first = turned(q[0], X1, Y1)
    second = turned(q[0], LENGTH, 0) + turned(q[0] + q[1], X2, Y2)
    speeds = [point.diff(t) for point in (first, second)]
    # the actuator's pins in the plane of the lever
    inner = rev * (q[1] - OFFSET)
    reach = sp.Matrix([L2 * sp.cos(inner) - L1, L2 * sp.sin(inner)])
    rod = sp.sqrt(reach.dot(reach)).diff(t)  # travel of the rod, m/s
    screw = 2 * sp.pi / LEAD * rod  # rad/s
    rotor = RATIO * dq[0]
    kinetic = (
        M1 * speeds[0].dot(speeds[0])
        + M2 * speeds[1].dot(speeds[1])
        + J1 * dq[0] ** 2
        + J2 * (dq[0] + dq[1]) ** 2
        + ROTOR * rotor**2
        + SCREW * screw**2
        + ROD * rod**2
    ) / 2
    potential = G * (M1 * first[1] + M2 * second[1])
    # friction by its power: a force along each speed
    resisting = [
        (VISCOUS1 * rotor + DRY1 * sp.sign(rotor), rotor),
        (VISCOUS_TURN * screw + DRY_TURN * sp.sign(screw), screw),
        (VISCOUS_SLIDE * rod + DRY_SLIDE * sp.sign(rod), rod),
    ]
    efforts = []
    for x, v in zip(q, dq, strict=True):
        lagrangian = kinetic - potential
        friction = sum(force * sp.diff(speed, v) for force, speed in resisting)
        efforts.append(lagrangian.diff(v).diff(t) - lagrangian.diff(x) + friction)
    # virtual work of the currents
    currents = [efforts[0] / (KT1 * RATIO), efforts[1] / (KT2 * sp.diff(screw, dq[1]))]
    plain = sp.symbols("a1 a2 v1 v2 x1 x2")
    named = dict(zip([*(sp.diff(x, t, 2) for x in q), *dq, *q], plain, strict=True))
    arguments = [plain[k] for k in (4, 5, 2, 3, 0, 1)]
    return (
        sp.lambdify(arguments, [e.subs(named) for e in currents]),
        sp.lambdify(arguments, [e.subs(named) for e in (kinetic, potential)]),
    )


def arm(rev: int, motor: tuple[float, float]) -> Arm:
    """The same machine as a description; the lever counts in any unit from motor[0] to motor[1]."""
    effects = tuple(EffectUse(name) for name in ("viscous_friction", "coulomb_friction", "drive_inertia"))
    per_metre = (motor[1] - motor[0]) / (LONG - SHORT)
    joints = (
        Joint("j1", "revolute", drive=DirectDrive(RATIO, KT1), effects=effects),
        Joint(
            "j2",
            "revolute",
            d=LENGTH,
            antecedent=0,
            drive=LeveredDrive(
                L1, L2, (SHORT, LONG), motor, rev, OFFSET, KT2 * 2 * math.pi / LEAD / per_metre
            ),
            effects=effects,
        ),
    )
    return Arm("two_links", joints, (None, None), (0.0, -G, 0.0))


def standard(motor: tuple[float, float]) -> dict[str, float]:
    """Standard parameters: those of a plane, and one coefficient for all that goes with the screw."""
    per_metre = (motor[1] - motor[0]) / (LONG - SHORT)
    turns = 2 * math.pi / LEAD
    return {
        "ZZ1": J1 + M1 * (X1**2 + Y1**2),
        "MX1": M1 * X1,
        "MY1": M1 * Y1,
        "M1": M1,
        "ZZ2": J2 + M2 * (X2**2 + Y2**2),
        "MX2": M2 * X2,
        "MY2": M2 * Y2,
        "M2": M2,
        "IA1": ROTOR,
        "FV1": VISCOUS1,
        "FC1": DRY1,
        "IA2": (ROD + SCREW * turns**2) / per_metre**2,
        "FV2": (VISCOUS_SLIDE + VISCOUS_TURN * turns**2) / per_metre**2,
        "FC2": (DRY_SLIDE + DRY_TURN * turns) / abs(per_metre),
    }


@pytest.mark.parametrize("rev", [1, -1])
@pytest.mark.parametrize("motor", [(0.0, 20850.0), (20850.0, 0.0), (-3.0, 120.0)])
def test_currents_and_energy_of_the_levered_arm(rev: int, motor: tuple[float, float]) -> None:
    emitted = build(arm(rev, motor), Options())
    values = standard(motor)
    theta = np.array([values.get(p.name, 0.0) for p in emitted.model.standard])
    rng = np.random.default_rng(2)
    q = rng.uniform(-3, 3, (20, 2))
    inner = rng.uniform(0.5, 2.4, 20)
    length = np.sqrt(L1**2 + L2**2 - 2 * L1 * L2 * np.cos(inner))
    assert SHORT < length.min() < length.max() < LONG
    q[:, 1] = OFFSET + rev * inner
    dq, ddq = rng.uniform(-2, 2, (20, 2)), rng.uniform(-5, 5, (20, 2))
    currents, energies = lagrange(rev)
    expected = np.array(currents(*q.T, *dq.T, *ddq.T)).T
    kinetic, potential = np.array(energies(*q.T, *dq.T, *ddq.T))
    for suffix, parameters in (("_standard", theta), ("", emitted.base(theta))):
        agree(emitted(f"inverse_dynamics{suffix}", q, dq, ddq, parameters), expected)
        agree(emitted(f"forward_dynamics{suffix}", q, dq, expected, parameters), ddq)
        found = emitted(f"energy{suffix}", q, dq, parameters)
        agree(found[0][:, 0], kinetic)
        metre = G * (M1 + M2)
        agree(found[1][:, 0] - found[1][0] + metre, potential - potential[0] + metre)
