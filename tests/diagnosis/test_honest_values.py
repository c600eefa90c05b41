"""What a cause's values may be off by, where records differ in it, or cannot tell it from the arm itself."""

import numpy as np
import pytest
from diagnosis_support import ARM, record, three

from modelgen.dataset import Record
from modelgen.description import loads
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.result import to_json
from modelgen.effects import CATALOGUE, Seen, known_effects

LIFT = """
schema: 1
convention: khalil_kleinfinger
arms:
  lift:
    gravity: [0, 0, -9.81]
    joints:
      - {name: mast, type: prismatic, drive: {type: direct, ratio: 400, torque_constant: 0.05},
         limits: {position: [0, 0.4]}}
"""
MASS, STIFFNESS, FREE = 2.0, 60.0, 0.05  # kg, N/m, and m at which the spring is relaxed
PRELOAD = -STIFFNESS * FREE


def _lifted(seed: int) -> Record:
    """A mass on a mast that a spring pulls to FREE, three periods of 10 s at 100 Hz, by its own equation."""
    arm, random = loads(LIFT, "lift.yaml", known_effects())["lift"], np.random.default_rng(seed)
    t = np.arange(3000) / 100.0
    w = 2 * np.pi / 10.0 * np.arange(1, 7)
    a, b = random.normal(size=(2, 6)) * 0.03 / np.arange(1, 7)
    phase = np.outer(t, w)
    q = 0.2 + np.cos(phase) @ a + np.sin(phase) @ b
    dq = -np.sin(phase) @ (a * w) + np.cos(phase) @ (b * w)
    ddq = -np.cos(phase) @ (a * w**2) - np.sin(phase) @ (b * w**2)
    force = MASS * (ddq + 9.81) + STIFFNESS * (q - FREE) + 4.0 * dq + 1.5 * np.sign(dq)
    current = (force / (400.0 * 0.05) + 0.02 * random.normal(size=len(t)))[:, None]
    place = q[:, None]
    return Record(
        f"r{seed}", t, place, 400.0 * place, current, np.ones_like(place), ("A",), motor_side=(True,), arm=arm
    )


def test_a_preload_that_weighs_like_the_mass_is_not_said_to_be_zero() -> None:
    records = [_lifted(seed) for seed in range(3)]
    assert records[0].arm is not None
    found = diagnose(records[0].arm, records, effects=(("spring", 1),), experiment=False)
    (cause,) = found.causes
    assert cause.parameters["stiffness"].value == pytest.approx(STIFFNESS, rel=0.02)
    assert not cause.parameters["preload"].separate
    assert cause.parameters["stiffness"].separate
    said = to_json(found)
    assert said["causes"][0]["parameters"]["preload"]["separate"] is False
    assert any(x["effect"] == "spring" and "preload at mast" in x["reason"] for x in said["not_identifiable"])
    # which the mass holds indeed
    mass = next(e.value for name, e in found.parameters.items() if name.startswith("M"))
    assert mass == pytest.approx(MASS + PRELOAD / 9.81, rel=0.02)


def test_what_records_differ_in_is_in_the_deviations() -> None:
    """An offset of 1.0 and of 1.3 in the records: the deviation holds both, that of equal ones is small."""
    sizes, asked = (1.0, 1.3, 1.15), (("friction_offset", 2),)
    unlike = [record("friction_offset", 2, size, k, f"r{k}") for k, size in enumerate(sizes)]
    (alike,) = diagnose(ARM, three("friction_offset", 2, 1.15), effects=asked, experiment=False).causes
    (cause,) = diagnose(ARM, unlike, effects=asked, experiment=False).suspects
    assert next(c for c in alike.checks if c.name == "stable").passed
    assert next(c for c in cause.checks if c.name == "stable").passed is False
    found, usual = cause.parameters["offset"], alike.parameters["offset"]
    assert abs(usual.value - 1.15) < 2.0 * usual.std < 0.02
    assert all(abs(found.value - size) < 2.0 * found.std < 0.5 for size in sizes)


def test_an_arm_without_drives_has_no_torque_constant() -> None:
    """It is not among what the records cannot show."""
    none = LIFT.replace("{type: direct, ratio: 400, torque_constant: 0.05}", "{type: none}")
    free = loads(none, "l", known_effects())
    driven = loads(LIFT, "l", known_effects())
    seen = Seen(False, (), (), False)
    assert CATALOGUE["drive_gain_error"].hidden(free["lift"], seen, False) == []
    assert CATALOGUE["drive_gain_error"].hidden(driven["lift"], seen, False)
