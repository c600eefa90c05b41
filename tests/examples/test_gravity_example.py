"""The gravity test: its simulations, what its scores imply, its simulated measurements."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from gravity_run import NAMES, PUBLISHED, implied, on_measurements, settling_times, simulations
from plant import DURATIONS, HIDDEN, LINE
from plant import PUBLISHED as BARE

from modelgen.simulation import Trajectory

pytestmark = pytest.mark.xdist_group("gravity_test")

PLANT = Path("examples/gravity_test/plant.py")


@pytest.fixture(scope="module")
def found() -> dict[tuple[str, int], Trajectory]:
    return simulations()


def test_settling_times() -> None:
    """Piecewise integration with events at each reversal, to the tenth of a second that is known."""
    expected = {
        "gravity_link1": (7.4, 8.8, 10.1),
        "gravity_link1_loaded": (23.8, 28.6, 31.9),
        "gravity_link2": (2.9, 3.9, 4.4),
    }
    times = settling_times()
    for name in NAMES:
        got = [times[name, degrees] for degrees in DURATIONS]
        np.testing.assert_allclose(got, expected[name], atol=0.051)


@pytest.mark.parametrize("degrees", DURATIONS)
def test_independent_plant_and_simulation_agree(
    found: dict[tuple[str, int], Trajectory], degrees: int
) -> None:
    """With the document's parameters and nothing hidden: equal to the integrators' tolerance."""
    run = found["gravity_link2", degrees]
    np.testing.assert_allclose(BARE.swing(np.radians(degrees), run.t), run.q[:, 0], atol=1e-7)


def test_plant_against_fine_fixed_steps() -> None:
    """The hidden effects too: semi-implicit steps of 20 us, whose error shrinks with them."""
    h = 2e-5
    q, v, path = np.radians(40), 0.0, []
    for i in range(round(5.0 / h)):
        if i % 500 == 0:
            path.append(q)
        load = HIDDEN.load(q)
        limit = HIDDEN.coulomb + HIDDEN.excess
        if v == 0.0 and abs(load) <= limit:
            continue
        side = np.sign(v) or np.sign(load)
        friction = HIDDEN.coulomb + HIDDEN.excess * np.exp(-abs(v) / HIDDEN.velocity)
        after = v + h * (load - HIDDEN.viscous * v - side * friction) / HIDDEN.inertia
        v = 0.0 if v * after < 0.0 else after
        q += h * v
    exact = HIDDEN.swing(np.radians(40), np.arange(500) / 100)
    np.testing.assert_allclose(path, exact, atol=2e-4)
    assert exact[-1] == exact[-2]
    assert exact[-1] > np.radians(0.5)


def test_published_scores_and_both_readings_of_link_1(found: dict[tuple[str, int], Trajectory]) -> None:
    def ratios(link: str, name: str) -> list[float]:
        return [row[3] for row in implied(link, name, found)]

    np.testing.assert_allclose(ratios("link 1", "gravity_link1_loaded"), (0.51, 0.52, 0.59), atol=0.006)
    assert ratios("link 1", "gravity_link1")[2] > 1.0
    assert all(0.785 < r < 0.845 for r in ratios("link 2", "gravity_link2"))


@pytest.mark.parametrize("seed", [0, 1])
def test_simulation_scores_on_the_measurements_as_published(
    found: dict[tuple[str, int], Trajectory], seed: int
) -> None:
    """Within 12 points and half a degree of Table 4."""
    for degrees, (_, _, fit, scatter) in on_measurements(found, seed).items():
        f_gof, mae = PUBLISHED["link 2"][degrees]
        assert abs(fit.f_gof[0] - f_gof) < 12
        assert abs(np.degrees(fit.mae[0]) - mae) < 0.5
        assert np.radians(0.01) < scatter < fit.rmse[0] / 10


def test_logs_are_written_and_alike_by_seed(checkout: Path, tmp_path: Path) -> None:
    for name in ("one", "two"):
        call = [sys.executable, str(checkout / PLANT), "--out", str(tmp_path / name)]
        subprocess.run(call, check=True, capture_output=True, cwd=tmp_path)
    files = sorted(tmp_path.glob("one/*.csv"))
    assert len(files) == 30
    assert all(f.read_bytes() == (tmp_path / "two" / f.name).read_bytes() for f in files)
    table = np.loadtxt(tmp_path / "one/link2_20_1.csv", delimiter=",", skiprows=1)
    assert table[-1, 0] == pytest.approx(DURATIONS[20])
    counts = table[:, 1] / LINE
    assert np.abs(counts - np.round(counts)).max() < 0.01


def test_plant_is_independent(checkout: Path) -> None:
    tree = ast.parse((checkout / PLANT).read_text(encoding="utf-8"))
    modules = [n.module or "" for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)]
    modules += [a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names]
    assert modules
    assert not [m for m in modules if m.startswith("modelgen")]
