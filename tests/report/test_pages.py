"""The pages of identify, refine, calibrate, excite and fleet, in a browser."""

import re
from collections.abc import Mapping
from dataclasses import replace
from html import unescape
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from browser_support import (
    SCHEMES,
    WIDTHS,
    letters,
    on_few_sheets,
    on_paper,
    opened,
    printed,
    violations,
    wider,
)
from diagnosis_support import ARM, three
from matplotlib.image import imread
from playwright.sync_api import Locator

import modelgen as mg
from modelgen.api.identification import Identification
from modelgen.api.refinement import Refinement
from modelgen.api.results import Table
from modelgen.calibration.lever import lever_of
from modelgen.fleet.overview import overview
from modelgen.report.page import Command, Grid
from modelgen.report.page import page as paged
from modelgen.report.parts import html
from modelgen.report.refinement import motion

pytestmark = pytest.mark.xdist_group("pages")

QUESTIONS = {
    "identify": "What was found, How well it predicts, What is uncertain, What to do next",
    "refine": "What was found, How well it moves, What moved, What to do next",
    "calibrate": "What was found, Described and calibrated, What is uncertain, What to do next",
    "excite": "What was found, What it determines worst, What it asks of the arm, What to do next",
    "fleet": "What was found, What is missing, How sure, What it is worth, What to look at next",
}
ROW = {
    "arm": "digger",
    "reason": "a cause passed every check",
    "causes": ["load_dependent_friction"],
    "joints": [2],
    "joint_names": ["stick"],
    "ambiguous_with": [["encoder_offset at stick"]],
    "delta_bic": [289.3],
    "overall_gain_percent": 12.6,
    "lack_of_fit": 0.95,
    "lack_of_fit_threshold": 1.25,
    "seconds": 14.0,
    "cpu_seconds": 13.0,
}


def test_a_command_breaks_between_its_words_alone(tmp_path: Path) -> None:
    """At 400 px options stay whole, hyphens and ends of names too; what is copied is as it was."""
    text = "modelgen excite arms.yaml --arm digger --period 10 --starts 2 --seed 1 --out 'a b/trajectory.csv'"
    path = tmp_path / "page.html"
    path.write_text(paged("x", "y", [("What", [Command(text)])], []), encoding="utf-8")
    with opened(path, 400) as window:
        assert window.locator("pre code").text_content() == text
        heights = [box["height"] for box in map(Locator.bounding_box, window.locator(".word").all()) if box]
        assert len(heights) == text.count(" ") + 1
        assert max(heights) < 1.5 * min(heights)
        whole = window.locator("pre code").bounding_box()
    assert whole is not None
    assert whole["height"] > 2 * max(heights)


def identified() -> str:
    train, _, test = three(None, 1, 0.0)
    return mg.identify(ARM, train=train, test=test).files()["report.html"]


def refined() -> str:
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    noise = 1e-3 * np.random.default_rng(0).standard_normal(len(swing.t))
    return mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0] + noise}).files()["report.html"]


def calibrated() -> str:
    arm = mg.load_arms()["ariane4"]
    motor = np.linspace(0.0, 20_000.0, 300)
    angle = lever_of(arm, 3).angle(motor) + 0.02 + 0.01 * np.random.default_rng(1).standard_normal(300)
    log = {"t": 0.05 * np.arange(300), "qm3": motor, "q3": angle}
    return mg.calibrate(arm, 3, log).files()["report.html"]


def excited() -> str:
    arm = mg.load_arms()["ariane4"]
    return mg.excite(arm, period=20.0, starts=1, iterations=5, processes=1).files()["trajectory.html"]


def fleet() -> str:
    named = [
        {"unit": f"u{k}", "verdict": "named", "report": f"units/u{k}/report.html"} | ROW for k in range(3)
    ]
    return overview([*named, {"unit": "broken", "arm": "digger", "error": "b.csv:101: found 'word'"}])


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    folder, found = tmp_path_factory.mktemp("pages"), {}
    made = {
        "identify": identified,
        "refine": refined,
        "calibrate": calibrated,
        "excite": excited,
        "fleet": fleet,
    }
    for name, page in made.items():
        found[name] = folder / f"{name}.html"
        found[name].write_text(page(), encoding="utf-8")
    return found


@pytest.mark.parametrize("name", QUESTIONS)
def test_a_page_says_first_what_was_found_and_what_to_do_next(name: str, pages: Mapping[str, Path]) -> None:
    assert pages[name].stat().st_size < 1_500_000
    with opened(pages[name]) as page:
        assert page.locator("dl.answer dt").all_inner_texts() == QUESTIONS[name].split(", ")
        assert page.locator("h1").count() == 1
        last = page.locator("dl.answer > div").last.bounding_box()
        assert last is not None
        assert last["y"] < 900


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", QUESTIONS)
def test_a_page_can_be_read_by_everybody(
    name: str, width: int, scheme: str, pages: Mapping[str, Path]
) -> None:
    """The rules of axe-core, all unfolded; nothing stands beyond the edge; letters are legible."""
    with opened(pages[name], width, scheme) as page:
        page.evaluate("document.querySelectorAll('details:not(.screen)').forEach(d => d.open = true)")
        assert violations(page) == []
        assert wider(page) == 0
        if page.locator("svg.chart").count():
            assert letters(page, "svg.chart text") > 10.0


@pytest.mark.parametrize("name", QUESTIONS)
def test_a_page_is_printed_on_few_sheets_and_whole(name: str, pages: Mapping[str, Path]) -> None:
    with opened(pages[name]) as page:
        on_few_sheets(page, 1)


def test_a_joint_has_one_row_of_the_motion_on_paper(pages: Mapping[str, Path]) -> None:
    """So that the limits are on the same sheet, on one of US Letter too, 6 % shorter than one of A4."""
    with opened(pages["excite"]) as page:
        _, filled = printed(page)
        assert filled < 0.9
        with on_paper(page):
            boxes = [box for box in map(Locator.bounding_box, page.locator("figure").all()) if box]
    assert len(boxes) == 12
    assert [len({round(box["y"]) for box in boxes[k : k + 4]}) for k in (0, 4, 8)] == [1, 1, 1]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_table_shows_at_its_edge_that_it_goes_on(scheme: str, pages: Mapping[str, Path]) -> None:
    """By a shade at the right, then at the left; none at an end, and none of a table that has room."""

    def shades(table: Locator) -> tuple[bool, bool]:
        image = imread(BytesIO(table.screenshot()))[..., :3].mean(axis=2)
        # what most rows of a column of pixels have: no letter, no line
        away = np.abs(np.median(image, axis=0) - np.median(image)) > 0.06
        return bool(away[:5].any()), bool(away[-5:].any())

    with opened(pages["identify"], 400, scheme) as page:
        tables = page.locator(".table")
        wide = [k for k in range(tables.count()) if _beyond(tables.nth(k)) > 40]
        assert wide
        table = tables.nth(wide[-1])
        assert shades(table) == (False, True)
        table.evaluate("t => t.scrollLeft = 20")
        assert shades(table) == (True, True)
        table.evaluate("t => t.scrollLeft = t.scrollWidth")
        assert shades(table) == (True, False)
    with opened(pages["identify"], 1280, scheme) as page:
        table = page.locator(".table").last
        assert _beyond(table) == 0
        assert shades(table) == (False, False)


@pytest.mark.parametrize("name", QUESTIONS)
def test_no_table_of_an_answer_needs_scrolling_on_a_phone(name: str, pages: Mapping[str, Path]) -> None:
    with opened(pages[name], 400) as page:
        following = page.locator("dl.answer > div").last.bounding_box()
        assert following is not None
        assert following["y"] < 900  # what to do next is on the first screen
        page.evaluate("document.querySelectorAll('dl.answer details').forEach(d => d.open = true)")
        for table in page.locator("dl.answer .table").all():
            assert _beyond(table) == 0


def test_what_a_head_has_in_brackets_stays_on_one_line(tmp_path: Path) -> None:
    grid = Grid("Errors", [("less % (95 %)", "right")] * 9, [["1"] * 9])
    path = tmp_path / "page.html"
    path.write_text(paged("Errors", "Test", [("Errors", [grid])], []), encoding="utf-8")
    with opened(path, 400) as window:
        heads = window.locator("th").all()
        assert len(heads) == 9
        for head in heads:
            assert len(_lines(head, "95")) == 1
            assert _lines(head, "95") == _lines(head, "%)")
            assert _lines(head, "less") != _lines(head, "95")


def test_a_number_without_a_unit_has_no_unit_beside_it() -> None:
    """Nor has a table a column of units that is empty."""
    heads = (("parameter", "left"), ("unit", "left"))

    def shown(*units: str) -> list[str]:
        (table,) = html([Grid("Parameters", heads, [("k", unit) for unit in units])])
        return re.findall(r"<t[hd](?: [^>]*)?>([^<]*)<", table)

    assert shown("1", "") == ["parameter", "k", "k"]
    assert shown("1", "m") == ["parameter", "unit", "k", "", "k", "m"]


def test_names_beside_their_values_are_whole_on_a_phone(pages: Mapping[str, Path]) -> None:
    with opened(pages["identify"], 400) as page:
        picture = page.locator("svg.rows").first.bounding_box()
        assert picture is not None
        for name in page.locator("svg.rows text[text-anchor=end]").all():
            box = name.bounding_box()
            assert box is not None
            assert box["x"] >= picture["x"]


def _lines(cell: Locator, text: str) -> set[int]:
    """Heights at which a piece of the text of a cell stands [pixel]."""
    found: list[float] = cell.evaluate(
        """(cell, text) => {
          const range = document.createRange(), node = cell.firstChild, at = node.data.indexOf(text);
          range.setStart(node, at);
          range.setEnd(node, at + text.length);
          return [...range.getClientRects()].map(r => r.top);
        }""",
        text,
    )
    return {round(y) for y in found}


def _beyond(table: Locator) -> int:
    found: int = table.evaluate("t => t.scrollWidth - t.clientWidth")
    return found


@pytest.mark.parametrize("name", QUESTIONS)
def test_every_axis_has_its_unit(name: str, pages: Mapping[str, Path]) -> None:
    text = pages[name].read_text(encoding="utf-8")
    labels = re.findall(r'<text class="label"[^>]*>([^<]*)<', text)
    assert bool(labels) == (name != "fleet")
    assert all(re.search(r"\[.+\]", label) for label in labels)


def test_a_command_is_copied(pages: Mapping[str, Path]) -> None:
    with opened(pages["identify"]) as page:
        command = page.locator("pre").first
        command.get_by_role("button", name="Copy").press("Enter")
        command.get_by_role("button", name="Copied").wait_for()


def test_units_fold_on_a_phone_and_are_sorted_there(pages: Mapping[str, Path]) -> None:
    with opened(pages["fleet"], 400) as page:
        table = page.get_by_role("region", name="Units")
        assert _beyond(table) == 0
        page.get_by_role("button", name="unit").press("Enter")
        first = page.locator("#units tbody tr").first
        assert "broken" in first.inner_text()
        heads = first.locator("td:not(:empty)").evaluate_all("c => c.map(x => x.dataset.head)")
        assert heads == ["unit", "arm", "verdict", "reason"]


def test_units_are_sorted_and_found_by_the_keyboard(pages: Mapping[str, Path]) -> None:
    with opened(pages["fleet"]) as page:
        first = page.locator("#units tbody tr").first
        assert "u0" in first.inner_text()
        page.get_by_role("button", name="unit").press("Enter")
        assert "broken" in first.inner_text()
        page.locator("#filter").fill("word")
        assert page.locator("#units tbody tr:visible").count() == 1


def test_bars_of_a_fleet_name_joints_and_no_range_is_a_single_value(pages: Mapping[str, Path]) -> None:
    with opened(pages["fleet"]) as page:
        bar = page.get_by_role("table", name="Causes named, by joint").locator("tbody tr")
        assert bar.inner_text().split() == ["load_dependent_friction", "3", "(stick)"]
        verdicts = page.get_by_role("table", name="Verdicts").locator("tbody tr")
        assert [row.inner_text().split() for row in verdicts.all()] == [
            ["cause", "named", "3"],
            ["failed", "1"],
        ]
        worth = page.locator("dl.answer").inner_text()
    assert "12.6 to 12.6" not in worth
    assert "12.6 % less over all joints in each of 3 units." in worth
    other = {"unit": "u3", "verdict": "named", "report": "r", **ROW, "joints": [3], "joint_names": ["bucket"]}
    named = [{"unit": "u0", "verdict": "named", "report": "r"} | ROW, other | {"overall_gain_percent": 8.0}]
    said = overview(named)
    assert "(stick: 1, bucket: 1)" in said
    assert "(median of 2 units, 8.0 to 12.6 %)" in said


def test_a_cause_that_harms_its_test_record_is_marked_in_a_fleet(tmp_path: Path) -> None:
    """In its row, in what it is worth and in what to look at next, by its name; the others are not."""
    row = {"unit": "u1", "verdict": "named", "report": "units/u1/report.html"} | ROW
    both = {
        "causes": ["load_dependent_friction", "spring"],
        "joints": [2, 1],
        "joint_names": ["stick", "boom"],
        "titles": ["load_dependent_friction at stick", "spring at boom"],
        "ambiguous_with": [[], []],
        "harms": [False, True],
    }
    path = tmp_path / "overview.html"
    path.write_text(overview([row | {"unit": "u0"}, row | both]), encoding="utf-8")
    with opened(path) as page:
        assert violations(page) == []
        marked = page.locator("#units strong")
        assert marked.all_inner_texts() == ["✗ makes its test record worse"]
        assert "spring at boom" in marked.locator("..").inner_text()
        worth, following = (page.locator("dl.answer > div").nth(k).inner_text() for k in (3, 4))
    assert "In one unit a cause makes its test record worse" in worth
    assert "u1: spring at boom makes its test record worse" in following
    assert "u0" not in following


def test_what_is_uncertain_is_said_in_effort(pages: Mapping[str, Path]) -> None:
    """A first moment of zero with a standard deviation that moves nothing is no complaint."""
    train, _, test = three(None, 1, 0.0)
    found = mg.identify(ARM, train=train, test=test).outcome.found
    assert found.test is not None
    for k, e in enumerate(found.estimates):
        j = found.test.shown_by(k)
        assert e.std is not None
        assert j is not None
        _, share = found.test.in_effort(k, e.std)
        assert ((k, e) in found.poor()) == (not (e.relative and e.relative <= 30.0) and share > 1.0)
    assert any(e.relative is None or e.relative > 30.0 for e in found.estimates)


def test_the_effort_of_a_parameter_is_what_it_adds(pages: Mapping[str, Path]) -> None:
    """By the model with a parameter changed, predicted anew."""
    train, _, test = three(None, 1, 0.0)
    result = mg.identify(ARM, train=train, test=test)
    found = result.outcome.found
    assert found.test is not None
    assert found.test.sizes is not None
    whole = np.sqrt(np.mean(found.test.measured**2, axis=0))
    theta = np.array([e.value for e in found.estimates])
    # no column alone is larger than a few times what all of them make together
    assert (found.test.sizes * np.abs(theta) < 5.0 * whole[:, None]).all()


def test_what_identify_found_is_one_line_and_questions_stand_below_it(tmp_path: Path) -> None:
    train, _, test = three(None, 1, 0.0)
    result = mg.identify(ARM, train=train, test=test)
    doubts = tuple(f"Is joint {name} what the description says? " + 12 * "So it is asked. " for name in "abc")
    outcome = replace(result.outcome, found=replace(result.outcome.found, doubts=doubts))
    path = tmp_path / "report.html"
    path.write_text(Identification(outcome, result.call).files()["report.html"], encoding="utf-8")
    with opened(path) as page:
        first = page.locator("dl.answer > div").first
        assert first.locator("p").count() == 1
        box = first.locator("p").bounding_box()
        assert box is not None
        assert box["height"] < 35  # pixel, a line of this size
        assert first.locator("li").count() == 3
        last = page.locator("dl.answer > div").last.bounding_box()
        assert last is not None
        assert last["y"] < 900


def test_limits_of_an_excitation_are_called_by_their_names(pages: Mapping[str, Path]) -> None:
    with opened(pages["excite"]) as page:
        said = page.locator("dl.answer").inner_text() + page.locator("table").last.inner_text()
    assert "motor speed of j3" in said
    assert not re.search(r"\bd*qm?\d\b", said)


def test_what_is_uncertain_of_a_refinement_is_said_in_its_motion() -> None:
    """By the motion simulated anew with a parameter that differs by its standard deviation."""
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    noise = 1e-3 * np.random.default_rng(0).standard_normal(len(swing.t))
    found = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0] + noise})
    values = {x.name: x.value for x in found.parameters.values()}
    for x in found.parameters.values():
        if x.std is None:
            continue
        pair = [
            mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0, parameters=values | {x.name: value})
            for value in (x.value, x.value + x.std)
        ]
        moved = float(np.sqrt(np.mean((pair[1].q - pair[0].q) ** 2)))
        assert x.moves == pytest.approx(moved, rel=0.05)
        assert x.moves < 1e-3  # rad, the noise: so many samples tell more than one
    page = found.files()["report.html"]
    assert "Most uncertain, against the errors that remain, is" in page


def test_a_refinement_says_first_by_how_much_the_simulated_motion_errs() -> None:
    """Before it too from the initial state that suits best: values that are right gain nothing by it."""
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    noise = 1e-4 * np.random.default_rng(0).standard_normal(len(swing.t))
    right = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0] + noise})
    assert right.found.before.rmse[0] == pytest.approx(1e-4, rel=0.1)  # rad
    assert "keep the values of the start" in str(right.shown()[0])
    assert re.search(r"misses the measured one by 0\.\d{3,4} mrad \(RMSE\)", str(right.shown()[0]))
    assert "gained is by all together" not in right.files()["report.html"]
    values = {x.name: x.start for x in right.parameters.values()}
    other = values | {"FV1": 1.5 * values["FV1"]}
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0, parameters=other)
    found = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]})
    first = found.shown()[0]
    assert isinstance(first, str)
    assert "keep the values" not in first
    assert first in unescape(found.files()["report.html"])
    after, before = (1e-3 * float(x) for x in re.findall(r"(?:by|was) (\d[\d.e-]*\d) mrad", first))
    missed = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0).q - swing.q
    assert 0.3 < before / float(np.sqrt(np.mean(missed**2))) <= 1.0  # another initial state suits it better
    assert after < 1e-3 * before
    position, error = motion(found.found)
    assert [c.label for c in position.curves] == ["measured", "simulated, at the start", "simulated, refined"]
    assert error.y_label == "error [mrad]"
    assert np.sqrt(np.nanmean(error.curves[0].y ** 2)) == pytest.approx(1e3 * before, rel=0.01)


def test_the_words_of_a_refinement_agree_with_how_it_ended() -> None:
    """Tuned until nothing is nearer, or stopped on the way, which is said first."""
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    done = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]})
    assert done.converged
    for stopped in ("", "the errors still fell at step 40, the last one"):
        result = Refinement(replace(done.found, stopped=stopped), done.call)
        found, _, _, following = re.split("<dt[^>]*>", result.files()["report.html"])[1:5]
        said = re.sub("<[^>]+>", "", found.partition("<dd>")[2])
        assert ("parameters were tuned until no step" in said) == (not stopped)
        assert said.strip().startswith("It did not converge after") == bool(stopped)
        assert stopped in said
        assert ("is near enough to the measured one all the same, generate" in following) == bool(stopped)
        assert ("not converged" in repr(result)) == bool(stopped)


def test_what_began_at_identified_values_and_found_nothing_begins_anew_more_often(tmp_path: Path) -> None:
    """To identify the parameters is what was done; values that no step left are those of the start."""
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    done = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]})
    start = tuple(replace(x, value=x.start) for x in done.found.parameters)
    nothing = replace(done.found, parameters=start, stopped="no step", effort=True, before=done.found.after)
    log, values = tmp_path / "a.csv", tmp_path / "values.yaml"
    log.touch()
    call = replace(
        done.call,
        train=(str(log),),
        options=mg.RefinementOptions(parameters=values, window=0.5),
    )
    said = re.sub("<[^>]+>", "", Refinement(nothing, call).files()["report.html"])
    assert "All values are those of the start" in said
    assert "Identify the parameters" not in said
    assert f"--log {log} --parameters {values} --window 0.25 --out again" in said


def test_no_code_comes_first_of_values_that_the_motion_does_not_determine() -> None:
    """A swing or two in noise show the sum of a pendulum's dry and viscous friction, and hardly either; in
    more noise they show nothing.
    """
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=1.5, rate=200.0)
    nominal = {"ZZ1": 0.309706, "MX1": 1.307841, "MY1": 0.0, "FV1": 0.7, "FC1": 0.187}
    for noise, loose in ((0.03, True), (0.003, False)):
        q = swing.q[:, 0] + noise * np.random.default_rng(0).standard_normal(len(swing.t))
        result = mg.refine(arm, {"t": swing.t, "q1": q}, parameters=nominal)
        moved = [x.moves for x in result.found.parameters if x.std]
        page = re.sub("<[^>]+>", "", result.files()["report.html"])
        assert (max(moved) > result.found.after.rmse[0]) == loose
        assert ("Generate no code yet: FV1 is not determined" in page) == loose
        assert ("For motions like this one alone, generate code" in page) == loose
        assert page.count("modelgen generate") == 1
    q = swing.q[:, 0] + 0.06 * np.random.default_rng(0).standard_normal(len(swing.t))
    with pytest.raises(mg.InputError, match="less than ten times their noise"):
        mg.refine(arm, {"t": swing.t, "q1": q})


def test_a_table_of_many_columns_has_a_line_for_each_row_on_paper(tmp_path: Path) -> None:
    """With values and units of a usual length; it stood in a part of the sheet, in rows of five lines."""
    arm, path = mg.load_arms()["gravity_link2"], tmp_path / "report.html"
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    result = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]})
    (own,) = [x for x in result.found.parameters if x.name == "FV1"]
    long = replace(own, start=9.9346e-09, value=1.01183e-08, std=5.1e-11, unit="J s^2/unit^2")
    others = [replace(long, name=f"ZZ{k}R") for k in range(12)]
    result.found = replace(result.found, parameters=tuple(others))
    path.write_text(result.files()["report.html"], encoding="utf-8")
    with opened(path) as page:
        on_few_sheets(page, 1)
    with opened(path) as page, on_paper(page):
        rows = page.get_by_role("region", name="Parameters").locator("tbody tr").all()
        boxes = [row.bounding_box() for row in rows]
        letter = letters(page, "tbody td")
    assert len(boxes) > 1
    assert all(box is not None and box["height"] < 2.0 * letter for box in boxes)


@pytest.mark.parametrize("name", ["identify", "refine", "calibrate"])
def test_parameters_stand_with_their_intervals_in_a_picture(name: str, pages: Mapping[str, Path]) -> None:
    """A dot within its interval for each, beside a ring at what was known before; of identify by joint."""
    with opened(pages[name]) as page:
        pictures = page.locator("svg.rows")
        units = {"calibrate": ["[mm]", "[deg]"], "refine": ["[mrad]"], "identify": 2 * ["[A]"]}[name]
        labels = [text.split()[-1] for text in pictures.locator(".label").all_text_contents()]
        assert labels == units
        for picture in pictures.all():
            spans, dots = picture.locator(".span").all(), picture.locator(".dot").all()
            assert len(spans) == len(dots) > 0
            assert picture.locator(".ring").count() == (0 if name == "identify" else len(dots))
            for span, dot in zip(spans, dots, strict=True):
                low, high = re.findall(r"[MH]([\d.]+)", span.get_attribute("d") or "")
                assert float(low) < float(dot.get_attribute("cx") or "nan") < float(high)


@pytest.mark.parametrize("converged", [True, False])
def test_a_refinement_draws_its_parameters_beside_the_description(converged: bool, tmp_path: Path) -> None:
    """From where they started, at zero; of one that did not converge without intervals."""
    arm, path = mg.load_arms()["gravity_link2"], tmp_path / "report.html"
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    nominal = {x.name: x.start for x in mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]}).found.parameters}
    start = nominal | {"FV1": 1.5 * nominal["FV1"]}
    result = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]}, parameters=start)
    if not converged:
        uncertain = tuple(replace(x, std=None) for x in result.found.parameters)
        result.found = replace(result.found, parameters=uncertain, stopped="the errors still fell")
    path.write_text(result.files()["report.html"], encoding="utf-8")
    with opened(path) as page:
        (picture,) = page.locator("svg.rows").all()
        assert ("no value has an interval" in page.content()) != converged
        assert ("its 95 % interval" in page.content()) == converged
        zero = re.findall(r"M([\d.]+)", picture.locator(".grid.zero").get_attribute("d") or "")
        rows = [
            tuple(float(mark.get_attribute("cx") or "nan") for mark in picture.locator(look).all())
            for look in (".dot", ".ring")
        ]
        assert rows[0] == pytest.approx(rows[1], abs=1.0)  # pixel: the values of the description are found
        assert (
            min(abs(x - float(zero[0])) for x in rows[0])
            < 1.0
            < max(abs(x - float(zero[0])) for x in rows[0])
        )
        spans = [s.get_attribute("d") or "" for s in picture.locator(".span").all()]
        ends = [re.findall(r"[MH]([\d.]+)", span) for span in spans]
        assert converged or all(low == high for low, high in ends)


def test_what_moved_is_written_with_the_digits_that_tell_it_from_before(tmp_path: Path) -> None:
    arm = mg.load_arms()["gravity_link2"]
    swing = mg.simulate(arm, q0="20 deg", duration=2.0, rate=200.0)
    result = mg.refine(arm, {"t": swing.t, "q1": swing.q[:, 0]})
    (own,) = [x for x in result.found.parameters if x.name == "FV1"]
    moved = replace(own, start=2.02481, value=2.02484, std=1e-6)
    others = [x for x in result.found.parameters if x.name != "FV1"]
    result.found = replace(result.found, parameters=(moved, *others))
    text = result.files()["report.html"]
    assert "FV1 2.02481 → 2.02484 " in text
    assert ">2.02481</td>" in text
    assert ">2.02484</td>" in text
    (_, parameters, _) = result.shown()
    assert isinstance(parameters, Table)
    assert ["FV1", "2.02481", "2.02484"] in [row[:3] for row in parameters.rows]


def test_what_a_calibration_leaves_open_is_said_in_its_units(pages: Mapping[str, Path]) -> None:
    with opened(pages["calibrate"]) as page:
        said = page.locator("dl.answer > div").nth(2).inner_text()
        values = page.get_by_role("region", name="Lever as described and calibrated")
        stds = {
            row.locator("td").first.inner_text(): row.locator("td").nth(3).inner_text()
            for row in values.locator("tbody tr").all()
        }
    found = dict(re.findall(r"(\w+) ± ([\d.]+) (?:mm|deg)", said))
    assert found.keys() == stds.keys()
    for name, half in found.items():
        assert float(half) == pytest.approx(1.96 * float(stds[name]), rel=0.06)


def test_a_calibration_says_whether_the_description_stands() -> None:
    """Of angles of the lever as described, and of one whose zero is elsewhere."""
    arm, motor = mg.load_arms()["ariane4"], np.linspace(0.0, 20_000.0, 300)
    noise = 2e-3 * np.random.default_rng(1).standard_normal(len(motor))
    for offset in (0.0, 0.05):
        log = {"t": 0.05 * np.arange(300), "qm3": motor, "q3": lever_of(arm, 3).angle(motor) + offset + noise}
        found = mg.calibrate(arm, 3, log)
        (verdict,) = [x for x in found.shown() if isinstance(x, str) and "standard deviations" in x]
        assert verdict.startswith("The description stands") == (not offset)
        page = found.files()["report.html"]
        assert verdict in page
        assert ("Keep the description" in page) == (not offset)


def test_what_an_excitation_determines_worst_is_said_in_amperes(pages: Mapping[str, Path]) -> None:
    """With how to mend it, on the page, in the terminal and in the JSON file alike."""
    made = mg.excite(mg.load_arms()["ariane4"], period=20.0, starts=1, iterations=5, processes=1)
    data = made.to_json()["worst_determined"]
    with opened(pages["excite"]) as page:
        said = page.locator("dl.answer > div").nth(1).inner_text()
    found = re.findall(r"(\w+) \(([\d.]+) A, ([\d.]+) % of the effort of (\w+)\)", said)
    assert len(found) == len(data) == 3
    for (name, size, share, joint), x in zip(found, data, strict=True):
        assert (name, joint) == (x["parameter"], made.arm.coordinate_names[x["joint"] - 1])
        assert float(size) == pytest.approx(x["effort"], rel=0.06)
        assert float(share) == pytest.approx(x["percent_of_effort"], rel=0.06)
    (periods,) = re.findall(r"Record (\d+) periods in a row", said)
    assert max(x["percent_of_effort"] for x in data) / float(periods) ** 0.5 <= 1.0
    assert "larger accelerations, of" in said
    lines = [line for line in made.shown() if isinstance(line, str)]
    assert all(any(text == line for line in lines) for text in said.splitlines()[1:] if text)
