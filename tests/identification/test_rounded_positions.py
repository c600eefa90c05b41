"""Deviations hold what coarse positions do, however long the record is, and what nobody knows of instants."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import geared_link
import numpy as np
import pytest
from geared_link import sines

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.report.noise import said_of_noise

Table = dict[str, np.ndarray]
LINK = replace(geared_link.LINK, viscous=1.0e-4)
ARM = loads(LINK.description(), "arms.yaml", known_effects())["one"]


def log(
    seed: int, *, bits: int = 0, seconds: float = 20.0, rate: float = 250.0, noise: float = 0.005
) -> Table:
    """Six harmonics of 5 s, by hand; positions of so many bits a turn. Efforts are read at their instant."""
    random, t = np.random.default_rng(seed), np.arange(int(rate * seconds)) / rate
    w = 2 * np.pi * np.arange(1, 7) / 5.0
    size, phase = random.uniform(0.1, 0.3, 6), random.uniform(0, 6.28, 6)
    q, dq, ddq = sines(t, phase, size, w)
    current = LINK.currents(q, dq, ddq) + noise * random.standard_normal(len(t))
    step = 2 * np.pi / 2**bits if bits else 0.0
    return {"t": t, "q1": step * np.rint(q / step) if step else q, "i1": current}


@pytest.fixture(scope="module")
def stated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What says that efforts are read at the positions' instant."""
    path = tmp_path_factory.mktemp("mapping") / "mapping.yaml"
    joint = "{position: {column: q1, unit: rad}, effort: {column: i1, unit: A}}"
    path.write_text(f"schema: 1\ntime: {{column: t}}\nhold: instant\njoints:\n  - {joint}\n")
    return path


def away(mapping: Path | None, seeds: range, *, stream: bool = False, **how: float) -> np.ndarray:
    """Errors of the parameters in their deviations, by log."""
    found = []
    for seed in seeds:
        result = mg.identify(ARM, log(seed, **how), log(seed + 1000, **how), mapping=mapping, stream=stream)
        found.append(
            [
                (result.parameters[name].value - x) / result.parameters[name].std
                for name, x in LINK.parameters.items()
            ]
        )
    return np.array(found)


@pytest.mark.parametrize("bits", [10, 12])
def test_deviations_hold_what_coarse_positions_do_to_a_long_record(bits: int, stated: Path) -> None:
    """Noise of a minute hides nothing of it."""
    found = away(stated, range(4), bits=bits, seconds=60.0)
    assert np.sqrt(np.mean(found**2)) < 1.6
    assert np.abs(found).max() < 4.0


@pytest.mark.parametrize("how", [{"bits": 12, "seconds": 120.0}, {"rate": 20.0, "seconds": 60.0}])
def test_deviations_of_a_streamed_log_hold_the_same(how: dict[str, float], stated: Path) -> None:
    """A long record is what is streamed, and what noise hides least of."""
    found = away(stated if "bits" in how else None, range(3), stream=True, **how)
    assert np.sqrt(np.mean(found**2)) < 1.6
    assert np.abs(found).max() < 4.0


def test_fine_positions_have_the_deviations_of_their_noise(stated: Path) -> None:
    """Neither much less nor much more."""
    found = away(stated, range(8))
    assert 0.6 < np.sqrt(np.mean(found**2)) < 1.5


def test_deviations_hold_the_instant_that_a_slow_log_does_not_show(stated: Path) -> None:
    """Of 20 Hz the default is half a sample off, which is more than the noise."""
    slow = away(None, range(4), rate=20.0)
    assert np.abs(slow).max() < 3.0
    known = away(stated, range(4), rate=20.0)
    assert np.abs(known).max() < 4.0


def test_steps_of_positions_are_no_lack_of_the_model_and_a_cut_off_beyond_them_is_asked_about(
    stated: Path,
) -> None:
    """Nothing is missing. Steps of a motion that repeats repeat with it: the periods differ by less."""

    def judged(bits: int, cutoff: float) -> mg.IdentificationResult:
        train, test = (log(seed, bits=bits, noise=1e-4) for seed in (3, 1003))
        return mg.identify(ARM, train, test, mapping=stated, cutoff=cutoff)

    blurred, beyond, fine = judged(10, 2.5), judged(8, 8.0), judged(0, 8.0)
    for found in (blurred, beyond):
        test = found.to_json()["test"]
        assert test["rmse"][0] > 3.0 * test["noise_rmse"][0]
        lacks, said = said_of_noise(found.outcome.found)
        assert not lacks
        assert "the steps of the positions feign" in said
    assert "steps" not in said_of_noise(fine.outcome.found)[1]
    asked = [[d for d in x.to_json()["doubts"] if "too coarse" in d] for x in (fine, blurred, beyond)]
    assert [len(doubts) for doubts in asked] == [0, 0, 1]
    assert "inertias come out too small" in asked[2][0]
    assert beyond.parameters["ZZ1"].value < 0.9 * LINK.parameters["ZZ1"]
