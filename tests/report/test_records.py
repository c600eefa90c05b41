"""When the records of a page began: the same words on every kind of page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import ARM, three

import modelgen as mg
from modelgen.calibration.lever import lever_of
from modelgen.dataset.recorded import Recorded, of_stamps
from modelgen.fleet.unit_table import cells
from modelgen.report.records import records_table

BEGAN = 1_700_000_000.0
SAID = "2023-11-14T22:13:20Z"


def test_a_table_of_records_has_dates_where_one_is_known() -> None:
    some = [Recorded("a.csv", "train", 100, 250.0, BEGAN), Recorded("b.csv", "test", 10, 250.0, None)]
    dated = records_table(some)
    assert dated.caption == "Records"
    assert dated.rows == [("a.csv", "train", "100", "250", SAID), ("b.csv", "test", "10", "250", "")]
    plain = records_table([replace(x, begins=None, use="") for x in some])
    assert "do not say when they were made" in plain.caption
    assert [head for head, _ in plain.heads] == ["record, undated", "samples", "rate [Hz]"]
    assert of_stamps("c", np.arange(5) / 250.0, None).rate == pytest.approx(250.0)


@pytest.mark.parametrize("start", [0.0, BEGAN])
def test_pages_of_identify_refine_and_calibrate_say_when_their_logs_began(start: float) -> None:
    train, _, test = three(None, 1, 0.0)
    dated = replace(train, begins=start or None)
    arms = mg.load_arms()
    swing = mg.simulate(arms["gravity_link2"], q0="20 deg", duration=2.0, rate=200.0)
    noise = 1e-3 * np.random.default_rng(0).standard_normal(len(swing.t))
    motor = np.linspace(0.0, 20_000.0, 300)
    angle = lever_of(arms["ariane4"], 3).angle(motor) + 0.01 * np.random.default_rng(1).standard_normal(300)
    found = (
        mg.identify(ARM, train=dated, test=test),
        mg.refine(arms["gravity_link2"], {"t": start + swing.t, "q1": swing.q[:, 0] + noise}),
        mg.calibrate(arms["ariane4"], 3, {"t": start + 0.05 * np.arange(300), "qm3": motor, "q3": angle}),
    )
    for result in found:
        page = result.files()["report.html"]
        assert (SAID in page) == (start > 0.0)
        assert ("do not say when they were made" in page) == (start == 0.0)


def test_the_page_of_a_fleet_says_when_the_first_record_of_a_unit_began() -> None:
    row = {"unit": "u", "arm": "a", "train": [], "test": [], "error": "none"}
    for begins, said in (([None, BEGAN + 9.0, BEGAN], SAID), ([None], "")):
        own = cells(row | {"begins": begins})
        assert [c["text"] for c in own if c["head"] == "begins (UTC)"] == [said]
