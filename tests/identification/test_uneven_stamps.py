"""Logs whose rate changes: efforts are read as the data have them, and what nobody said is no cause."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK, sines

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

ARM = loads(LINK.description(), "arms.yaml", known_effects())["one"]
FAST, SLOW = np.arange(0.0, 24.0, 0.002), np.arange(0.0, 24.0, 0.01)
STAMPS = {
    "slow, then fast": np.concatenate([SLOW[SLOW < 12.0], FAST[FAST >= 12.0]]),
    "fast, then slow": np.concatenate([FAST[FAST < 16.0], SLOW[SLOW >= 16.0]]),
    "now and then slow": FAST[(FAST % 2.0 < 1.7) | (np.arange(len(FAST)) % 5 == 0)],
}
ACTS = {"instant": (0.0, 0.0), "following": (0.0, 1.0), "previous": (-1.0, 0.0)}  # from and to, in rows


def log(seed: int, stamps: np.ndarray, acts: str) -> dict[str, np.ndarray]:
    """Three periods of four harmonics, by hand; a current is the mean over the rows that it acts between."""
    random = np.random.default_rng(seed)
    phase, rows = random.uniform(0, 6.28, 4), np.arange(len(stamps), dtype=float)
    low, high = (np.interp(rows + way, rows, stamps) for way in ACTS[acts])
    parts = [LINK.currents(*sines(low + (high - low) * (k + 0.5) / 8, phase)) for k in range(8)]
    q = sines(stamps, phase)[0] + 2e-6 * random.standard_normal(len(stamps))
    return {"t": stamps, "q1": q, "i1": np.mean(parts, axis=0) + 5e-3 * random.standard_normal(len(stamps))}


@pytest.mark.parametrize("acts", ACTS)
@pytest.mark.parametrize("kind", STAMPS)
def test_efforts_between_uneven_stamps_are_read_as_the_data_have_them(kind: str, acts: str) -> None:
    found = mg.identify(ARM, log(1, STAMPS[kind], acts), log(2, STAMPS[kind], acts))
    made = found.to_json()["log"]
    assert made["rate"] == pytest.approx(100.0, rel=1e-3)  # what nobody read is not made up
    assert made["effort_instant"]["hold"] == acts, made["effort_instant"]
    for name, value in LINK.parameters.items():
        p = found.parameters[name]
        assert abs(p.value - value) < 4.0 * p.std, name


@pytest.mark.parametrize("kind", STAMPS)
def test_an_instant_that_nobody_said_is_no_delay_of_the_arm(kind: str) -> None:
    train = [log(seed, STAMPS[kind], "instant") for seed in (1, 2)]
    found = mg.diagnose(ARM, train=train, test=log(3, STAMPS[kind], "instant"))
    assert not found.causes, found
    assert not found.suspects, found


def test_jitter_and_lost_rows_keep_the_rate() -> None:
    random = np.random.default_rng(1)
    lost = FAST[random.random(len(FAST)) > 0.1]
    late = np.sort(FAST + random.uniform(-0.0008, 0.0008, len(FAST)))
    for stamps in (lost, late):
        assert 1.0 / mg.read_log(log(1, stamps, "instant"), ARM).step == pytest.approx(500.0, rel=1e-2)
