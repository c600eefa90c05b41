"""The animation: the drawing of the arm, at the motion's own coordinates."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drawing_support import evaluated, in_browser
from simulation_support import middle, shipped

from modelgen.report.animation import animation

NAMESPACE = "http://www.w3.org/2000/svg"  # of the pictures that a page can save: a name, no address


def data(text: str) -> dict[str, Any]:
    (found,) = re.findall(r'id="data">(.*?)</script>', text, re.DOTALL)
    read: dict[str, Any] = json.loads(found)
    return read


@pytest.mark.parametrize("name", ["two_fingers", "screw_axis", "gravity_arm"])
def test_thirty_pictures_a_second_of_the_motion(name: str) -> None:
    made = shipped(name)
    t = np.linspace(0.0, 2.0, 2001)
    q = middle(made) + 0.2 * np.sin(2.0 * t)[:, None]
    text = animation(made.arm, t, q)
    assert not re.search(r"""(src|href)=|https?://""", text.replace(NAMESPACE, ""))
    shown = data(text)["motion"]
    at = np.array(shown["t"])
    np.testing.assert_allclose(np.diff(at), 1 / 30, atol=1e-4)
    assert at[[0, -1]].tolist() == [0.0, 2.0]
    wanted = middle(made) + 0.2 * np.sin(2.0 * at)[:, None]
    np.testing.assert_allclose(shown["q"], wanted, atol=1e-4)


def test_a_long_motion_has_no_more_pictures_than_a_browser_bears() -> None:
    made = shipped("gravity_link1")
    text = animation(made.arm, np.linspace(0.0, 600.0, 6001), np.zeros((6001, 1)))
    assert len(data(text)["motion"]["t"]) == 1800
    assert len(text) < 300_000


def test_a_pendulum_is_where_its_angle_says(tmp_path: Path) -> None:
    """gravity_link1: x of the base points down; the tip is at twice the centre of mass."""
    made = shipped("gravity_link1")
    angle = np.linspace(-0.6, 0.6, 31)
    text = animation(made.arm, np.linspace(0.0, 1.0, 31), angle[:, None])
    tip = "place(forward(arm, q).frames[0].link, times(2, arm.joints[0].link.com))"
    times = "const times = (s, a) => a.map((x) => s * x)"
    said = f"(() => {{ {times}; return arm.motion.q.map((q) => {tip}); }})()"
    reach = 2 * 0.374094
    expected = np.stack([reach * np.cos(angle), reach * np.sin(angle), 0 * angle], axis=1)
    np.testing.assert_allclose(evaluated(text, said, tmp_path), expected, atol=1e-5)


PLAYED = """
<script>
const bar = document.querySelector("#player input");
bar.value = 15;
bar.dispatchEvent(new Event("input"));
paint();
const out = document.createElement("pre");
const time = document.querySelector("#player .time").textContent;
out.textContent = `${time}, q ${state.q[0]}, ${trace.length} points`;
document.body.append(out);
</script>
"""


def test_a_browser_plays_it(tmp_path: Path) -> None:
    made = shipped("gravity_link1")
    text = animation(made.arm, np.linspace(0.0, 1.0, 31), np.linspace(0.0, 3.0, 31)[:, None])
    shown = in_browser(text.replace("</body>", PLAYED + "</body>"), tmp_path)
    assert "<pre>0.50 s, q 1.5, 31 points</pre>" in shown
