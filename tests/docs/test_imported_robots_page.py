"""The page of imported robots has the figures of today, of those at hand."""

from __future__ import annotations

from pathlib import Path

import pytest
import robots

PAGE = (Path(__file__).parents[2] / "docs" / "imported-robots.md").read_text(encoding="utf-8")
SOME = ("asr_twodof/TwoDofs", "finger_edu/finger_edu", "ur/ur3")


def test_models_of_mjcf_have_the_figures_of_the_page() -> None:
    rows = list(robots.mjcf_rows())
    assert len(rows) >= 10
    for row in rows:
        assert row.off <= robots.WORST
        assert f"{robots.line(row)}\n" in PAGE


@pytest.mark.skipif(not robots.INSTALLED.is_dir(), reason="example-robot-data is not installed")
def test_robots_have_the_figures_of_the_page() -> None:
    for path in robots.INSTALLED.rglob("*.urdf"):
        name = robots.label(robots.INSTALLED, path)
        if name in SOME:
            row = robots.urdf_row(robots.INSTALLED, path)
            assert (robots.line(row) if row.figures else f"| {name} | {row.reason} |") in PAGE
