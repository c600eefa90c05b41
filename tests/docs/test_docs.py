"""The documentation builds without a warning, and has every page and every public name."""

import re
import subprocess
import sys
from html import unescape
from itertools import product
from pathlib import Path

import pytest
from browser_support import SCHEMES, WIDTHS, opened, violations, wider

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.xdist_group("site")

ABOVE = 40  # pixels above a heading that a link leads to


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("site")
    call = [sys.executable, str(ROOT / "docs" / "build.py"), "--out", str(out)]
    done = subprocess.run(call, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr
    return out


def test_every_page_is_there_and_is_reached_from_the_first(site: Path) -> None:
    first = (site / "index.html").read_text(encoding="utf-8")
    pages = [p.relative_to(ROOT / "docs").with_suffix(".html") for p in (ROOT / "docs").rglob("*.md")]
    assert len(pages) > 15
    for page in pages:
        assert (site / page).is_file()
        assert page.name == "index.html" or f'href="{page.as_posix()}"' in first


def test_the_reference_has_docstrings_and_the_help(site: Path) -> None:
    simulation = (site / "reference" / "simulation.html").read_text(encoding="utf-8")
    assert 'id="modelgen.simulation.simulate"' in simulation
    assert "dry friction as a set" in simulation
    commands = (site / "reference" / "command_line.html").read_text(encoding="utf-8")
    for name in ("generate", "identify", "diagnose", "simulate"):
        assert f'id="{name}"' in commands
    assert "--train" in commands
    assert "FILE@t0:t1" in unescape(re.sub("<[^>]+>", "", commands))
    assert not [page for page in site.rglob("*.html") if "mailto:" in page.read_text(encoding="utf-8")]


def test_every_page_has_one_heading_of_its_own(site: Path) -> None:
    """That of the search and of the index too, which the theme makes."""
    pages = list(site.rglob("*.html"))
    assert site / "search.html" in pages
    for page in pages:
        assert page.read_text(encoding="utf-8").count("<h1") == 1, page


def test_nothing_comes_from_the_network(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert 'src="http' not in text, page
        assert 'rel="stylesheet" href="http' not in text, page


# These take longer by the rules than all other pages together. The reference is made from docstrings, in one
# form, so two of its pages speak for it; of the longest tables those of other pages do.
LONGEST = ("benchmarks", "sizes", "genindex")
SPEAKING = ("command_line", "simulation")


@pytest.mark.parametrize("part", range(4))
def test_pages_hold_to_the_rules_of_accessibility_at_any_width(site: Path, part: int) -> None:
    """A quarter of the pages at each width in each scheme; none is wider than its window."""
    width, scheme = list(product(WIDTHS, SCHEMES))[part]
    pages = sorted(site.rglob("*.html"))
    alike = {p for p in pages if p.parent.name == "reference" and p.stem not in SPEAKING}
    held = [p for p in pages if p not in alike and p.stem not in LONGEST]
    assert len(held) > 40
    with opened(pages[part], width, scheme, alone=False) as page:
        for path in [*held[part::4], *[p for p in pages if p not in held][part::4]]:
            page.goto(path.as_uri())
            assert path not in held or not violations(page), path
            assert wider(page) == 0, path


@pytest.mark.parametrize("name", ["architecture", "benchmarks", "gallery"])
def test_pictures_are_legible_on_a_narrow_screen(site: Path, name: str) -> None:
    """Three quarters of their own width or more, in a box that keys reach and move, and in full by a link."""
    with opened(site / f"{name}.html", 400, alone=False) as page:
        shown = page.locator("article img").evaluate_all(
            "all => all.map(e => [e.getBoundingClientRect().width / e.naturalWidth, e.src, e.alt,"
            " e.closest('.picture > a')?.href])"
        )
        assert len(shown) >= 2
        for scale, source, words, link in shown:
            assert scale >= 0.74, source
            assert link == source
            assert words
        assert wider(page) == 0
        if name != "gallery":
            page.locator(".picture > a").first.focus()
            page.keyboard.press("ArrowRight")
            page.wait_for_function("document.querySelector('.picture').scrollLeft > 0", timeout=5000)


def test_options_are_explained_under_their_names_on_a_narrow_screen(site: Path) -> None:
    with opened(site / "reference/command_line.html", 400, alone=False) as page:
        rows = page.locator(".options > dl > dt").evaluate_all(
            "all => all.map(e => [e.innerText, e.getBoundingClientRect().bottom,"
            " e.nextElementSibling.innerText, e.nextElementSibling.getBoundingClientRect().toJSON(),"
            " e.nextElementSibling.scrollWidth - e.nextElementSibling.clientWidth])"
        )
        names = " ".join(row[0] for row in rows)
        assert all(name in names for name in ("--train", "--rate HZ", "--no-derivatives", "ARMS <path>"))
        for name, bottom, said, box, beyond in rows:
            assert said.strip(), name
            assert box["top"] >= bottom, name
            assert 0 < box["left"] < box["right"] <= 400, name
            assert beyond == 0, name


def test_every_case_study_is_one_screen(site: Path) -> None:
    """From its question to its command, on a screen of 1280 by 800, below where a link leads to."""
    with opened(site / "case-studies.html", alone=False) as page:
        studies = page.locator("#case-studies > section")
        assert studies.count() == 6
        for k in range(6):
            study = studies.nth(k)
            box = study.bounding_box()
            assert box is not None
            assert box["height"] <= 800 - ABOVE, study.locator("h2").inner_text()
            words = study.inner_text()
            places = [words.index(word) for word in ("Question.", "Log.", "Answer.", "modelgen diagnose")]
            assert places == sorted(places)
            assert study.locator("img").count() == 1
            commands = study.locator("pre")
            assert commands.evaluate("e => e.scrollWidth - e.clientWidth") == 0
