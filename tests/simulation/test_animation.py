"""The animation: a tree, a prismatic axis, an arm that hangs."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from simulation_support import middle, shipped

from modelgen.report.animation import animation


@pytest.mark.parametrize("name", ["two_fingers", "screw_axis", "gravity_arm"])
def test_every_frame_is_finite_and_nothing_is_fetched(name: str) -> None:
    made = shipped(name)
    t = np.linspace(0.0, 2.0, 61)
    q = middle(made) + 0.2 * np.sin(2.0 * t)[:, None]
    text = animation(made, t, q)
    assert not re.search(r"""(src|href)=|https?://""", text)
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    assert found
    data = json.loads(found[1])
    points = np.array(data["points"])
    assert points.shape == (61, 1 + 2 * len(made.arm.joints), 3)
    assert np.isfinite(points).all()
    # rigid: a line from a joint to its own tip keeps its length
    for a, b in data["lines"]:
        if b == a + 1 and a:
            length = np.linalg.norm(points[:, b] - points[:, a], axis=1)
            np.testing.assert_allclose(length, length[0], atol=1e-3 * np.abs(points).max())


def test_pendulum_is_where_its_angle_says() -> None:
    """gravity_link1: x of the base points down; the tip is at twice the centre of mass."""
    made = shipped("gravity_link1")
    t = np.linspace(0.0, 1.0, 31)
    text = animation(made, t, np.linspace(-0.6, 0.6, 31)[:, None])
    points = np.array(json.loads(text.split('id="data">')[1].split("</script>")[0])["points"])
    angle = np.linspace(-0.6, 0.6, 31)
    reach = 2 * 0.374094
    expected = np.stack([reach * np.cos(angle), reach * np.sin(angle), 0 * angle], axis=1)
    np.testing.assert_allclose(points[:, 2], expected, atol=1e-3)
