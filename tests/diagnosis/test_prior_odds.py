"""What is known of a cause before any record: how much descriptions usually are wrong."""

import math

import pytest
from scipy import stats

from modelgen.description import Arm, DirectDrive, Inertial, Joint, LeveredDrive
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.prior_odds import beyond_plausible, place_penalty, prior_penalty

ROD = 0.42  # m, the actuator at its longest
MASS = 0.3 * 20.0
ARM = Arm(
    "two",
    (
        Joint("a", "revolute", drive=LeveredDrive(0.35, 0.09, (0.29, ROD), (0.0, 160.0), 1, -1.4, 0.06)),
        Joint("b", "revolute", d=0.5, antecedent=0, drive=DirectDrive(50.0, 0.1)),
    ),
    tuple(Inertial(mass, (0.2, 0.0, 0.0), (0.01, 0.0, 0.0, 0.1, 0.0, 0.1)) for mass in (12.0, 8.0)),
)
SCALES = {
    ("lever_geometry", "l2"): 0.03 * 0.09,
    ("encoder_offset", "offset"): 0.02,
    ("actuator_mass", "moment_x"): MASS * ROD / 2,
    ("actuator_mass", "inertia"): MASS * ROD**2 / 3,
    ("drive_gain_error", "error"): 0.1,
}


@pytest.mark.parametrize(("effect", "name"), SCALES)
@pytest.mark.parametrize("size", [0.0, 0.3, 1.0, 8.0])
def test_a_value_costs_what_a_cauchy_distribution_says(effect: str, name: str, size: float) -> None:
    density = stats.cauchy(scale=SCALES[effect, name]).pdf
    value = size * SCALES[effect, name]
    expected = 2 * math.log(density(0.0) / density(value))
    assert prior_penalty(Candidate(effect, 1), {name: value}, ARM) == pytest.approx(expected, abs=1e-9)
    assert prior_penalty(Candidate(effect, 1), {name: -value}, ARM) == pytest.approx(expected, abs=1e-9)


def test_forms_of_an_effect_share_what_it_is_given() -> None:
    one, four = (prior_penalty(Candidate("spring", 2, forms=n), {"stiffness": 5.0}, ARM) for n in (1, 4))
    assert one == 0.0
    assert math.exp(-four / 2) == pytest.approx(1 / 4)


def test_places_of_an_effect_share_its_odds_and_not_its_evidence() -> None:
    """A spring somewhere is as likely as a tilted base; whether anything is there is not asked of places."""
    one, four = (Candidate("spring", 2, places=n) for n in (1, 4))
    assert place_penalty(one) == 0.0
    assert math.exp(-place_penalty(four) / 2) == pytest.approx(1 / 4)
    assert prior_penalty(four, {"stiffness": 5.0}, ARM) == 0.0


def test_where_there_is_no_lever_nothing_is_known_of_its_lengths() -> None:
    assert prior_penalty(Candidate("lever_geometry", 2), {"l1": 1.0}, ARM) == 0.0


@pytest.mark.parametrize(
    ("effect", "name", "value", "seen"),
    [
        ("base_tilt", "y", -1.4, True),
        ("base_tilt", "y", 0.2, False),
        ("lever_geometry", "l1", 0.09, True),
        ("lever_geometry", "l1", 0.05, False),
        ("lever_geometry", "l2", 0.024, False),  # pivots lie inside
        ("lever_geometry", "l2", 0.04, True),
        ("encoder_offset", "offset", 1.57, False),
        ("actuator_mass", "moment_x", 90.0 * ROD / 2, True),
        ("actuator_mass", "moment_x", 20.0 * ROD / 2, False),
    ],
)
def test_what_nobody_overlooks(effect: str, name: str, value: float, seen: bool) -> None:
    """A tilt of 80 degrees, a quarter of a length, 90 kg on an arm of 20, no quarter turn of an encoder."""
    assert beyond_plausible(Candidate(effect, 1), {name: value}, ARM) is seen
