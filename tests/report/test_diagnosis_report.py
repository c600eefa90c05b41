"""The report in a browser."""

import json
import multiprocessing
import os
import re
import shutil
import subprocess
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from diagnosis_support import ARM, three

from modelgen.description import DirectDrive
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.result import Diagnosis
from modelgen.figures import figure, svg
from modelgen.report.diagnosis import report
from modelgen.report.diagnosis_figures import binned, left_over, residuals
from modelgen.report.figures import Pen, Sketch

WORDS = ("stribeck_friction", "joint 2", "Error on the test record", "What these records cannot show")


@pytest.fixture(scope="module")
def found() -> Diagnosis:
    return diagnose(ARM, three("stribeck_friction", 2, 0.5))


def test_the_report_stands_alone_and_is_the_same_again(found: Diagnosis) -> None:
    page = report(found)
    assert page == report(found)
    for outside in ('src="http', 'href="http', "url(http", "@import", "<script", "<link"):
        assert outside not in page
    assert page.count("<svg") >= 5
    assert all(word in page for word in WORDS)


def test_the_arm_is_drawn_with_the_joint_that_is_named(found: Diagnosis) -> None:
    (frame,) = re.findall(r'<iframe title="the arm [^"]*" srcdoc="(.*?)"', report(found), re.DOTALL)
    (data,) = re.findall(r'id="data">(.*?)</script>', unescape(frame), re.DOTALL)
    marks = {joint["name"]: joint["mark"] for joint in json.loads(data)["joints"]}
    second = found.arm.joints[found.arm.coordinates[1]].name
    assert {name: text for name, text in marks.items() if text} == {second: "stribeck_friction"}


def test_one_value_in_the_answer_the_description_and_the_table(found: Diagnosis) -> None:
    """What is reported is what predicted the test record."""
    (cause,) = found.causes
    ((_, _, used),) = found.added
    (place,) = [n for n in found.parameters if n.startswith("FS")]
    assert used["magnitude"] == cause.parameters["magnitude"].value
    assert found.parameters[place].value == pytest.approx(cause.parameters["magnitude"].value, rel=1e-5)
    described = found.after.arm.joints[1].effects[-1].values["velocity"]
    assert described == pytest.approx(cause.parameters["velocity"].value, rel=1e-8)
    assert 0.0 < cause.parameters["velocity"].std < 0.3 * cause.parameters["velocity"].value
    assert cause.parameters["magnitude"].std > found.parameters[place].std  # the velocity is not known
    assert np.isnan(cause.parameters["exponent"].std)


@pytest.mark.parametrize("ended", [False, True])
def test_pictures_drawn_by_another_process_are_the_same(ended: bool) -> None:
    sketch = Sketch(1, 2, (4.0, 2.0))
    axes = sketch.axes()
    axes[0, 0].plot(np.arange(5.0), np.sin(np.arange(5.0)), label="sine")
    axes[0, 0].legend(loc="upper right")
    axes[0, 1].set_xlabel("time [s]")
    before = set(multiprocessing.active_children())
    with Pen(hands=2) as pen:
        for process in set(multiprocessing.active_children()) - before if ended else ():
            process.kill()
        pen.give({"sine": sketch})
        drawn = pen.fetch("sine")
    made, there = figure(1, 2, (4.0, 2.0))
    there[0, 0].plot(np.arange(5.0), np.sin(np.arange(5.0)), label="sine")
    there[0, 0].legend(loc="upper right")
    there[0, 1].set_xlabel("time [s]")
    assert drawn == svg(made)


def test_labels_stand_inside_their_picture() -> None:
    """Here the layout moves the ticks closer, and their longer labels would push the axis's out."""
    sketch = Sketch(2, 2, (9.0, 3.8))
    axes = sketch.axes()
    for j, span in enumerate([(-3.7, 2.9), (-1.5, 0.95)]):
        axes[j, 0].plot((0.0, 10.0), span)
        axes[j, 0].set_ylabel(f"joint {j + 1} [A]")
        axes[j, 1].plot((0.0, 1.0), (0.0, 0.1))
        axes[j, 1].set_ylabel("left over [A]")
    for axis in axes[1]:
        axis.set_xlabel("time [s]")
    places = re.findall(r' x="([\d.-]+)"[^>]*>joint \d', sketch.drawn())
    assert len(places) == 2
    assert min(map(float, places)) > 9.0  # the height of its letters; it stands upright


def test_every_axis_has_its_unit(found: Diagnosis) -> None:
    """Also where joints differ: a carriage before a turning joint, a motor that knows increments alone."""
    first, *others = found.arm.joints
    carriage = replace(first, type="prismatic", drive=DirectDrive(1.0, 2.0))
    mixed = replace(found, arm=replace(found.arm, joints=(carriage, *others)))
    drawn = {**residuals(mixed), "left over": left_over(mixed)}
    words = [
        call[3][0]
        for sketch in drawn.values()
        for call in sketch.calls
        if call[2] in ("set_xlabel", "set_ylabel")
    ]
    assert all(re.search(r"\[.+\]", word) for word in words)
    assert {"joint velocity [m/s], joint 1", "joint velocity [rad/s], joint 2"} <= set(words)
    rows = [call[0] for call in drawn["left over"].calls if call[2] == "set_xlabel"]
    assert {0, len(found.arm.coordinates) - 1} <= set(rows)


def test_an_error_leaves_no_process_behind() -> None:
    before = set(multiprocessing.active_children())
    with pytest.raises(ValueError, match="bad input"), Pen(hands=2):
        raise ValueError("bad input")
    assert not set(multiprocessing.active_children()) - before


def test_a_browser_shows_the_verdict(found: Diagnosis, tmp_path: Path) -> None:
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if browser is None:
        assert not os.environ.get("CI"), "the browser that CI installs is not there"
        pytest.skip("needs chromium")
    page = tmp_path / "report.html"
    page.write_text(report(found), encoding="utf-8")
    quiet = [
        browser,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={tmp_path / 'profile'}",
    ]
    picture = tmp_path / "report.png"
    taken = subprocess.run(
        [*quiet, "--window-size=1000,1400", f"--screenshot={picture}", page.as_uri()],
        capture_output=True,
        check=False,
        timeout=120,
    )
    assert picture.exists(), taken.stderr[-300:]
    assert picture.stat().st_size > 30_000  # a page with pictures, not an empty one


def test_means_over_a_short_record_are_not_few() -> None:
    """60 samples over 24 bins: hardly a bin has five of them, and there are means of five all the same."""
    x = np.random.default_rng(0).uniform(-1.0, 1.0, 60)
    places, means = binned(x, 2.0 * x)
    assert len(places) == 12
    assert (np.diff(places) > 0).all()
    np.testing.assert_allclose(means, 2.0 * places)
    long = np.linspace(0.0, 1.0, 10_000)
    assert len(binned(long, long)[0]) == 24
