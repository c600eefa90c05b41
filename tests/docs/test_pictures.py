"""Pictures that scripts of the documentation draw: of today's data, and legible by day and by night."""

from __future__ import annotations

import importlib.util
import re
import shutil
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest
from browser_support import opened

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
NAMES = sorted(path.name for path in (DOCS / "case-studies").glob("*.svg"))
CHARTS = sorted(
    path
    for folder in (DOCS, ROOT / "examples" / "diagnosis")
    for path in folder.rglob("*.svg")
    if 'class="sheet"' in path.read_text(encoding="utf-8")
)


def script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def contrast(one: str, other: str) -> float:
    """Ratio of the luminances of two colours (WCAG 2.1)."""

    def luminance(colour: str) -> float:
        parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
        r, g, b = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
        return 0.2126 * r + 0.7152 * g + 0.0722 * b

    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_the_picture_of_the_loop_is_that_of_the_example() -> None:
    assert script("loop").picture() == (DOCS / "loop.svg").read_text(encoding="utf-8")


def test_the_picture_of_the_loop_is_legible_on_any_page() -> None:
    """It lies on a ground of its own, from edge to edge, and its text stands out from that, by day and by
    night.
    """
    picture = ElementTree.fromstring((DOCS / "loop.svg").read_text(encoding="utf-8"))
    ns = "{http://www.w3.org/2000/svg}"
    ground = next(r for r in picture.iter(f"{ns}rect"))
    assert [ground.get("width"), ground.get("height")] == (picture.get("viewBox") or "").split()[2:]
    texts = list(picture.iter(f"{ns}text"))
    assert {"arm", "log", "cause", "code"} <= {t.text for t in texts}
    for text in texts:
        for paper in ("#ffffff", ground.get("fill") or ""):
            assert contrast(text.get("fill") or "", paper) > 4.5, text.text
    style = next(picture.iter(f"{ns}style")).text or ""
    night = dict(re.findall(r"\[fill='(#\w+)'\] \{ fill: (#\w+); \}", style))
    for text in texts:
        for paper in (night["#ffffff"], night[ground.get("fill") or ""]):
            assert contrast(night[text.get("fill") or ""], paper) > 4.5, text.text


def test_the_bars_of_the_ur10_are_those_of_its_table() -> None:
    assert script("case_studies").ur10() == (DOCS / "case-studies" / "ur10.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", NAMES)
def test_pictures_of_the_case_studies_have_day_and_night(name: str) -> None:
    text = (DOCS / "case-studies" / name).read_text(encoding="utf-8")
    ElementTree.fromstring(text)
    assert "prefers-color-scheme: dark" in text
    assert re.search(r'<rect class="paper" width="\d+" height="\d+"/>', text)
    assert name in (DOCS / "case-studies.md").read_text(encoding="utf-8")


def test_charts_that_are_kept_look_as_those_that_are_drawn() -> None:
    """Their style is today's, and points of before and after have forms of their own."""
    style = (ROOT / "templates" / "report" / "chart.css").read_text(encoding="utf-8")
    assert len(CHARTS) > 80
    for path in CHARTS:
        text = path.read_text(encoding="utf-8")
        assert text.split("<style>\n", 1)[1].split("</style>", 1)[0] == style, path
        for role, form in re.findall(r'<path class="dots (before|after)"[^>]* d="M[\d. -]+([^"M]*)', text):
            assert form.endswith("z") == (role == "after"), path


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_picture_that_is_wider_than_the_screen_says_so_and_one_for_light_pages_lies_on_a_card(
    scheme: str, tmp_path: Path
) -> None:
    names = ("identification.svg", "lever.svg")  # wide, without a night; narrow, with one
    folder = tmp_path / "_images"
    folder.mkdir()
    for name in names:
        shutil.copy(DOCS / name, folder)
    style = (DOCS / "style" / "pages.css").read_text(encoding="utf-8")
    pictures = "".join(f'<img alt="" src="_images/{name}">' for name in names)
    theme = "img { max-width: 100%; height: auto }"
    path = tmp_path / "page.html"
    path.write_text(
        f'<html lang="en"><title>x</title><style>{theme}{style}</style><body style="margin: 0 1rem">'
        + script("build").pictured(pictures, tmp_path),
        encoding="utf-8",
    )
    with opened(path, 400, alone=False, scheme=scheme) as page:
        seen = page.locator(".picture").evaluate_all(
            "all => all.map(b => [b.scrollWidth > b.clientWidth,"
            " getComputedStyle(b, '::before').fontSize !== '0px',"
            " getComputedStyle(b.querySelector('a')).backgroundColor === 'rgb(255, 255, 255)'])"
        )
    assert seen == [[True, True, True], [False, False, False]]


def test_a_folded_table_names_its_columns_and_a_word_of_a_command_stays_whole(tmp_path: Path) -> None:
    build = script("build")
    heads = "".join(f'<th class="head"><p>{x}</p></th>' for x in ("arm", "error [A]", "test"))
    rows = "<tr><td><p>one</p></td><td><p>0.1</p></td><td><p>--seed</p></td></tr>"
    table = build.labelled(f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>")
    assert re.findall(r'<td(?: data-label="(.*?)")?><p>(.*?)</p>', table) == [
        ("", "one"),
        ("error [A]", "0.1"),
        ("test", "--seed"),
    ]
    code = '<span class="n">a</span>-b<span class="w"> </span><span class="s">--out c-d\n  e</span>'
    worded = build.in_words(code)
    assert re.sub("<[^>]*>", "", worded) == re.sub("<[^>]*>", "", code)  # what is copied
    style = (DOCS / "style" / "pages.css").read_text(encoding="utf-8")
    path = tmp_path / "words.html"
    path.write_text(
        f'<html lang="en"><title>x</title><style>{style}</style><body><section id="case-studies">'
        f'<pre style="width: 5ch; margin: 0">{worded}</pre></section>',
        encoding="utf-8",
    )
    with opened(path, 400, alone=False) as shown:
        heights = [box.bounding_box()["height"] for box in shown.locator(".word").all()]
    assert len(heights) == 4
    assert max(heights) < 1.5 * min(heights)


@pytest.mark.parametrize("width", [1280, 1000, 800, 720, 560, 400])
def test_no_picture_of_an_effect_is_left_alone_below_two_others(width: int, tmp_path: Path) -> None:
    """The law stands above what it does to a log, in two pictures beside each other or below each other."""
    gallery = (DOCS / "gallery.md").read_text(encoding="utf-8").partition("## load_dependent_friction")[2]
    names = re.findall(r"!\[[^]]*\]\(([^)]+)\)", gallery)[:3]
    boxed = '<span class="picture"><a href="{0}"><img alt="" src="{0}"></a></span>'  # as the build has them
    pictures = "\n".join(boxed.format((DOCS / name).as_uri()) for name in names)
    style = (DOCS / "style" / "pages.css").read_text(encoding="utf-8")
    path = tmp_path / "gallery.html"
    path.write_text(
        f'<html lang="en"><title>x</title><style>{style}</style><body style="max-width: 46em">'
        f'<section id="gallery-of-effects"><p>{pictures}</p></section>',
        encoding="utf-8",
    )
    with opened(path, width, alone=False) as page:
        boxes = [image.bounding_box() for image in page.locator("img").all()]
    tops = [round(box["y"]) for box in boxes if box is not None]
    assert len(tops) == 3
    rows = [tops.count(top) for top in sorted(set(tops))]
    assert rows == ([1, 2] if width > 700 else [1, 1, 1])
