"""Rows that are missing though stamps are even, found by the positions: few are made good, many refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dataset_support import AXIS, AXIS_MAPPING, DRIVEN, columns, motion, times, write_csv

import modelgen as mg
from modelgen.dataset import Stream
from modelgen.dataset.reading.lost import RESTORED, missing_rows
from modelgen.dataset.thresholds import USUAL
from modelgen.errors import InputError
from modelgen.identification.streamed import identify_streamed

T = times(20.0, 200.0)
Table = dict[str, np.ndarray]


def numbered_anew(table: Table, kept: np.ndarray) -> Table:
    """The rows that are kept, at even stamps from the first on."""
    return {name: T[: kept.sum()] if name == "t" else values[kept] for name, values in table.items()}


def without(share: float, seed: int, run: int = 1) -> np.ndarray:
    """Flags of rows, a share of which is lost, several in a run."""
    random, kept = np.random.default_rng(seed), np.ones(len(T), dtype=bool)
    for place in random.choice(len(T) - run, int(share * len(T) / run), replace=False):
        kept[place : place + run] = False
    return kept


def rounded(table: Table, bits: int) -> Table:
    step = 2 * np.pi / 2**bits
    return table | {"q1": step * np.rint(table["q1"] / step), "qm2": np.rint(table["qm2"])}


@pytest.mark.parametrize(
    ("share", "bits", "run"), [(0.01, 16, 1), (0.05, 14, 1), (0.05, 20, 2), (0.2, 16, 1), (0.35, 16, 1)]
)
def test_rows_are_missing(share: float, bits: int, run: int, tmp_path: Path) -> None:
    table = numbered_anew(rounded(columns(T), bits), without(share, 1, run))
    test = rounded(columns(T) | {"i1": np.cos(T), "q1": 0.5 * np.sin(T)}, bits)
    (said,) = (x for x in mg.read_log(table, DRIVEN).remarks if "are missing though the stamps are even" in x)
    assert float(said.split(" %")[0]) < 140 * share
    for asked in (mg.identify, mg.diagnose):
        with pytest.raises(InputError, match="the rows or so are missing"):
            asked(DRIVEN, table, test)
        with pytest.raises(InputError, match="the rows or so are missing"):
            asked(DRIVEN, test, table)
    file = write_csv(tmp_path / "a.csv", table)
    with pytest.raises(InputError, match=r"a\.csv.*the rows or so are missing"):
        identify_streamed([Stream(file, DRIVEN)], DRIVEN)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("bits", [12, 14, 20])
def test_what_follows_a_few_missing_rows_counts_as_so_much_later(bits: int, seed: int) -> None:
    kept = without(0.0035, seed)
    record = mg.read_log(numbered_anew(rounded(columns(T), bits), kept), DRIVEN)
    assert not record.jump
    assert any(x.endswith("what follows counts as so much later") for x in record.remarks)
    lost = int(len(T) - kept.sum())
    assert lost >= 10
    assert abs(record.t[-1] - T[kept][-1]) < 0.3 * lost / 200.0
    off = np.abs(record.q - motion(record.t)[0]).max(axis=0)
    as_stamped = np.abs(motion(T[: kept.sum()])[0] - motion(T[kept])[0]).max(axis=0)
    assert (off < 0.3 * as_stamped + 2.0 * np.pi / 2**bits).all()


def test_few_missing_rows_of_a_log_that_is_read_in_blocks_are_refused(tmp_path: Path) -> None:
    """Where the rows before a block are missing is not known there."""
    file = write_csv(tmp_path / "a.csv", numbered_anew(rounded(columns(T), 16), without(0.0035, 1)))
    with pytest.raises(InputError, match=r"a\.csv.*the rows or so are missing"):
        identify_streamed([Stream(file, DRIVEN)], DRIVEN)


def test_the_place_is_named() -> None:
    kept = np.ones(len(T), dtype=bool)
    kept[[420, 1303, 1311, 1984, 2550, 3000]] = False
    table = numbered_anew(columns(T), kept)
    (said,) = (x for x in mg.read_log(table, DRIVEN).remarks if "are missing" in x)
    assert f"after t = {T[419]:.9g} s and in 5 more places" in said
    assert not mg.read_log(table, DRIVEN).jump  # six of 4000 change no result


def test_rows_of_a_foreign_log_of_one_axis(tmp_path: Path) -> None:
    """Samples counted instead of stamped: `rate` in the mapping."""
    mapping = tmp_path / "m.yaml"
    mapping.write_text(AXIS_MAPPING.replace("time: {column: stamp, unit: ms}", "rate: 200"))
    table = {"pos": 100 * np.sin(2 * T) + 40 * np.sin(5.1 * T), "load": 500 * np.cos(T)}
    table |= {"vin": 7.0 + 0.1 * np.sin(T), "temp": 30 + 0.1 * T}
    kept = without(0.04, 2)
    few = write_csv(tmp_path / "few.csv", {name: x[kept] for name, x in table.items()})
    whole = write_csv(tmp_path / "whole.csv", table)
    assert "are missing" in mg.read_log(few, AXIS, mapping=mapping).jump
    assert not any("missing" in x for x in mg.read_log(whole, AXIS, mapping=mapping).remarks)


@pytest.mark.parametrize("seed", range(3))
def test_what_else_motions_and_readings_have_is_no_loss(seed: int) -> None:
    random, count = np.random.default_rng(seed), len(T)
    wander = T + 1e-3 * random.normal(size=count)  # read a fifth of a period early or late
    late = np.maximum.accumulate(np.where(random.uniform(size=count) < 0.9, np.arange(count), 0))
    shaken = columns(T)
    slips = shaken["q1"] + 0.01 * np.floor(2 * T + 0.2 * np.sin(40 * T))
    noisy = shaken["q1"] + 5e-3 * random.standard_t(3, count)
    pulses = np.cumsum(np.where(random.uniform(size=count) < 0.02, random.normal(size=count), 0.0))
    cases = {
        "whole": columns(T),
        "uneven": columns(wander) | {"t": T},
        "late": {name: x if name == "t" else x[late] for name, x in columns(T).items()},
        "vibrating": shaken | {"q1": shaken["q1"] + 4e-3 * np.sin(2 * np.pi * 61 * T)},
        "slipping": shaken | {"q1": slips},
        "noisy": shaken | {"q1": noisy},
        "pushed": shaken | {"q1": np.cumsum(pulses) / np.abs(np.cumsum(pulses)).max()},
        "stamped": {name: x[without(0.05, seed)] for name, x in columns(T).items()},
        "coarse": rounded(columns(T), 9),
    }
    for what, table in cases.items():
        for bits in (12, 16, 20):
            found = mg.read_log(rounded(table, bits), DRIVEN)
            assert not any("are missing" in x for x in found.remarks), (what, bits)


def jogged(seed: int) -> np.ndarray:
    """Positions (N, 2) in counts of two joints that make short moves of least jerk, with rests between."""
    random, q = np.random.default_rng(seed), np.zeros((4000, 2))
    for j in range(2):
        at = 0
        while at < len(q) - 100:
            s = np.linspace(0.0, 1.0, int(random.integers(8, 60)) + 1)[1:]
            move = random.uniform(-3000.0, 3000.0) * (10 * s**3 - 15 * s**4 + 6 * s**5)
            q[at : at + len(s), j] += move
            q[at + len(s) :, j] += move[-1]
            at += len(s) + int(random.integers(0, 40))
    return np.round(q)


@pytest.mark.parametrize("seed", range(12))
def test_short_moves_are_no_missing_rows(seed: int) -> None:
    """They begin and end within samples: a step is larger than those around, not than both next to it."""
    q = jogged(seed)
    _, _, share = missing_rows(q, USUAL)
    assert share == 0.0
    _, _, share = missing_rows(q[np.random.default_rng(seed).random(len(q)) >= 0.05], USUAL)
    assert RESTORED < share < 0.07
