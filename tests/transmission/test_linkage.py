"""Drives of varying ratio against the points of the mechanism, which scipy puts together."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from c_support import run, shared_library, write
from scipy.optimize import brentq
from witness.arms import Emitted, build
from witness.compare import agree

from modelgen.backends import Provenance, c_files
from modelgen.description import Arm, DirectDrive, EffectUse, Joint, LeveredDrive, NoDrive, loads
from modelgen.errors import InputError
from modelgen.functions import STATUS_STROKE, Options
from modelgen.transmission import DEAD_CENTRE, KINDS, SliderCrank, curves, of_joint

TORQUE_CONSTANT = 0.05
FIGURES = {
    "slider_crank": {"lever": 0.06, "rod": 0.3, "height": -0.02, "lead": 0.005, "offset": 0.4},
}
TOLD_ELSEWHERE = (NoDrive, DirectDrive, LeveredDrive)  # test_lever.py
each = pytest.mark.parametrize("name", [n for n, kind in KINDS.items() if kind not in TOLD_ELSEWHERE])


def slider_crank(q: float) -> tuple[float, float]:
    """Motor coordinate and dq_m/dq: the rod's pins are put together, then their speeds along it are equal."""
    f = FIGURES["slider_crank"]
    a = q - f["offset"]
    pin = np.array([f["lever"] * math.cos(a), f["lever"] * math.sin(a)])

    def gap(x: float) -> float:
        return float(np.hypot(x - pin[0], f["height"] - pin[1])) - f["rod"]

    x = brentq(gap, pin[0], 1.0, xtol=1e-15)
    along = np.array([x, f["height"]]) - pin
    turning = np.array([-pin[1], pin[0]])
    per_metre = 2 * math.pi / f["lead"]
    return per_metre * x, per_metre * float(turning @ along) / along[0]


WITNESSES: dict[str, Callable[[float], tuple[float, float]]] = {
    "slider_crank": slider_crank,
}


def arm_with(name: str, **figures: float) -> Arm:
    kind: Any = KINDS[name]
    drive = kind(**{**FIGURES[name], **figures}, torque_constant=TORQUE_CONSTANT)
    effects = (EffectUse("viscous_friction"), EffectUse("drive_inertia"))
    joint = Joint("j1", kind.joint_type or "revolute", drive=drive, effects=effects)
    return Arm("one", (joint,), (None,), (3.0, 9.0, 1.0))


def built(name: str) -> tuple[Emitted, np.ndarray]:
    """The functions, and 40 coordinates within the reach."""
    arm = arm_with(name)
    low, high = of_joint(arm, arm.joints[0]).joint_range() or (0.0, 0.0)
    return build(arm, Options()), np.linspace(low, high, 40)[:, None]


@each
def test_motor_coordinate_and_gain_are_those_of_the_mechanism(name: str) -> None:
    emitted, q = built(name)
    rng = np.random.default_rng(1)
    dq, ddq = rng.uniform(-2, 2, q.shape), rng.uniform(-5, 5, q.shape)
    found = emitted("motor_from_joint", q, dq, ddq)
    true = np.array([WITNESSES[name](x) for x in q[:, 0]])
    agree(found[0], true[:, :1], 1e-12)
    agree(found[1], true[:, 1:] * dq, 1e-11)
    h = 1e-5
    inner = slice(1, -1)
    ends = [(WITNESSES[name](x - h)[1], WITNESSES[name](x + h)[1]) for x in q[inner, 0]]
    change = np.diff(ends, axis=1)[:, 0] / (2 * h)
    agree(found[2][inner], true[inner, 1:] * ddq[inner] + change[:, None] * dq[inner] ** 2, 1e-7)
    agree(emitted("drive_gain", q), TORQUE_CONSTANT * true[:, 1:], 1e-11)


@each
def test_there_and_back_over_the_whole_reach(name: str) -> None:
    emitted, q = built(name)
    dq, ddq = np.ones_like(q), -np.ones_like(q)
    back = emitted("joint_from_motor", *emitted("motor_from_joint", q, dq, ddq))
    for there, here in zip((q, dq, ddq), back, strict=True):
        agree(here, there, 1e-9)


@each
def test_the_input_does_the_work_of_joint_and_drive(name: str) -> None:
    """Power in: the link's gain of energy, the drive's, and what friction takes."""
    emitted, q = built(name)
    dq, ddq = 0 * q + 0.7, 0 * q - 0.4
    names = [p.name for p in emitted.model.standard]
    theta = np.zeros(len(names))
    theta[names.index("ZZ1")], theta[names.index("IA1")], theta[names.index("FV1")] = 0.3, 2e-4, 1e-3
    current = emitted("inverse_dynamics_standard", q, dq, ddq, theta)
    _, speed, acceleration = emitted("motor_from_joint", q, dq, ddq)
    power = 0.3 * ddq * dq + 2e-4 * acceleration * speed + 1e-3 * speed**2
    agree(TORQUE_CONSTANT * speed * current, power, 1e-11)
    agree(emitted("forward_dynamics_standard", q, dq, current, theta), ddq, 1e-9)


@each
def test_the_drive_moves_on_with_the_zero_of_its_joint(name: str) -> None:
    """By an encoder that reads 0.03 less, the same positions have other coordinates."""
    arm = arm_with(name)
    (joint,) = arm.joints
    moved = replace(arm, joints=(replace(joint, drive=joint.drive.shifted(0.03)),))
    here, there = (curves(of_joint(a, a.joints[0])) for a in (arm, moved))
    q = np.linspace(*(of_joint(arm, joint).joint_range() or (0.0, 0.0)), 9)
    agree(there.k1(q - 0.03), here.k1(q), 1e-9)
    change = there.motor(q - 0.03) - here.motor(q)
    agree(change, 0 * change + change[0], 1e-9)


@each
def test_the_reach_ends_at_the_dead_centres(name: str) -> None:
    arm = arm_with(name)
    low, high = of_joint(arm, arm.joints[0]).joint_range() or (0.0, 0.0)
    inside = [WITNESSES[name](x)[1] for x in np.linspace(low, high, 200)]
    assert len(set(np.sign(inside))) == 1
    for beyond in (low - DEAD_CENTRE * 1.01, high + DEAD_CENTRE * 1.01):
        try:
            slope = WITNESSES[name](beyond)[1]
        except ValueError:  # no root: the parts do not meet
            continue
        assert np.sign(slope) == -np.sign(inside[0])


@each
def test_the_c_code_reports_a_coordinate_out_of_reach(name: str, tmp_path: Path) -> None:
    emitted, q = built(name)
    write(c_files(emitted.model, Provenance("0", "0")), tmp_path)
    source = (
        '#include <stdio.h>\n#include "one.h"\nint main(void) {\n'
        f"  const double q[] = {{{q[20, 0]:.17g}, {q[-1, 0] + 0.01:.17g}}};\n"
        "  for (int k = 0; k < 2; ++k) {\n    one_real_t gain[1];\n"
        '    const int status = one_drive_gain(&q[k], gain);\n    printf("%d %.17g\\n", status, gain[0]);\n'
        "  }\n  return 0;\n}\n"
    )
    (tmp_path / "main.c").write_text(source, encoding="utf-8")
    library = shared_library(tmp_path, "one", "double")
    include = ["-I", str(tmp_path / "include")]
    run(["cc", *include, str(tmp_path / "main.c"), str(library), "-o", str(tmp_path / "main"), "-lm"])
    lines = [line.split() for line in run([str(tmp_path / "main")]).splitlines()]
    assert int(lines[0][0]) == 0
    assert float(lines[0][1]) == pytest.approx(TORQUE_CONSTANT * WITNESSES[name](q[20, 0])[1], rel=1e-12)
    assert [int(lines[1][0]), float(lines[1][1])] == [STATUS_STROKE, 0.0]


TEXT = """
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    symbols: {{crank: 0.06}}
    joints:
      - name: j1
        type: {joint}
        {limits}
        drive:
          type: slider_crank
          lever: crank
          rod: {rod}
          height: 0
          lead: 5 mm
          offset: 0
          torque_constant: 0.05
"""


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rod": "0.05"}, r"the rod is 0.05 m, expected longer than lever \+ \|height\| = 0.06 m"),
        ({"rod": "30 deg"}, r"found '30 deg', expected a length"),
        ({"joint": "prismatic"}, "found a drive slider_crank on a prismatic joint, expected a revolute one"),
        ({"limits": "limits: {position: [-20 deg, 90 deg]}"}, "allows 5 deg to 175 deg"),
    ],
)
def test_a_linkage_that_cannot_be_is_refused(change: dict[str, str], message: str) -> None:
    given = {"joint": "revolute", "limits": "", "rod": "0.3", **change}
    with pytest.raises(InputError, match=message):
        loads(TEXT.format(**given), "arms.yaml")


def test_its_figures_may_be_symbols_and_its_range_is_the_joint_s() -> None:
    arm = loads(TEXT.format(joint="revolute", limits="", rod="0.3"), "arms.yaml")["one"]
    assert isinstance(arm.joints[0].drive, SliderCrank)
    assert arm.joints[0].limits.position == pytest.approx((math.radians(5), math.radians(175)))
    symbolic = build(arm, Options(runtime_geometry=True))
    plain = build(arm, Options())
    q = np.array([[1.0]])
    agree(symbolic("drive_gain", q, [[0.06]]), plain("drive_gain", q), 1e-12)
