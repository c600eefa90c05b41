"""Numbers of a description that look like another unit are asked about; with their unit they are taken."""

from __future__ import annotations

import re

import pytest

from modelgen.description import loads
from modelgen.errors import InputError

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  a:
    gravity: [0, 0, -9.81]
    joints:
      - {name: j1, alpha: 0, d: 0, r: 0.3, limits: {position: [-1.5, 1.5]}}
      - {name: j2, alpha: pi/2, d: 0.2, theta: 0}
      - {name: j3, type: prismatic, d: 0, limits: {position: [0, 0.5]}}
    locked: {j2: 0.3}
"""


@pytest.mark.parametrize(
    ("right", "wrong", "line", "said"),
    [
        ("alpha: pi/2", "alpha: 90", 9, 'found 90 rad: is it in degrees? Write "90 deg"'),
        ("theta: 0", "theta: -45", 9, 'found -45 rad: is it in degrees? Write "-45 deg"'),
        ("r: 0.3", "r: 300", 8, 'found 300 m: is it in millimetres? Write "300 mm"'),
        ("d: 0.2", "d: 116.5", 9, 'found 116.5 m: is it in millimetres? Write "116.5 mm"'),
        ("[-1.5, 1.5]", "[-90, 32]", 8, 'found -90 rad: is it in degrees? Write "-90 deg"'),
        ("[0, 0.5]", "[0, 500]", 10, 'found 500 m: is it in millimetres? Write "500 mm"'),
        ("{j2: 0.3}", "{j2: 30}", 11, 'found 30 rad: is it in degrees? Write "30 deg"'),
        ("-9.81]", "-9810]", 6, "found 9810 m/s^2: is it in mm/s^2 or cm/s^2?"),
    ],
)
def test_another_unit_is_asked_about(right: str, wrong: str, line: int, said: str) -> None:
    assert right in ARM
    with pytest.raises(InputError, match=rf"arms\.yaml:{line}:\d+: .*{re.escape(said)}"):
        loads(ARM.replace(right, wrong), "arms.yaml")


@pytest.mark.parametrize(
    ("right", "other"),
    [
        ("alpha: pi/2", 'alpha: "90 deg"'),
        ("r: 0.3", "r: 300 mm"),
        ("r: 0.3", "r: 40 m"),
        ("[-1.5, 1.5]", "[-90 deg, 32 deg]"),
        ("[-1.5, 1.5]", "[-90 rad, 90 rad]"),
        ("[-1.5, 1.5]", "[-6.2832, 6.2832]"),
        ("theta: 0", "theta: -3.1416"),
    ],
)
def test_what_is_said_with_its_unit_or_is_likely_is_taken(right: str, other: str) -> None:
    assert loads(ARM.replace(right, other), "arms.yaml")["a"].notes == ()


def test_gravity_along_the_axis_that_points_up_is_asked_about() -> None:
    (note,) = loads(ARM.replace("-9.81", "9.81"), "arms.yaml")["a"].notes
    assert "does that axis point down?" in note
    assert loads(ARM.replace("[0, 0, -9.81]", "[9.81, 0, 0]"), "arms.yaml")["a"].notes == ()
