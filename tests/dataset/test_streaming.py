"""A log in blocks is the log as a whole."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dataset_support import DRIVEN, columns, times, write_csv

from modelgen.dataset import Settings, Stream, prepare, read
from modelgen.errors import InputError


def noisy(t: np.ndarray) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(3)
    table = columns(t)
    table["q1"] = np.round(table["q1"] * 4096) / 4096
    table["qm2"] = np.round(table["qm2"])
    # Rests: the first joint stands still now and then.
    table["q1"][(t % 7) < 1.5] = table["q1"][0]
    return table | {name: table[name] + rng.normal(0, 0.1, len(t)) for name in ("i1", "i2")}


@pytest.mark.parametrize("clock", ["even", "jitter", "uneven"])
def test_blocks_are_the_whole(clock: str, tmp_path: Path) -> None:
    t = times(60.0, 200.0)
    rng = np.random.default_rng(4)
    stamps = t + {"even": 0.0, "jitter": 0.001, "uneven": 0.004}[clock] * rng.uniform(0, 1, len(t))
    table = noisy(stamps)
    file = write_csv(tmp_path / "a.csv", table)
    settings = Settings(cutoff=8.0, rest_gate=0.02)
    whole = prepare(read(file, DRIVEN), settings)
    stream = Stream(file, DRIVEN, settings, block=1500)
    blocks = list(stream)
    assert len(blocks) == len(stream) > 5
    assert stream.samples == len(whole.time)
    assert np.concatenate([b.t for b in blocks]) == pytest.approx(whole.t, abs=1e-9)
    assert np.array_equal(np.concatenate([b.moving for b in blocks]), whole.moving)
    assert 0.2 < whole.moving[:, 0].mean() < 0.9
    for name in ("q", "dq", "ddq", "motor", "dmotor", "ddmotor", "input"):
        expected = whole.parallel(getattr(whole, name))
        found = np.concatenate([b.parallel(getattr(b, name)) for b in blocks])
        size = np.max(np.abs(expected), axis=0)
        assert np.max(np.abs(found - expected) / size) < 1e-9, name


def test_a_stream_refuses_what_read_refuses(tmp_path: Path) -> None:
    t = times(20.0, 200.0)
    table = columns(t)
    table["i1"][3000] = np.nan
    with pytest.raises(InputError, match=r"found nan in the column i1 at t = 15 s"):
        Stream(write_csv(tmp_path / "a.csv", table), DRIVEN)
    table["i1"][:] = 2.0
    with pytest.raises(InputError, match="the effort i1 is 2 in all 4000 samples"):
        Stream(write_csv(tmp_path / "b.csv", table), DRIVEN)


def parquet(path: Path, table: dict[str, np.ndarray]) -> str:
    pq = pytest.importorskip("pyarrow.parquet")
    pa = pytest.importorskip("pyarrow")
    pq.write_table(pa.table(table), path, row_group_size=700)
    return str(path)


def test_parquet_gives_the_blocks_of_csv_and_refuses_what_it_refuses(tmp_path: Path) -> None:
    """Only the time is read first: what is wrong in the other columns is found on the way."""
    t = times(20.0, 200.0)
    table = columns(t)
    settings = Settings(cutoff=8.0, rest_gate=0.02)
    one = list(Stream(write_csv(tmp_path / "a.csv", table), DRIVEN, settings, block=900))
    two = list(Stream(parquet(tmp_path / "a.parquet", table), DRIVEN, settings, block=900))
    assert len(one) == len(two) > 2
    for a, b in zip(one, two, strict=True):
        assert a.effort == pytest.approx(b.effort, rel=1e-9)
    table["i1"][3000] = np.nan
    stream = Stream(parquet(tmp_path / "b.parquet", table), DRIVEN, settings, block=900)
    with pytest.raises(InputError, match=r"found nan in the column i1 at t = 15 s"):
        list(stream)
    table["i1"][:] = 2.0
    stream = Stream(parquet(tmp_path / "c.parquet", table), DRIVEN, settings, block=900)
    with pytest.raises(InputError, match="the effort i1 is 2 in all 4000 samples"):
        list(stream)
    table["t"][100] = np.nan
    with pytest.raises(InputError, match="found nan in the column t"):
        Stream(parquet(tmp_path / "d.parquet", table), DRIVEN, settings)


def test_other_settings_need_no_other_pass(tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", columns(times(20.0, 200.0)))
    stream = Stream(file, DRIVEN, Settings(cutoff=8.0))
    other = stream.settled(Settings(cutoff=4.0))
    assert (stream.settings.cutoff, other.settings.cutoff) == (8.0, 4.0)
    assert other.overlap > stream.overlap
    assert other.settings == Stream(file, DRIVEN, Settings(cutoff=4.0)).settings
