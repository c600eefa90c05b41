"""Motion over time: what the whole mechanism's energy does."""

import functools
import math

import numpy as np
from scipy.integrate import solve_ivp
from witness.arms import Emitted, build
from witness.bodies import Body
from witness.levers import Drive

from modelgen.description import Arm, EffectUse, Joint, LeveredDrive
from modelgen.functions import Options

SECONDS = 3.0
STANDARD = {"IA1": 2e-8, "IA2": 1.5e-8, "KS2": 2.0, "KO2": 0.7, "FV1": 6e-8, "FV2": 4e-8, "FC1": 1e-4}
BODIES = (
    Body(6.0, np.array([0.2, 0.02, 0.03]), np.diag([0.02, 0.15, 0.14])),
    Body(3.0, np.array([0.15, -0.03, 0.02]), np.diag([0.01, 0.06, 0.07])),
)


def lever(rev: int, middle: float) -> LeveredDrive:
    """A lever whose joint works 60 degrees to either side of `middle`."""
    l1, l2 = 0.3, 0.08
    ends = [math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(math.radians(a))) for a in (30, 150)]
    offset = middle - rev * math.radians(90)
    return LeveredDrive(l1, l2, (ends[0], ends[1]), (0.0, 20000.0), rev, offset, 4e-3)


@functools.cache
def hanging() -> Emitted:
    """Two levered links that hang at q = 0, with drive inertia, frictions and a spring."""
    smooth = EffectUse("coulomb_friction", {"smoothing": 200.0})
    both = (EffectUse("drive_inertia"), EffectUse("viscous_friction"))
    joints = (
        Joint("j1", "revolute", alpha=0.3, drive=lever(1, 0.0), effects=(*both, smooth)),
        Joint(
            "j2",
            "revolute",
            alpha=0.4,
            d=0.45,
            antecedent=0,
            drive=lever(-1, 0.1),
            effects=(*both, EffectUse("spring")),
        ),
    )
    return build(Arm("hanging", joints, (None, None), (9.81, 0.0, 0.0)), Options())


def parameters(*left_out: str) -> np.ndarray:
    """Base parameters; effects named in `left_out` at zero."""
    emitted = hanging()
    values = {k: v for k, v in STANDARD.items() if k not in left_out}
    for i, body in enumerate(BODIES):
        values |= {f"{s}{i + 1}": v for s, v in zip(
            ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"), body.ten, strict=True
        )}  # fmt: skip
    return emitted.base(np.array([values.get(p.name, 0.0) for p in emitted.model.standard]))


def current(t: float) -> np.ndarray:
    return np.array([0.03 * math.sin(5 * t), -0.02 * math.cos(7 * t)])


def motion(theta: np.ndarray, driven: bool) -> tuple[np.ndarray, np.ndarray]:
    """Energies at 40 instants, and the work done by the currents until then, by DOP853."""
    emitted = hanging()

    def derivative(t: float, x: np.ndarray) -> np.ndarray:
        given = current(t) if driven else np.zeros(2)
        ddq = emitted("forward_dynamics", x[:2], x[2:4], given, theta)
        power = (emitted("drive_gain", x[:2]) * given) @ x[2:4]
        return np.array([*x[2:4], *ddq, power])

    start = np.array([0.5, -0.45, 0.0, 0.0, 0.0])
    instants = np.linspace(0, SECONDS, 40)
    found = solve_ivp(derivative, (0, SECONDS), start, "DOP853", instants, rtol=1e-12, atol=1e-13)
    assert found.success
    q, dq = found.y[:2].T, found.y[2:4].T
    for k in (0, 1):  # inside the strokes, and in motion
        low, high = Drive(emitted.arm, k).span() or (0.0, 0.0)
        assert low < q[:, k].min() < q[:, k].max() < high
        assert np.ptp(q[:, k]) > 0.1
    kinetic, potential = emitted("energy", q, dq, theta)
    return np.hstack([kinetic, potential]), found.y[4]


def test_without_friction_and_current_energy_stays() -> None:
    energy, _ = motion(parameters("FV1", "FV2", "FC1"), driven=False)
    exchanged = np.ptp(energy[:, 0])
    assert exchanged > 1.0  # J: kinetic and potential energy do change
    assert np.ptp(energy.sum(axis=1)) <= 1e-8 * exchanged


def test_without_friction_energy_grows_by_the_work_of_the_currents() -> None:
    energy, work = motion(parameters("FV1", "FV2", "FC1"), driven=True)
    total = energy.sum(axis=1)
    assert np.ptp(work) > 0.1
    assert np.abs(total - total[0] - work).max() <= 1e-8 * np.ptp(energy[:, 0])


def test_with_friction_energy_only_falls() -> None:
    energy, _ = motion(parameters(), driven=False)
    total = energy.sum(axis=1)
    assert (np.diff(total) < 0).all()
    assert total[0] - total[-1] > 0.1
