"""The example of a controller on an emulated board: the model pays, and the limits hold."""

import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from firmware.targets import M4F
from tracking_board import controller, program
from tracking_loop import MODES, Plant, Record, closed_loop, plant_library
from tracking_values import CURRENT_LIMIT, Values, model, values

pytestmark = pytest.mark.xdist_group("ariane4")


@dataclass(frozen=True)
class Given:
    """What every run begins with: the numbers, the plant, the controller for the emulator within Python."""

    values: Values
    plant: Path
    program: Path

    def record(self, mode: int, seconds: float) -> Record:
        with controller(self.program, self.program.parent, qemu=False) as board:
            return closed_loop(board, Plant(self.values, self.plant), mode, seconds)


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Given:
    v, folder = values(model()), tmp_path_factory.mktemp("firmware")
    return Given(v, plant_library(folder), program(v, folder, qemu=False))


def test_the_model_lowers_the_error_in_every_joint(given: Given) -> None:
    alone, gravity, whole = (given.record(mode, 3.0) for mode in range(len(MODES)))
    assert (whole.rms < 0.4 * alone.rms).all()
    assert (whole.rms < 0.4 * gravity.rms).all()
    assert (gravity.rms[1:] < alone.rms[1:]).all()  # the first axis is vertical: no gravity there
    assert (np.degrees(whole.rms) < 0.5).all()


def test_strokes_and_currents_stay_within_their_limits(given: Given) -> None:
    """Over the whole motion, which asks joint 1 for more than its stroke and joint 2 for more current."""
    run = given.record(2, 9.0)
    low, high = given.values.low, given.values.high
    assert (run.reference >= low - 1e-6).all()
    assert (run.reference <= high + 1e-6).all()
    assert np.isclose(run.reference[:, 0].max(), high[0])  # the end is reached
    assert (run.q > low - np.radians(0.5)).all()
    assert (run.q < high + np.radians(0.5)).all()
    assert np.abs(run.current).max() == np.float32(CURRENT_LIMIT)  # and so is the limit


@pytest.mark.skipif(bool(M4F.missing), reason=f"{M4F.missing} not installed (.ci/run installs it)")
def test_the_board_in_qemu_does_the_same(given: Given, tmp_path: Path) -> None:
    """Another compiler, another emulator: a few increments of the encoders apart."""
    in_python = given.record(2, 1.0)
    with controller(program(given.values, tmp_path, qemu=True), tmp_path, qemu=True) as board:
        on_board = closed_loop(board, Plant(given.values, given.plant), 2, 1.0)
    assert np.abs(in_python.q - on_board.q).max() < 1e-4
    assert np.abs(in_python.current - on_board.current).max() < 0.05


def test_the_figures_told_are_those_of_the_plot_s_runs(checkout: Path) -> None:
    folder = checkout / "examples" / "firmware"
    summary = json.loads((folder / "tracking.json").read_text(encoding="utf-8"))
    assert list(summary) == list(MODES)
    text = (folder / "README.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"\| ([a-z ]+) \| ([\d. |]+) \|", text))
    for mode, figures in summary.items():
        told = [float(x) for x in rows[mode].split("|")]
        assert told == [round(x, 2) for x in figures["rms_deg"]]
