"""What is known of a cause before any record: how much descriptions usually are wrong."""

import math
from pathlib import Path

import pytest
from scipy import stats

from modelgen.description import Arm, load
from modelgen.diagnosis.candidates import Candidate
from modelgen.diagnosis.plausible import doubt

ROD = 0.42  # m, the actuator at its longest
MASS = 0.3 * 20.0
TEXT = f"""
schema: 1
convention: khalil_kleinfinger
arms:
  arm:
    joints:
    - name: a
      alpha: 1.5707963267948966
      drive: {{type: levered, l1: 0.35, l2: 0.09, length: [0.29, {ROD}], motor: [0.0, 160.0], rev: 1,
               offset: -1.4, torque_constant: 0.06}}
    - {{name: b, d: 0.5, drive: {{type: direct, ratio: 50.0, torque_constant: 0.1}}}}
    links:
      a: {{mass: 12.0, com: [0.2, 0.0, 0.0], inertia: [0.01, 0.0, 0.0, 0.1, 0.0, 0.1]}}
      b: {{mass: 8.0, com: [0.2, 0.0, 0.0], inertia: [0.01, 0.0, 0.0, 0.1, 0.0, 0.1]}}
"""
SCALES = {
    ("lever_geometry", "l2"): 0.03 * 0.09,
    ("encoder_offset", "offset"): 0.02,
    ("actuator_mass", "moment_x"): MASS * ROD / 2,
    ("actuator_mass", "inertia"): MASS * ROD**2 / 3,
    ("drive_gain_error", "error"): 0.1,
}


@pytest.fixture
def arm(tmp_path: Path) -> Arm:
    file = tmp_path / "arms.yaml"
    file.write_text(TEXT, encoding="utf-8")
    return load(file)["arm"]


@pytest.mark.parametrize(("effect", "name"), SCALES)
@pytest.mark.parametrize("size", [0.0, 0.3, 1.0, 8.0])
def test_a_value_costs_what_a_cauchy_distribution_says(effect: str, name: str, size: float, arm: Arm) -> None:
    density = stats.cauchy(scale=SCALES[effect, name]).pdf
    value = size * SCALES[effect, name]
    expected = 2 * math.log(density(0.0) / density(value))
    assert doubt(Candidate(effect, 1), {name: value}, arm) == pytest.approx(expected, abs=1e-9)
    assert doubt(Candidate(effect, 1), {name: -value}, arm) == pytest.approx(expected, abs=1e-9)


def test_forms_of_an_effect_share_what_it_is_given(arm: Arm) -> None:
    one, four = (doubt(Candidate("spring", 2, forms=n), {"stiffness": 5.0}, arm) for n in (1, 4))
    assert one == 0.0
    assert math.exp(-four / 2) == pytest.approx(1 / 4)


def test_where_there_is_no_lever_nothing_is_known_of_its_lengths(arm: Arm) -> None:
    assert doubt(Candidate("lever_geometry", 2), {"l1": 1.0}, arm) == 0.0
