"""The report in a browser."""

import json
import re
import time
from dataclasses import replace
from html import escape, unescape
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from browser_support import SCHEMES, WIDTHS, letters, on_few_sheets, on_paper, opened, violations, wider
from diagnosis_support import ARM, three

from modelgen.api.diagnosis import Diagnosis as Shown
from modelgen.api.results import Table
from modelgen.charts import chart_of, drawn, number
from modelgen.description import DirectDrive, NoDrive
from modelgen.diagnosis.adequacy.smooth_functions import Likeness, SmoothFunction
from modelgen.diagnosis.extended import Estimate
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.result import Diagnosis, to_json
from modelgen.effects import CATALOGUE
from modelgen.effects.placement import titled
from modelgen.identification.objects import Impossible
from modelgen.options import DiagnosisOptions
from modelgen.report import in_a_log
from modelgen.report.call import Call
from modelgen.report.complete import complete
from modelgen.report.diagnosis import report
from modelgen.report.diagnosis_answers import answers
from modelgen.report.diagnosis_figures import binned, efforts, replayed, residuals
from modelgen.report.diagnosis_sentences import doubted, headline, remains, worth
from modelgen.report.following import following
from modelgen.report.in_a_log import PARTS
from modelgen.report.law_figures import judged_joint, law_charts, seen
from modelgen.report.opening import hardly_moved, opening
from modelgen.report.page import Block, Folded, page
from modelgen.report.words import finding, legible, sentence
from modelgen.simulation.windows import Windows

pytestmark = pytest.mark.xdist_group("diagnosis_report")

WORDS = ("stribeck_friction", "at j2", "over all joints", "What these records cannot show")
FRICTIONS = (
    "stribeck_friction",
    "presliding",
    "nonlinear_viscous_friction",
    "load_dependent_friction",
    "torque_ripple",
)
ASKED = ("What is missing", "How sure", "What it is worth", "What to do next")


@pytest.fixture(scope="module")
def found() -> Diagnosis:
    return diagnose(ARM, three("stribeck_friction", 2, 0.5))


def test_the_report_stands_alone_and_is_the_same_again(found: Diagnosis) -> None:
    page = report(found)
    assert page == report(found)
    for outside in ('src="http', 'href="http', "url(http", "@import", "<script src", "<link"):
        assert outside not in page
    assert page.count('<svg class="chart"') >= 5
    assert all(word in page for word in WORDS)
    # what resembles it is explained without the documentation
    for other in CATALOGUE["stribeck_friction"].confused_with:
        assert escape(CATALOGUE[other].text) in page
        assert escape(CATALOGUE[other].experiment) in page


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
    assert found.parameters[place].std == cause.parameters["magnitude"].std
    (check,) = [c for c in cause.checks if c.name == "significant"]
    assert check.value == pytest.approx(found.parameters[place].value / found.parameters[place].std)
    assert np.isnan(cause.parameters["exponent"].std)


def test_every_axis_has_its_unit(found: Diagnosis) -> None:
    """Also where joints differ: a carriage before a turning joint, a motor that knows increments alone."""
    first, *others = found.arm.joints
    carriage = replace(first, type="prismatic", drive=DirectDrive(1.0, 2.0))
    mixed = replace(found, arm=replace(found.arm, joints=(carriage, *others)))
    charts = [*efforts(mixed), *(chart for over in residuals(mixed).values() for chart in over)]
    words = [label for chart in charts for label in (chart.x_label, chart.y_label)]
    assert all(re.search(r"\[.+\]", word) for word in words)
    assert [chart.x_label for chart in residuals(mixed)["speed"]] == ["speed [m/s]", "speed [rad/s]"]


@pytest.fixture(scope="module")
def written(found: Diagnosis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(report(found), encoding="utf-8")
    return path


def test_the_first_screen_answers_what_how_sure_how_much_and_what_next(written: Path) -> None:
    """In this order, all of it on a desk's screen, and on a phone's up to the command."""
    for width, last in ((1280, "dl.answer"), (400, "dl.answer pre")):
        with opened(written, width) as page:
            asked = page.locator("dl.answer dt")
            assert asked.all_inner_texts() == list(ASKED)
            box = page.locator(last).bounding_box()
            assert box is not None
            assert box["y"] + box["height"] < 900


@pytest.mark.parametrize("causes", [2, 3, 4, 10])
def test_what_to_do_next_is_on_the_first_screen_of_a_phone(
    causes: int, found: Diagnosis, tmp_path: Path
) -> None:
    """Of several causes too: what has its place on a desk's screen is folded there, and unfolds on paper and
    where the window grows.
    """
    many, path = of_seven_joints(ten(found)), tmp_path / "report.html"
    d = replace(many, causes=many.causes[-causes:], laws=many.laws[-causes:])
    asked = answers(d, Call(d.arm, folder=Path("diagnosis")))
    path.write_text(page("seven: what its model lacks", "Diagnosis", asked, []), encoding="utf-8")
    with opened(path, 400) as window:
        box = window.locator("dl.answer pre").bounding_box()
        assert box is not None
        assert box["y"] + box["height"] < 900
        folded = window.locator("dl.answer details.narrow")
        assert folded.count() == 3 + (causes > 2)
        assert not any(f.locator("p, table").first.is_visible() for f in folded.all())
        window.set_viewport_size({"width": 1280, "height": 900})
        for f in folded.all():
            f.locator("p, table").first.wait_for(state="visible")
            assert not f.locator("summary").is_visible()


def ten(found: Diagnosis) -> Diagnosis:
    """As if ten causes were named and two suspected; each cause is worth more than the one before it."""
    (cause,), (law,) = found.causes, found.laws
    checks = tuple(replace(c, passed=False) if c.name == "confirmed" else c for c in cause.checks)
    many = [
        replace(
            cause,
            effect=effect,
            joint=joint,
            parameters={p.name: Estimate(0.5, np.nan, p.unit) for p in CATALOGUE[effect].accepted()},
            share=replace(cause.share, gain=float(5 * k), low=float(k), high=float(9 * k)),
            checks=checks if k % 3 == 0 else cause.checks,
        )
        for k, (effect, joint) in enumerate(((e, j) for j in (1, 2) for e in FRICTIONS), 1)
    ]
    failed = tuple(replace(c, passed=False) if c.name == "form" else c for c in cause.checks)
    suspects = tuple(replace(cause, effect="friction_offset", joint=j, checks=failed) for j in (1, 2))
    return replace(found, causes=tuple(many), laws=(law,) * len(many), suspects=suspects)


def of_seven_joints(d: Diagnosis) -> Diagnosis:
    """As if the arm had seven joints, with the errors of the two again and again."""
    names = ("shoulder_pan", "shoulder_lift", "upper_arm_roll", "elbow", "wrist_1", "wrist_2", "wrist_3")
    joints = tuple(replace(d.arm.joints[k % 2], name=name) for k, name in enumerate(names))
    tables = {
        name: np.resize(getattr(d.errors, name), 7) for name in ("before", "after", "gain", "low", "high")
    }
    arm = replace(d.arm, joints=joints, links=(None,) * 7)
    again = [k % 2 for k in range(7)]
    gain = None if d.test.prepared.gain is None else d.test.prepared.gain[:, again]
    assert d.test.prepared.input is not None
    prepared = replace(d.test.prepared, gain=gain, input=d.test.prepared.input[:, again])
    test = replace(d.test, prepared=prepared, effort=d.test.effort[:, again], moving=d.test.moving[:, again])
    return replace(d, arm=arm, errors=replace(d.errors, **tables), test=test)


def test_ten_causes_leave_all_four_answers_on_the_first_screen(found: Diagnosis, tmp_path: Path) -> None:
    """The four of most worth stand there in full, that of most worth first, the others on demand and on
    paper; every one has its row of marks.
    """
    d, path = ten(found), tmp_path / "report.html"
    wide = of_seven_joints(d)
    asked = answers(wide, Call(wide.arm, folder=Path("diagnosis")))
    pages = report(d), page("seven: what its model lacks", "Diagnosis", asked, [])
    for of, text in zip((d, wide), pages, strict=True):
        sentences = [sentence(finding(of.arm, c.effect, c.joint, c.parameters)) for c in of.causes][::-1]
        path.write_text(text, encoding="utf-8")
        with opened(path) as window:
            window.set_viewport_size({"width": 1280, "height": 800})
            assert window.locator("dl.answer dt").all_inner_texts() == list(ASKED)
            box = window.locator("dl.answer").bounding_box()
            assert box is not None
            assert box["y"] + box["height"] <= 800
            first = window.locator("dl.answer > div").first
            shown = first.locator("dd > p")
            assert [t.split(".")[0] for t in shown.all_inner_texts()] == [s[:-1] for s in sentences[:4]]
            others = first.locator("details")
            rows = window.locator("dl.answer .checks tbody tr")
            assert [r.locator("th").inner_text() for r in rows.all()] == [
                titled(of.arm, c.effect, c.joint) for c in of.causes[::-1]
            ]
            for row, c in zip(rows.all(), of.causes[::-1], strict=True):
                signs = row.locator("td button > span:first-child")
                assert all(sign.is_visible() for sign in signs.all())
                passed = [{True: "✓", False: "✗", None: "–"}[check.passed] for check in c.checks]
                assert signs.all_inner_texts() == passed
            folded = others.locator("p")
            assert folded.count() == 6
            assert not any(p.is_visible() for p in folded.all())
            others.locator("summary").press("Enter")
            assert all(p.is_visible() for p in folded.all())
            window.reload()
            assert not folded.first.is_visible()
            window.evaluate("dispatchEvent(new Event('beforeprint'))")
            assert all(p.is_visible() for p in window.locator("dl.answer p, dl.answer ul.marks").all())
            assert window.locator("dl.answer ul.marks").count() == 2  # of the suspects
            assert violations(window) == []


@pytest.mark.parametrize("scheme", SCHEMES)
def test_marks_of_many_causes_are_rows_on_a_phone_too(scheme: str, found: Diagnosis, tmp_path: Path) -> None:
    """Below the names of the checks; all have their figures on focus."""
    d, path = ten(found), tmp_path / "report.html"
    path.write_text(report(d), encoding="utf-8")
    with opened(path, 400, scheme) as window:
        assert wider(window) == 0
        rows = window.locator("dl.answer .checks tbody tr")
        assert rows.count() == len(d.causes)
        window.get_by_text("Checks of each cause").press("Enter")
        heads = window.locator("dl.answer .checks thead th span:not(.unseen)")
        for row, c in zip(rows.all(), d.causes[::-1], strict=True):
            assert heads.all_inner_texts() == [check.name for check in c.checks]
            for head, sign in zip(heads.all(), row.locator("td button").all(), strict=True):
                above, below = head.bounding_box(), sign.bounding_box()
                assert above is not None
                assert below is not None
                assert 0 <= above["x"] <= 400 - above["width"]
                assert above["y"] + above["height"] <= below["y"] + 1
                middles = [box["x"] + 0.5 * box["width"] for box in (above, below)]
                assert abs(middles[1] - middles[0]) < 4
        cell = rows.first.locator("td").first
        assert not cell.locator(".tip").is_visible()
        for sign in window.locator("dl.answer .checks td button").all():
            finger = sign.bounding_box()
            assert finger is not None
            assert min(finger["width"], finger["height"]) >= 24
        for seen in (True, False):  # by a tap, and no more by a second one
            cell.locator("button").click()
            window.mouse.move(2, 2)
            assert cell.locator(".tip").is_visible() == seen
        cell.locator("button").focus()
        assert cell.locator(".tip").is_visible()
        box = cell.locator(".tip").bounding_box()
        assert box is not None
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 400
        assert violations(window) == []


@pytest.mark.parametrize("many", [False, True])
def test_the_page_is_printed_on_few_sheets_and_whole(many: bool, found: Diagnosis, tmp_path: Path) -> None:
    """Candidates by the dozen stay on the screen, and parameters that the values of causes explain; what is
    folded besides is unfolded.
    """
    path = tmp_path / "report.html"
    path.write_text(report(ten(found) if many else found), encoding="utf-8")
    with opened(path) as window:
        on_few_sheets(window, 7 if many else 3)
        with on_paper(window):
            for folded in window.locator("details:not(.screen)").all():
                shown = folded.locator("table, p, ul").first.is_visible()
                title = folded.locator("summary").text_content() or ""
                assert shown != title.startswith(
                    ("The candidates", "What it does to a log", *(f"Parameters of {e}" for e in CATALOGUE))
                )


def test_the_table_of_errors_needs_no_scrolling_on_a_phone(found: Diagnosis, tmp_path: Path) -> None:
    """Each interval stands below its value there, on a line, of numbers as wide as they become."""
    d, path = of_seven_joints(found), tmp_path / "report.html"
    errors = replace(d.errors, low=np.full(7, -100.4), high=np.full(7, 100.4))
    asked = answers(replace(d, errors=errors), Call(d.arm))
    path.write_text(page("seven: what its model lacks", "Diagnosis", asked, []), encoding="utf-8")
    with opened(path, 400) as window:
        window.locator("details.narrow summary").get_by_text("Error on the test record by joint").click()
        table = window.get_by_role("region", name="Error on the test record by joint")
        assert table.evaluate("t => t.scrollWidth - t.clientWidth") == 0
        for cell in table.locator("tbody td:last-child").all():
            value, interval = cell.bounding_box(), cell.locator("small").bounding_box()
            assert value is not None
            assert interval is not None
            assert interval["y"] > value["y"] + 10
            assert interval["x"] + interval["width"] <= 400
            assert interval["height"] < 25  # a line of this size


def test_what_fails_a_reported_check_is_named(found: Diagnosis) -> None:
    """Beside "passed": by name, for each check that decides nothing, and what harms the test record."""
    d = ten(found)
    names = [titled(d.arm, c.effect, c.joint) for c in d.causes]
    assert doubted(replace(d, causes=d.causes[:2])) == []
    (unconfirmed,) = doubted(d)  # every third
    assert [name in unconfirmed for name in names] == [k % 3 == 0 for k in range(1, 11)]
    checks = tuple(replace(c, passed=False) if c.name == "stable" else c for c in d.causes[1].checks)
    harm = replace(d.causes[2], share=replace(d.causes[2].share, gain=-9.0, low=-12.0, high=-6.0))
    mixed = replace(d, causes=(d.causes[0], replace(d.causes[1], checks=checks), harm))
    worse, unstable = doubted(mixed)
    assert names[2] in worse
    assert "worse" in worse
    assert names[1] in unstable
    assert "stable" in unstable
    for text in (worse, unstable):
        assert escape(text) in report(mixed)
        assert text in headline(mixed)


def test_the_files_say_when_their_records_began(found: Diagnosis) -> None:
    """1 700 000 000 s after the beginning of 1970; no column where no stamp says so."""
    assert "begins (UTC)" not in report(found)
    assert "do not say when they were made" in report(found)
    first, *others = found.log.train
    dated = replace(found.log, train=(replace(first, begins=1_700_000_000.9), *others))
    said = report(replace(found, log=dated))
    assert "begins (UTC)" in said
    assert said.count("2023-11-14T22:13:20Z") == 1


def test_every_check_says_its_figure_and_its_threshold_in_words(found: Diagnosis) -> None:
    """And why more evidence is asked than the settings say, where it is."""
    (cause,) = found.causes
    for check in cause.checks:
        said = [float(x) for x in re.findall(r"\d+(?:\.\d+)?", check.text)]
        for figure in (check.value, check.threshold):
            if np.isfinite(figure):
                near = [
                    x == pytest.approx(abs(figure) * s, rel=0.06, abs=0.06) for x in said for s in (1, 100)
                ]
                assert any(near) or "must not explain more" in check.text, check
        assert said or not np.isfinite([check.value, check.threshold]).any(), check
        assert "threshold" not in check.text
    by_name = {check.name: check for check in cause.checks}
    assert {"significant", "admissible"} <= by_name.keys()
    assert "velocity is 8" in by_name["admissible"].text
    usual = found.settings["evidence_threshold"]
    assert by_name["evidence"].threshold == usual or f"{usual:g} of others" in by_name["evidence"].text


def test_every_check_shows_its_figure_to_the_pointer_and_to_the_keyboard(
    found: Diagnosis, written: Path
) -> None:
    (cause,) = found.causes
    with opened(written) as page:
        marks = page.locator("ul.marks li")
        assert marks.count() == len(cause.checks)
        for k, check in enumerate(cause.checks):
            tip = marks.nth(k).locator(".tip")
            assert not tip.is_visible()
            marks.nth(k).locator("button").focus()
            assert tip.is_visible()
            assert check.text in tip.inner_text()
            page.evaluate("document.activeElement.blur()")
            marks.nth(k).hover()
            assert tip.is_visible()
            page.mouse.move(5, 5)


def test_the_whole_record_is_shown_and_can_be_enlarged(found: Diagnosis, written: Path) -> None:
    times = found.test.prepared.t
    with opened(written) as page:
        group = page.locator(".zooming").first
        said = group.locator("output")
        begin, end = (float(x) for x in said.inner_text().removesuffix(" s").split(" to "))
        assert end - begin == pytest.approx(times[-1] - times[0], abs=0.01)
        before = group.locator(".abscissa .tick").all_text_contents()
        group.get_by_role("button", name="Zoom in").press("Enter")
        group.get_by_role("button", name="Zoom in").press("Enter")
        low, high = (float(x) for x in said.inner_text().removesuffix(" s").split(" to "))
        assert high - low == pytest.approx((end - begin) / 4, abs=0.02)
        after = group.locator(".abscissa .tick").all_text_contents()
        assert before != after
        assert low <= float(after[0]) <= high
        box = group.locator("svg.chart").first.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        page.mouse.down()
        page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.5 * box["height"])
        page.mouse.up()
        narrower = [float(x) for x in said.inner_text().removesuffix(" s").split(" to ")]
        assert low < narrower[0] < narrower[1] < high
        group.get_by_role("button", name="Whole record").click()
        assert group.locator(".abscissa .tick").all_text_contents() == before


@pytest.mark.parametrize("causes", [1, 2, 4])
def test_no_page_scrolls_sideways(causes: int, found: Diagnosis, tmp_path: Path) -> None:
    """As it opens and all unfolded, on every phone: what is hidden from sight widens nothing either."""
    many, path = ten(found), tmp_path / "report.html"
    path.write_text(report(replace(many, causes=many.causes[-causes:], laws=many.laws[-causes:])))
    for width in (360, 400, 440, 500):
        with opened(path, width) as page:
            assert wider(page) == 0
            page.evaluate("document.querySelectorAll('details:not(.screen)').forEach(d => d.open = true)")
            assert wider(page) == 0


def test_time_counts_from_the_begin_of_the_record(found: Diagnosis) -> None:
    """Stamps since 1970 are no labels: the axes of a record that has them are those of one that has not."""
    since = 1.764e9

    def later(scores: Windows | None) -> Windows | None:
        return None if scores is None else replace(scores, t=scores.t + since)

    prepared = found.test.prepared
    stamped = replace(found.test, prepared=replace(prepared, time=prepared.time + since))
    before, after = found.simulation
    late = replace(found, test=stamped, simulation=(later(before), later(after)))
    for drawn_of in (efforts, replayed, lambda d: law_charts(d, 0)):
        for chart, same in zip(drawn_of(late), drawn_of(found), strict=True):
            for curve, other in zip(chart.curves, same.curves, strict=True):
                if chart.x_label == "time [s]":
                    np.testing.assert_allclose(curve.x, other.x, atol=1e-5)
                    assert 0.0 <= np.nanmin(curve.x) < np.nanmax(curve.x) < np.ptp(prepared.t) + 1.0


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("width", WIDTHS)
def test_the_page_can_be_read_by_everybody(written: Path, width: int, scheme: str) -> None:
    """The rules of axe-core, all unfolded; nothing stands beyond the edge; letters are legible."""
    with opened(written, width, scheme) as page:
        page.evaluate("document.querySelectorAll('details:not(.screen)').forEach(d => d.open = true)")
        assert violations(page) == []
        assert wider(page) == 0
        assert letters(page, "svg.chart text") > 10.0


def test_the_law_is_drawn_over_what_it_explains(found: Diagnosis) -> None:
    """Points scatter about the law by the residual, but for the few where its sign jumps."""
    law, left = law_charts(found, 0)
    points, curve = law.curves
    at = np.interp(points.x, curve.x, curve.y)
    j = judged_joint(found, 0)
    rms = np.sqrt(np.mean(found.residuals[1][found.test.moving[:, j], j] ** 2))
    assert np.median(np.abs(points.y - at)) < rms
    assert np.ptp(curve.y) > 2.0 * rms
    without, after = left.curves
    assert np.mean(after.y**2) < 0.5 * np.mean(without.y**2)
    assert law.x_label == "speed [rad/s]"  # a Stribeck curve is one over the speed


def test_a_sentence_says_what_the_picture_of_a_law_shows(found: Diagnosis) -> None:
    """That a constant one is a flat line, at which height and in which unit."""
    m = found.test.moving[:, 1]
    flat = with_law(found, "friction_offset", {"offset": -0.37}, np.where(m, -0.37, 0.0))
    said = seen(law_charts(flat, 0))
    assert "its line is flat, 0.37 A below zero" in said
    assert said in unescape(report(flat))
    curved = seen(law_charts(found, 0))
    assert "flat" not in curved
    assert "lie about its line" in curved
    assert curved in unescape(report(found))


def test_a_law_that_is_larger_than_the_effort_is_no_part_of_it(found: Diagnosis) -> None:
    """As where a friction that was fitted beside it takes most of it back."""
    m = found.test.moving[:, 1]
    large = with_law(found, "friction_offset", {"offset": 52.0}, np.where(m, 52.0, 0.0))
    assert "Its size on the test record is 52 A (RMS), more than the effort of j2 itself, 13 A" in report(
        large
    )
    small = with_law(found, "friction_offset", {"offset": 5.2}, np.where(m, 5.2, 0.0))
    assert "Its size on the test record: 5.2 of the 13 A of j2 (RMS)" in report(small)


def with_law(found: Diagnosis, effect: str, values: dict[str, float], law: np.ndarray) -> Diagnosis:
    """As if the second joint's cause were this one: its law, (M,), is all that the extension explains."""
    own = np.zeros_like(found.residuals[1])
    own[:, 1] = law
    parameters = {name: Estimate(value, np.nan, "1") for name, value in values.items()}
    cause = replace(found.causes[0], effect=effect, parameters=parameters)
    after = found.residuals[1]
    return replace(found, causes=(cause,), laws=(own,), residuals=(after + own, after))


def with_a_ripple(found: Diagnosis, waves: float) -> tuple[Diagnosis, float]:
    """A sine of so many waves over the way of the second joint's motor, and its harmonic."""
    p = found.test.prepared
    motor = p.picked(p.motor)[:, 1]
    harmonic = waves * 2 * np.pi / np.ptp(motor[found.test.moving[:, 1]])
    values = {"revolution": 2 * np.pi, "harmonic": harmonic}
    return with_law(found, "torque_ripple", values, np.sin(harmonic * motor)), harmonic


def test_friction_that_is_less_than_described_is_drawn_below_zero(found: Diagnosis) -> None:
    """A law of dry friction over the position that is negative everywhere: against the motion it is too."""
    p = found.test.prepared
    q, side = p.picked(p.q)[:, 1], np.sign(p.picked(p.dq)[:, 1])
    values = {"slope": 0.0, "curvature": -2.0}
    law, _ = law_charts(with_law(found, "position_dependent_friction", values, -2.0 * q**2 * side), 0)
    assert "against the motion" in law.y_label
    (curve,) = [c for c in law.curves if c.role == "law"]
    assert np.nanmin(curve.y) < 0.0
    assert np.nanmax(curve.y) < 0.1 * -np.nanmin(curve.y)


def test_friction_is_drawn_above_zero_whichever_way_its_motor_turns_the_joint(found: Diagnosis) -> None:
    p = found.test.prepared
    q, side = p.picked(p.q)[:, 1], np.sign(p.picked(p.dq)[:, 1])
    values = {"slope": 0.0, "curvature": 2.0}
    turned = replace(found.test, prepared=replace(p, motor=-p.motor, dmotor=-p.dmotor, ddmotor=-p.ddmotor))
    for test, way in ((found.test, 1.0), (turned, -1.0)):
        drawn = with_law(found, "position_dependent_friction", values, 2.0 * way * q**2 * side)
        law, _ = law_charts(replace(drawn, test=test), 0)
        assert "against the motion" in law.y_label
        (curve,) = [c for c in law.curves if c.role == "law"]
        assert np.nanmax(curve.y) > 0.0
        assert np.nanmin(curve.y) > -0.1 * np.nanmax(curve.y)


def test_friction_by_load_is_drawn_over_the_load_as_a_line() -> None:
    """Whose slope is the coefficient, from no load on; not over the position, where it has two signs."""
    records, asked = three("load_dependent_friction", 2, 0.3), [("load_dependent_friction", 2)]
    d = diagnose(ARM, records, effects=asked, experiment=False)
    (cause,) = d.causes
    law, left = law_charts(d, 0)
    assert law.x_label == left.x_label == "load by the weight of the links [A]"
    assert law.y_label == "effort against the motion [A]"
    (curve,) = [c for c in law.curves if c.role == "law"]
    coefficient = cause.parameters["coefficient"].value
    np.testing.assert_allclose(curve.y, coefficient * curve.x, rtol=0, atol=0.02 * curve.y.max())
    assert curve.x.min() < 0.05 * curve.x.max()


@pytest.mark.parametrize("waves", [20.0, 35.0, 120.0])
def test_every_wave_of_a_ripple_is_drawn(found: Diagnosis, waves: float) -> None:
    """Each that is shown, at its height; of more than can be told apart, forty."""
    rippled, harmonic = with_a_ripple(found, waves)
    chart, left = law_charts(rippled, 0)
    _, curve = chart.curves
    assert not curve.dots
    assert chart.x_label.startswith("motor position")
    shown = np.ptp(curve.x) * harmonic / (2 * np.pi)
    assert shown == pytest.approx(min(waves, 40.0), abs=2.0)
    assert np.count_nonzero(np.diff(np.sign(curve.y))) == pytest.approx(2 * shown, abs=2.0)
    assert np.quantile(curve.y, 0.9) > 0.93  # of a sine: 0.951
    np.testing.assert_allclose(curve.y, np.sin(harmonic * curve.x), atol=0.15)
    without, _ = left.curves
    assert np.sqrt(np.mean(without.y**2)) > 0.6  # of a sine: 0.707


def test_waves_that_the_samples_cannot_follow_are_drawn_as_points(found: Diagnosis) -> None:
    """With a sample or two in a wave a line from one to the next would be a wave that is not there: each
    sample is a point where the law is at its place, and so it is in the picture.
    """
    rippled, harmonic = with_a_ripple(found, 3000.0)
    chart, _ = law_charts(rippled, 0)
    _, points = chart.curves
    motor = rippled.test.prepared
    places = motor.picked(motor.motor)[rippled.test.moving[:, 1], 1]
    waves = np.ptp(points.x) * harmonic / (2 * np.pi)
    assert points.dots
    assert 5 < len(points.x) < 12 * waves
    among = (places >= points.x.min()) & (places <= points.x.max())
    np.testing.assert_array_equal(np.sort(places[among]), points.x)
    np.testing.assert_allclose(points.y, np.sin(harmonic * points.x), atol=1e-6)
    (path,) = re.findall(r'<path class="dots law"[^>]* d="([^"]*)"', drawn(chart))
    assert path.count("M") == path.count("z") == len(points.x)
    assert 'class="line law"' not in drawn(chart)


def test_a_law_that_no_coordinate_makes_a_curve_is_drawn_over_time(found: Diagnosis) -> None:
    """Impacts that come in two of the record's seconds, at no particular speed, place or load: these seconds
    are drawn, and in them the law to the last sample.
    """
    t = found.test.prepared.t - found.test.prepared.t[0]
    middle = t[-1] / 2
    struck = np.abs(t - middle) < 1.0
    law = np.where(struck, np.random.default_rng(4).choice((-1.0, 1.0), len(t)), 0.0)
    hit = with_law(found, "backlash", {"play": 0.01}, law)
    chart, left = law_charts(hit, 0)
    moving = hit.test.moving[:, 1]
    for c in (chart, left):
        assert c.x_label == "time [s]"
        assert c.curves[0].x.min() <= t[struck & moving].min()
        assert c.curves[0].x.max() >= t[struck & moving].max()
    points, line = chart.curves
    assert (points.dots, line.dots) == (True, False)
    at = np.searchsorted(t, line.x)
    np.testing.assert_array_equal(t[at], line.x)
    np.testing.assert_array_equal(line.y, np.where(moving, law, np.nan)[at])
    np.testing.assert_allclose((points.y - line.y)[moving[at]], hit.residuals[1][at, 1][moving[at]])
    without, after = left.curves
    np.testing.assert_allclose((without.y - after.y)[moving[at]], law[at][moving[at]], atol=1e-12)


def test_what_two_joints_make_together_is_a_curve_over_neither(found: Diagnosis) -> None:
    """Though over the speed of one it may nearly be one, where the other moves little."""
    p = found.test.prepared
    values = {"other": 1.0, "ratio": -1.0, "viscous": 0.3}
    coupled = with_law(found, "transmission_coupling", values, 0.3 * p.picked(p.dq)[:, 1])
    assert [chart.x_label for chart in law_charts(coupled, 0)] == ["time [s]", "time [s]"]


def test_the_page_is_small_and_drawn_in_no_time(found: Diagnosis, written: Path) -> None:
    assert written.stat().st_size < 1_500_000
    begin = time.process_time()
    report(found)
    drawing = time.process_time() - begin
    begin = time.process_time()
    diagnose(ARM, three("stribeck_friction", 2, 0.5))
    assert drawing < 0.2 * (time.process_time() - begin)


def test_a_simulated_motion_that_runs_away_leaves_the_measured_one_legible(found: Diagnosis) -> None:
    """The description's own model is made to end beyond all bounds."""
    before, after = found.simulation
    assert before is not None
    path = before.simulated.copy()
    path[0, -1] = 1e16
    away = replace(found, simulation=(replace(before, simulated=path, f_gof=-7e18 * before.f_gof), after))
    charts = replayed(away)
    for moved, error in zip(charts[::2], charts[1::2], strict=True):
        measured = moved.curves[0].y[np.isfinite(moved.curves[0].y)]
        for chart in (moved, error):
            low, high = chart.spans()[1]
            assert high - low < 3.5 * np.ptp(measured)
        low, high = moved.spans()[1]
        assert low < measured.min() < measured.max() < high
    assert "e+20" in report(away)


def test_means_over_a_short_record_are_not_few() -> None:
    """60 samples over 24 bins: hardly a bin has five of them, and there are means of five all the same."""
    x = np.random.default_rng(0).uniform(-1.0, 1.0, 60)
    places, means = binned(x, 2.0 * x)
    assert len(places) == 12
    assert (np.diff(places) > 0).all()
    np.testing.assert_allclose(means, 2.0 * places)
    long = np.linspace(0.0, 1.0, 10_000)
    assert len(binned(long, long)[0]) == 24


def other(found: Diagnosis, verdict: str) -> Diagnosis:
    """As if the records had given another verdict."""
    (cause,) = found.causes
    failed = tuple(replace(c, passed=False) if c.name == "form" else c for c in cause.checks)
    suspects = (replace(cause, checks=failed),) if verdict == "suspected" else ()
    residuals = (found.residuals[0], found.residuals[0])
    reason = "something deterministic remains at j2 that no effect of the catalogue explains"
    bare = replace(found, verdict=verdict, causes=(), laws=(), residuals=residuals, reason=reason)
    fit = found.lack_of_fit
    assert fit is not None
    worst = replace(fit.worst, statistic=9.0, joint=1)
    whole = [replace(fit.worst, kind="whole", joint=j, statistic=x) for j, x in enumerate((0.9, 9.0))]
    left = replace(fit, worst=worst, tests=whole)
    fits = {"outside_catalogue": left, "cannot_tell": None}
    return replace(bare, suspects=suspects, lack_of_fit=fits.get(verdict, fit))


@pytest.mark.parametrize("verdict", ["suspected", "nothing_missing", "outside_catalogue", "cannot_tell"])
def test_a_page_without_a_cause_answers_the_same_questions(
    verdict: str, found: Diagnosis, tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    path.write_text(report(other(found, verdict)), encoding="utf-8")
    with opened(path, 400, "dark") as page:
        assert page.locator("dl.answer dt").all_inner_texts() == list(ASKED)
        step = page.locator("dl.answer dd").last.bounding_box()
        assert step is not None
        assert step["y"] + step["height"] < 900  # on the first screen of a phone
        page.evaluate("document.querySelectorAll('details:not(.screen)').forEach(d => d.open = true)")
        assert violations(page) == []
        assert wider(page) == 0
        said = page.locator("dl.answer").inner_text()
    assert "less %" not in said
    assert "joint 2" not in said  # by its name
    assert said.count("remains at j2") == (verdict != "suspected")
    assert ("form" in said) == (verdict == "suspected")


def test_where_nothing_is_missing_the_page_says_what_was_checked(tmp_path: Path) -> None:
    """A row of marks; what repeats and is as large as it says shows, what is a third of that does not."""
    records, path = three(None, 1, 0.0), tmp_path / "report.html"
    d = diagnose(ARM, records)
    assert d.verdict == "nothing_missing"
    path.write_text(report(d), encoding="utf-8")
    with opened(path, 400) as window:
        row = window.locator("dl.answer dd").nth(1)
        names = [text.strip(" ✓\n") for text in row.locator(".marks button").all_inner_texts()]
        assert names == ["no lack of fit", "no candidate", "sensitive", "test record"]
        assert row.locator(".marks li.yes").count() == len(names)
        fits, _, sizes, unseen = row.locator(".tip").all_text_contents()
        assert violations(window) == []
    assert d.lack_of_fit is not None
    assert f"{d.lack_of_fit.statistic:.2f}, threshold {d.lack_of_fit.threshold:.2f}" in fits
    assert re.search(r"is 1(\.\d)? times the noise", unseen)
    (size,) = re.findall(r"([\d.]+) of [\d.]+ A at j1", sizes)
    wave = np.sin(2 * np.pi * 1.3 * records[0].t)[:, None] * np.array([1.0, 0.0])  # A, of any period of 10 s
    for times, shows in ((2.0, True), (0.3, False)):
        added = times * np.sqrt(2.0) * float(size) * wave
        again = [replace(r, input=r.input + added) for r in records if r.input is not None]
        fit = diagnose(ARM, again).lack_of_fit
        assert fit is not None
        (whole,) = [t for t in fit.tests if (t.kind, t.joint) == ("whole", 0)]
        assert whole.found == shows
    free = replace(d, verdict="suspected")
    assert complete(free) is None
    unknown = complete(replace(d, lack_of_fit=None))
    assert unknown is not None
    assert [look for look, _, _ in unknown.marks] == ["unasked", "yes", "unasked", "unasked"]


def test_what_is_suspected_is_no_fact_and_has_a_next_step(found: Diagnosis, tmp_path: Path) -> None:
    """With a command, on the first screen, also where four are suspected."""
    d, path = other(found, "suspected"), tmp_path / "report.html"
    suspects = tuple(replace(d.suspects[0], effect=effect) for effect in FRICTIONS[:4])
    path.write_text(report(replace(d, suspects=suspects)), encoding="utf-8")
    with opened(path, 400) as page:
        box = page.locator("dl.answer pre").bounding_box()
        said = page.locator("dl.answer").inner_text()
        assert box is not None
        assert box["y"] + box["height"] < 900
    assert "modelgen excite" in said
    assert sentence(finding(d.arm, "stribeck_friction", 2, d.suspects[0].parameters)) not in said
    assert "has evidence, and is not named: it failed form" in said


def test_a_suspect_that_explains_little_is_not_what_is_missing(found: Diagnosis) -> None:
    """What remains comes first then, and how much of it the suspect is."""
    left, d = other(found, "outside_catalogue").lack_of_fit, other(found, "suspected")
    (suspect,) = d.suspects
    assert headline(replace(d, lack_of_fit=left)).startswith("Nothing can be named; perhaps ")
    checks = tuple(replace(c, value=0.11) if c.name == "explains" else c for c in suspect.checks)
    small = headline(replace(d, lack_of_fit=left, suspects=(replace(suspect, checks=checks),)))
    assert small.startswith("Nothing can be named: something deterministic remains, most at j2")
    assert small.endswith(", and that explains 11 % of what is not noise at j2.")


def test_no_code_is_made_of_values_that_no_arm_has(found: Diagnosis) -> None:
    """Named or not: what is impossible is said first, and the nearest values that could exist come next."""
    doubt = Impossible("Impossible: the inertia at j2 comes out below zero.", ["j2"])
    call = Call(found.arm, ("a.csv",), ("b.csv",), DiagnosisOptions(), folder=Path("out"))
    for d in (found, other(found, "nothing_missing")):
        sound = [step.command for step in following(d, call)]
        assert sound[0].startswith("modelgen generate")
        broken = replace(d, impossible=(doubt,))
        steps = [step.command for step in following(broken, call)]
        assert steps[0].startswith("modelgen identify")
        assert "--consistent" in steps[0]
        assert "consistent/" in steps[1]
        assert "Physically impossible values at j2" in opening(broken)
        assert "Physically impossible values at j2" in re.sub("<[^>]+>", "", report(broken))
        assert str(doubt) in to_json(broken)["doubts"]


def test_that_a_cause_has_no_rival_is_said_and_printed(found: Diagnosis, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    (cause,) = found.causes
    for rivals in ((), (("friction_offset", 1, 3.0),)):
        path.write_text(
            report(replace(found, causes=(replace(cause, ambiguous_with=rivals),))), encoding="utf-8"
        )
        with opened(path) as page, on_paper(page):
            section = page.locator("section", has=page.get_by_role("heading", name="Rivals, and why not"))
            assert ("no other candidate explains" in section.inner_text()) == (not rivals)


def test_the_size_of_what_repeats_is_said(found: Diagnosis) -> None:
    """Of three periods an F of 9 leaves 8/3 of the noise's mean square: 8/11 of all."""
    d = other(found, "outside_catalogue")
    said = remains(d)
    moving = d.test.moving[:, 1]
    rms = np.sqrt(np.mean(d.residuals[0][moving, 1] ** 2))
    (size, unit) = re.findall(r"About ([\d.]+) of [\d.]+ (\S+) at j2 repeats", said)[0]
    assert float(size) == pytest.approx(rms * np.sqrt(8 / 11), rel=0.05)
    assert unit == "A"


def test_the_size_of_what_is_left_is_said_where_nothing_repeats(found: Diagnosis) -> None:
    """Of the joint where it is the largest share of the effort, by the log's own currents."""
    rows, moving = found.test.prepared.rows, found.test.moving
    measured = found.test.prepared.record.input
    assert measured is not None
    efforts = [np.sqrt(np.mean(found.test.prepared.effort[moving[:, j], j] ** 2)) for j in range(2)]
    raw = [np.sqrt(np.mean(measured[:, j] ** 2)) for j in range(2)]
    assert len(rows) == len(moving)
    for d in (replace(found, lack_of_fit=None), other(found, "cannot_tell")):
        left = d.errors.after if d.causes else d.errors.before
        j = int(np.argmax(left / efforts))
        ((size, whole, unit, name, share),) = re.findall(
            r"is ([\d.]+) of ([\d.]+) (\S+) \(RMS\) at (\w+), ([\d.]+) % of the effort", remains(d)
        )
        assert (unit, name) == ("A", f"j{j + 1}")
        assert float(size) == pytest.approx(left[j], rel=0.06)
        assert float(whole) == pytest.approx(raw[j], rel=0.1)
        assert float(share) == pytest.approx(100 * left[j] / efforts[j], rel=0.06)
        assert all(f"of {number(x)}" in report(d) for x in efforts)


def like(d: Diagnosis, verdict: str, *joints: int) -> Diagnosis:
    """As if what is left were most like a function at these joints (from 0)."""
    shape = SmoothFunction("a force that depends on where the arm is", dict.fromkeys(joints, ()))
    return replace(d, verdict=verdict, likeness=Likeness(shape, 50.0))


def test_the_size_of_what_is_left_is_that_of_the_joint_that_the_reason_names(found: Diagnosis) -> None:
    """Whether or not it repeats there, and whether or not more is left at another joint."""
    size_at = r"is ([\d.]+) of [\d.]+ A \(RMS\) at (\w+), [\d.]+ % of the effort(, the largest share)?"
    after, n = found.errors.after, len(found.errors.after)
    d = replace(found, lack_of_fit=None)
    said = [re.findall(size_at, remains(like(d, "named", j)))[0] for j in range(n)]
    assert [name for _, name, _ in said] == ["j1", "j2"]
    assert [float(size) for size, _, _ in said] == pytest.approx(list(after), rel=0.06)
    assert sorted(bool(largest) for _, _, largest in said) == [False, True]
    # one of all joints is of none alone
    (usual,) = re.findall(size_at, remains(d))
    assert re.findall(size_at, remains(like(d, "named", *range(n)))) == [usual]
    # where nothing but another joint's repeats
    left = other(found, "outside_catalogue")
    assert "j1" not in remains(like(left, "outside_catalogue", 1))
    both = remains(like(left, "outside_catalogue", 0))
    assert re.findall(r"A at (\w+) repeats", both) == ["j2"]
    ((size, name, _),) = re.findall(size_at, both)
    assert name == "j1"
    assert float(size) == pytest.approx(left.errors.before[0], rel=0.06)
    # where it repeats at both, that joint comes first
    assert left.lack_of_fit is not None
    tests = [replace(t, statistic=9.0) for t in left.lack_of_fit.tests]
    every = replace(left, lack_of_fit=replace(left.lack_of_fit, tests=tests))
    for j, order in enumerate((["j1", "j2"], ["j2", "j1"])):
        assert re.findall(r"A at (\w+)", remains(like(every, "outside_catalogue", j))) == order


def test_named_never_stands_beside_no_less_error(found: Diagnosis) -> None:
    none = np.zeros_like(found.errors.gain)
    same = replace(found.errors, after=found.errors.before, gain=none)
    assert "predicted no better" in worth(replace(found, errors=same))
    assert "0.0 %" not in worth(replace(found, errors=same)).partition("(")[0]
    lost = replace(
        found.errors, gain=np.array([-3.0, 0.0]), after=found.errors.before * np.array([1.03, 1.0])
    )
    assert "more error over all joints" in worth(replace(found, errors=lost))
    assert "3.0 % more at j1" in worth(replace(found, errors=lost))


def test_a_value_that_is_zero_within_its_deviation_is_printed_as_zero(found: Diagnosis) -> None:
    """In the sentence, in the table of values and on the terminal; what is small and known well is kept."""
    (cause,) = found.causes
    noise, known = Estimate(-2.1e-17, 0.11, "N"), Estimate(2.3e-9, 1e-10, "N")
    rounding, clear = Estimate(7.3e-18, np.nan, "m"), Estimate(0.0271, np.nan, "m")
    values = {"sine": noise, "cosine": known, "harmonic": rounding, "revolution": clear}
    assert {name: e.value for name, e in legible(values).items()} == {
        "sine": 0.0,
        "cosine": 2.3e-9,
        "harmonic": 0.0,
        "revolution": 0.0271,
    }
    assert legible(values)["sine"].std == 0.11
    d = replace(found, causes=(replace(cause, effect="torque_ripple", parameters=values),))
    printed = Shown(d).shown()
    (table, *_) = [part for part in printed if isinstance(part, Table)]
    for text in (report(d), *(cell for row in table.rows for cell in row)):
        assert "e-17" not in text
        assert "e-18" not in text
    assert "0.0271" in report(d)
    assert "2.3e-09" in report(d)


@pytest.mark.parametrize(("unit", "joint"), [("N m s/rad", "revolute"), ("N s/m", "prismatic")])
def test_units_of_an_effect_are_those_of_its_joint(unit: str, joint: str, found: Diagnosis) -> None:
    """Spelled: no placeholder for a coordinate or a force."""
    first, second = found.arm.joints
    moved = replace(second, type=joint, drive=NoDrive())
    cause = replace(found.causes[0], effect="viscous_friction")
    d = replace(found, arm=replace(found.arm, joints=(first, moved)), suspects=(cause,))
    (table,) = re.findall(r'aria-label="Parameters of viscous_friction">.*?</table>', report(d), re.DOTALL)
    assert f">{unit}<" in table
    units = re.findall(r'data-head="unit">([^<]*)<', report(d))
    assert not {"x", "F", "s", "x/s", "F s/x", "F/x"} & set(units) - {"s"}


@pytest.mark.parametrize("effect", CATALOGUE)
def test_every_effect_says_in_words_that_it_is_there(effect: str) -> None:
    definition = CATALOGUE[effect]
    values = {
        p.name: Estimate(2.0 if p.joint else 0.05, 0.01, p.unit.format(f="N m", x="rad", q="rad"))
        for p in definition.accepted()
    }
    joint = None if definition.scope == "arm" else 1
    said = sentence(finding(ARM, effect, joint, values))
    assert said[0].isupper()
    assert "{" not in said
    assert "_" not in effect or effect not in said
    assert joint is None or "j1" in said
    assert "j2" in said or not any(p.joint for p in definition.accepted())


def test_another_joint_is_called_by_its_name_and_by_its_number_in_json(found: Diagnosis) -> None:
    arm = replace(found.arm, joints=(replace(found.arm.joints[0], name="elbow"), found.arm.joints[1]))
    values = {
        "dry": Estimate(0.3, 0.01, "N m"),
        "other": Estimate(1.0, np.nan, "1"),
        "ratio": Estimate(-1.0, np.nan, "1"),
    }
    cause = replace(found.causes[0], effect="transmission_coupling", joint=2, parameters=values)
    d = replace(found, arm=arm, causes=(cause,))
    (_, table, *_) = Shown(d).shown()
    assert isinstance(table, Table)
    assert table.rows[0][2] == "dry 0.3000 N m, other elbow, ratio -1.000"
    text = unescape(report(d))
    assert "A part of the transmission turns with j2 and elbow." in text
    assert headline(d).startswith("The model lacks transmission_coupling at j2 and elbow: ")
    (values_of,) = re.findall(
        r'aria-label="Values of transmission_coupling at j2 and elbow">.*?</table>', text, re.DOTALL
    )
    assert re.search(r">other<.*?>elbow<", values_of)
    assert to_json(d)["causes"][0]["parameters"]["other"]["value"] == 1.0


def test_a_cause_leads_to_what_the_page_has_of_it_with_what_the_gallery_shows(
    found: Diagnosis, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By links within the page; of an effect that the gallery lacks, or without it, as far as it goes."""
    path = tmp_path / "report.html"
    path.write_text(report(found), encoding="utf-8")
    with opened(path) as page:
        page.get_by_role("link", name="More about it, and what it does to a log").click()
        assert page.url.endswith("#about-stribeck_friction")
        section = page.locator("section", has=page.get_by_role("heading", name="About stribeck_friction"))
        fold = section.locator("details", has_text="What it does to a log")
        assert not fold.locator("svg.chart").first.is_visible()
        fold.locator("summary").click()
        assert fold.locator("svg.chart").count() == len(PARTS)
        assert fold.locator("svg.chart").last.is_visible()
        said = fold.inner_text()
    for words in ("simulated arm", "on a record that the fit has not seen", "law of the cause", "59 %"):
        assert words in said
    assert 'href="file:' not in report(found)
    monkeypatch.setattr(in_a_log, "gallery", lambda: None)
    alone = report(found)
    assert "What it does to a log" not in alone
    assert 'id="about-stribeck_friction"' in alone


@pytest.mark.parametrize("effect", CATALOGUE)
def test_the_charts_of_the_gallery_are_those_of_its_files(effect: str, checkout: Path) -> None:
    """Whole, with their titles, their legends and their texts, which the page's own style draws."""
    (fold,) = in_a_log.in_a_log(effect)
    assert isinstance(fold, Folded)
    (block,) = [part for part in fold.parts if isinstance(part, Block)]
    assert len(block.charts) == len(PARTS)
    for part, (title, chart) in zip(PARTS, block.charts, strict=True):
        text = (checkout / "docs" / "gallery" / f"{effect}-{part}.svg").read_text(encoding="utf-8")
        assert title
        assert ElementTree.fromstring(chart).attrib["class"] == "chart"
        assert chart in text
        assert "<style" not in chart
        assert {label for _, label, _ in block.legend} >= {label for _, label, _ in chart_of(text)[2]} > set()


def test_a_joint_that_hardly_moves_and_what_remains_are_said_first(found: Diagnosis) -> None:
    """In the terminal and on the page: a verdict says little of a joint that rests."""
    assert not hardly_moved(found)
    resting = replace(found, log=replace(found.log, left_out=(0, round(0.91 * found.log.samples))))
    said = "Left out at rest: 91 % of the samples at j2; these records say little of what is missing there."
    assert said in opening(resting)
    assert said in report(resting)
    left = replace(
        found, reason="a cause passed every check that decides; something deterministic remains beside it"
    )
    assert "Something deterministic remains beside it." in opening(left)
    steps = [step.text for step in following(left, Call(left.arm))]
    assert steps[0].startswith("Something remains that is not named")  # how far to trust what follows
    assert not any("remains" in step.text for step in following(found, Call(found.arm)))
