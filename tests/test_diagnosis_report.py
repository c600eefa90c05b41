"""The report in a browser."""

import shutil
import subprocess
from pathlib import Path

import pytest
from test_diagnosis_selection import ARM, three

from modelgen.diagnosis.objects import Diagnosis
from modelgen.diagnosis.run import diagnose
from modelgen.report.diagnosis import report

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


def test_a_browser_shows_the_verdict(found: Diagnosis, tmp_path: Path) -> None:
    browser = shutil.which("chromium")
    if browser is None:
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
