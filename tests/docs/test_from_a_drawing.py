"""The page that reads a description off a drawing: what it says of the arm is so."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from drawing_pictures import DOCS, described, picture

import modelgen as mg
from modelgen.transmission import of_joint

PAGE = (DOCS / "from-a-drawing.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def loader() -> mg.Arm:
    return described()


def test_the_gripper_is_where_the_drawing_has_it(loader: mg.Arm) -> None:
    """From the drawing's own lengths, by plane trigonometry: level, and with the boom raised and slewed."""
    *_, gripper = mg.build_model(loader).functions["forward_kinematics"](
        np.array([[0.0, 0.0, 0.0], [0.4, 0.3, 1.0]])
    )
    along, above = 1.50 + 0.20, 0.12
    for (slew, boom), pose in zip(((0.0, 0.0), (0.4, 0.3)), gripper, strict=True):
        out = 0.15 + along * math.cos(boom) - above * math.sin(boom)
        up = 0.80 + along * math.sin(boom) + above * math.cos(boom)
        np.testing.assert_allclose(pose[:3, 3], [out * math.cos(slew), out * math.sin(slew), up], atol=1e-12)
        # z along the boom
        wanted = [math.cos(boom) * math.cos(slew), math.cos(boom) * math.sin(slew), math.sin(boom)]
        np.testing.assert_allclose(pose[:3, 2], wanted, atol=1e-12)
    assert "0.15 + 1.50 + 0.20 = 1.85 m in front and 0.80 + 0.12 = 0.92 m above" in PAGE


def test_the_cylinder_is_as_long_as_from_pin_to_pin(loader: mg.Arm) -> None:
    transmission = of_joint(loader, loader.joints[1])
    low, high = transmission.joint_range() or (0.0, 0.0)
    for q in np.linspace(low, high, 7):
        upper = np.array(
            [0.50 * np.cos(q) + 0.08 * np.sin(q), 0.50 * np.sin(q) - 0.08 * np.cos(q)]
        )  # the pin turned with the boom
        length = np.linalg.norm(upper - np.array([0.10, -0.45]))
        turns = float(transmission.motor().subs(transmission.q, q))
        assert turns == pytest.approx(68 * (length - 0.47) / (0.81 - 0.47), abs=1e-9)
    said = re.search(r"stroke allows (-[0-9.]+) to ([0-9.]+) degrees", PAGE)
    assert said
    assert [f"{math.degrees(end):.1f}" for end in (low, high)] == list(said.groups())
    assert f"= {math.degrees(math.atan(0.08 / 0.50) - math.atan(0.45 / 0.10)):.1f} deg" in PAGE


def test_the_picture_is_that_of_the_description(loader: mg.Arm) -> None:
    committed = (DOCS / "from-a-drawing.svg").read_text(encoding="utf-8")
    ElementTree.fromstring(committed)
    assert picture(loader, [0.0, 0.35, 0.0], "oblique", "{inertias: false}") == committed
