"""Charts, read back from their SVG."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from modelgen.charts import (
    Band,
    Chart,
    Curve,
    Interval,
    drawn,
    in_percent,
    intervals,
    known,
    number,
    sheet,
    ticks,
)

SVG = "{http://www.w3.org/2000/svg}"
NUMBERS = re.compile(r"-?\d+")
NUMBERS_OF_A_PATH = re.compile(r"-?[\d.]+")


def chart(x: np.ndarray, y: np.ndarray, **more: object) -> Chart:
    return Chart("a joint", "time [s]", "effort [A]", [Curve(x, y, "measured", "measured")], **more)  # type: ignore[arg-type]


def points(path: str) -> list[np.ndarray]:
    """Pieces of a path of relative steps, in pixels."""
    pieces = []
    for piece in path.split("M")[1:]:
        first, _, steps = piece.partition("l")
        start = [int(v) for v in NUMBERS.findall(first)]
        moved = np.array([int(v) for v in NUMBERS.findall(steps)]).reshape(-1, 2)
        pieces.append(np.cumsum(np.vstack([start, moved]), axis=0) / 10.0)
    return pieces


def curve_of(svg: str) -> list[np.ndarray]:
    (path,) = re.findall(r'<path class="line measured" transform="scale\(\.1\)" d="([^"]*)"', svg)
    return points(path)


def frame_of(svg: str) -> tuple[float, float]:
    (wide, high) = re.findall(r'<svg x="\d+" y="\d+" width="(\d+)" height="(\d+)"', svg)[0]
    return float(wide), float(high)


def test_a_curve_is_where_its_data_are() -> None:
    t = np.linspace(0.0, 3.0, 200)
    y = np.sin(5 * t) - 0.3 * t
    svg = drawn(chart(t, y, y_range=(-2.0, 2.0)))
    (piece,) = curve_of(svg)
    wide, high = frame_of(svg)
    assert np.abs(np.interp(t / 3 * wide, piece[:, 0], piece[:, 1]) - (2.0 - y) / 4.0 * high).max() < 0.2


def test_a_line_is_broken_where_nothing_is_known() -> None:
    t = np.arange(60.0)
    y = np.where((t > 20) & (t < 30), np.nan, t)
    assert len(curve_of(drawn(chart(t, y)))) == 2


def test_no_peak_of_a_long_record_is_lost() -> None:
    """A hundred thousand samples, of which one is ten times as large as all others."""
    t = np.arange(1e5)
    y = np.sin(t / 300.0)
    y[54_321] = 10.0
    svg = drawn(chart(t, y))
    (piece,) = curve_of(svg)
    top = piece[np.argmin(piece[:, 1])]
    assert len(piece) < 3000
    assert top[1] < 0.1 * frame_of(svg)[1]
    assert abs(top[0] / frame_of(svg)[0] - 0.54321) < 0.002


@given(st.floats(-1e6, 1e6), st.floats(1e-6, 1e6))
def test_ticks_are_round_and_few(low: float, wide: float) -> None:
    wide = max(wide, 1e-4 * abs(low))
    found = ticks(low, low + wide, 5)
    assert 3 <= len(found) <= 8
    step = np.diff(found)
    assert np.allclose(step, step[0], rtol=1e-6)
    leading = f"{step[0]:.0e}"[0]
    assert leading in "125"
    assert low - 1e-6 * wide <= found[0] <= found[-1] <= low + wide * (1 + 1e-6)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0743254, "0.0743"),
        (2.0, "2.00"),
        (12345.6, "12346"),
        (3.2e-7, "3.2e-07"),
        (-0.5, "-0.500"),
        (0.0, "0"),
    ],
)
def test_numbers_have_three_digits_that_count(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize("span", [(-3.7, 2.9), (-1.5e-3, 0.95e-3), (-25_000.0, 104_000.0), (1e-9, 3e-9)])
def test_words_stand_inside_their_picture_and_outside_the_curves(span: tuple[float, float]) -> None:
    """A letter is seven pixels wide, or less."""
    t = np.linspace(0.0, 10.0, 50)
    svg = drawn(chart(t, np.linspace(*span, 50)))
    left = float(re.findall(r'<svg x="(\d+)"', svg)[0])
    for x, word in re.findall(r'<text class="tick" x="([\d.-]+)"[^>]*text-anchor="end">([^<]*)<', svg):
        assert 7.0 * len(word) <= float(x) < left


@pytest.mark.parametrize("most", [10.0, 20_000.0, 0.0002])
def test_numbers_below_a_picture_stand_inside_it(most: float) -> None:
    """The last one under an axis of positions in motor units, say; a letter is seven pixels wide, or less."""
    t = np.linspace(0.0, most, 50)
    bars = [Interval("x", most, 0.0, most)]
    for svg in (drawn(chart(t, np.sin(t))), intervals(bars, "effort [A]", "parameters")):
        wide = float(re.findall(r'viewBox="0 0 ([\d.]+)', svg)[0])
        found = re.findall(r'<text class="tick" x="([\d.]+)" text-anchor="(\w+)" y="[^"]*">([^<]*)<', svg)
        assert len(found) >= 3
        for x, anchor, word in found:
            before = {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor] * 7.0 * len(word)
            assert before <= float(x) <= wide - 7.0 * len(word) + before


def test_a_sheet_is_one_picture_with_a_legend_and_the_same_again() -> None:
    t = np.linspace(0.0, 1.0, 20)
    one = Chart(
        "one", "time [s]", "q [rad]", [Curve(t, t, "before", "as described")], bands=[Band(-1, 1, "noise")]
    )
    text = sheet([one, one, one], 2)
    assert text == sheet([one, one, one], 2)
    root = ElementTree.fromstring(text)
    words = [e.text for e in root.iter(f"{SVG}text")]
    assert words.count("as described") == 1
    assert words.count("noise") == 1
    assert words.count("one") == 3
    assert [float(v) for v in root.attrib["viewBox"].split()][2] == 2 * 440


def test_a_legend_stays_within_its_sheet() -> None:
    """On as many lines as it takes; a letter is seven pixels wide, or less. The charts lie below it."""
    t = np.linspace(0.0, 1.0, 20)
    words = ("effort without the rest of the model", "law of the cause", "as described")
    curves = [
        Curve(t, t, role, label) for role, label in zip(("measured", "law", "before"), words, strict=True)
    ]
    root = ElementTree.fromstring(sheet([Chart("one", "time [s]", "q [rad]", curves)], 1, (350, 210)))
    width, height = (float(v) for v in root.attrib["viewBox"].split()[2:])
    places = {e.text: (float(e.attrib["x"]), float(e.attrib["y"])) for e in root.iter(f"{SVG}text")}
    assert width == 350.0
    assert all(places[word][0] + 7.0 * len(word) <= width for word in words)
    lines = {places[word][1] for word in words}
    assert len(lines) == 2
    (chart,) = [e for e in root if e.tag == f"{SVG}svg"]
    assert max(lines) < places["one"][1] < float(chart.attrib["y"])
    assert float(chart.attrib["y"]) + 210.0 <= height


def test_an_interval_lies_about_its_value_and_beside_what_was_expected() -> None:
    rows = [Interval("MX1", 2.0, 1.5, 2.5, 1.0), Interval("FC1", -1.0, -1.2, -0.8)]
    svg = intervals(rows, "effort [A]", "parameters")
    spans = [[float(v) for v in m] for m in re.findall(r'class="span" d="M([\d.]+) [\d.]+H([\d.]+)"', svg)]
    at = [float(v) for v in re.findall(r'class="dot" cx="([\d.]+)"', svg)]
    rings = [float(v) for v in re.findall(r'class="ring" cx="([\d.]+)"', svg)]
    assert len(rings) == 1
    for (low, high), value in zip(spans, at, strict=True):
        assert low < value < high
        assert value == pytest.approx((low + high) / 2, abs=0.2)
    pixels_per_ampere = (spans[0][1] - spans[0][0]) / 1.0
    assert (at[0] - rings[0]) / pixels_per_ampere == pytest.approx(1.0, abs=0.02)
    assert (at[0] - at[1]) / pixels_per_ampere == pytest.approx(3.0, abs=0.02)


def test_what_is_compared_is_told_apart_without_colours() -> None:
    """Points have other outlines, in the chart as in the legend; no two lines have the same dashes."""
    x = np.array([0.0, 1.0, 2.0])
    roles = ("before", "after")
    text = sheet(
        [Chart("one", "speed [rad/s]", "r [A]", [Curve(x, x, role, role, dots=True) for role in roles])], 1
    )
    forms = {}
    for role in roles:
        drawn_ones = re.findall(rf'<path class="dots {role}"[^>]* d="([^"]*)"', text)
        assert len(drawn_ones) == 2
        legend, curve = (
            [p.partition("h" if "l" not in p else "l")[2] for p in d.split("M")[1:]] for d in drawn_ones
        )
        assert len(curve) == 3
        assert len(set(curve)) == 1
        steps = [NUMBERS_OF_A_PATH.findall(form) for form in (legend[0], curve[0])]
        assert [10.0 * float(v) for v in steps[0]] == [float(v) for v in steps[1]]
        forms[role] = curve[0]
    assert forms["before"] != forms["after"]
    style = text[: text.index("</style>")]
    dashes = {
        role: "".join(re.findall(rf"\.{role} {{[^}}]*stroke-dasharray: ([^;}}]*)", style))
        for role in ("before", "after", *(f"s{k}" for k in range(7)))
    }
    assert not dashes["before"]
    assert dashes["after"]
    lines = [dashes[f"s{k}"].strip() for k in range(7)]
    assert len(set(lines)) == 7


@pytest.mark.parametrize(
    ("value", "std", "said"),
    [
        (0.71353, 0.0072, "0.7135"),
        (2.02, 4.5e-5, "2.0200"),
        (0.00010871, 0.00016, "0.00011"),
        (0.0049, 1.2, "0.005"),
        (5684.9, 310.0, "5685"),
        (0.123456789, None, "0.12346"),
        (0.123456789, float("nan"), "0.12346"),
        (0.0, 0.1, "0"),
    ],
)
def test_a_value_is_said_to_the_second_digit_of_its_deviation(
    value: float, std: float | None, said: str
) -> None:
    assert known(value, std) == said


def test_a_share_far_above_the_whole_has_no_digits() -> None:
    assert (in_percent(30.54), in_percent(3578.8)) == ("30.5", "> 1000")
