"""Channels with instants of their own: an effort is used where it was read, positions are interpolated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas
import pytest

from modelgen.dataset import Record, read
from modelgen.dataset.inspection import inspect
from modelgen.dataset.reading.column_table import ColumnTable
from modelgen.description import loads
from modelgen.errors import InputError

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    joints:
      - {name: hip, drive: {type: direct, ratio: 50, torque_constant: 0.1}}
"""
)["one"]
MAPPING = """
schema: 1
time: {{column: t, unit: s}}
hold: instant
joints: [{{position: {{column: angle, unit: rad{wrap}}}, effort: {{column: current, unit: A}}}}]
"""
END = 12.0


def position(t: np.ndarray) -> np.ndarray:
    return np.asarray(0.8 * np.cos(2.0 * t))


def effort(t: np.ndarray) -> np.ndarray:
    """It jumps where the joint turns round, as dry friction does."""
    return np.asarray(1.5 * np.sin(3.0 * t) - 0.4 * np.sign(np.sin(2.0 * t)))


def in_turn(
    places: np.ndarray, efforts: np.ndarray, names: tuple[str, str] = ("q1", "i1"), digits: int = 9
) -> dict[str, np.ndarray]:
    """Columns of positions at some instants (N,) and efforts at others (M,), blank elsewhere."""
    t = np.unique(np.concatenate([places, efforts]))
    columns = {"t": t}
    for name, own, law in zip(names, (places, efforts), (position, effort), strict=True):
        columns[name] = np.where(np.isin(t, own), np.round(law(t), digits), np.nan)
    return columns


def at(rate: float, later: float = 0.0) -> np.ndarray:
    return np.round(np.arange(later, END, 1.0 / rate), 7)


def from_csv(folder: Path, columns: dict[str, np.ndarray], part: str = "") -> str:
    pandas.DataFrame(columns).to_csv(folder / "a.csv", index=False)
    return f"{folder / 'a.csv'}{part}"


def logged(kind: str, folder: Path, columns: dict[str, np.ndarray]) -> Record:
    if kind == "csv":
        return read(from_csv(folder, columns), ARM)
    if kind == "frame":
        return read(ColumnTable(pandas.DataFrame(columns), "a frame"), ARM)
    pytest.importorskip("pyarrow")
    pandas.DataFrame(columns).to_parquet(folder / "a.parquet")
    return read(str(folder / "a.parquet"), ARM)


@pytest.mark.parametrize("kind", ["csv", "frame", "parquet"])
@pytest.mark.parametrize("rate", [20.0, 100.0, 250.0])
def test_efforts_are_those_that_were_read(kind: str, rate: float, tmp_path: Path) -> None:
    record = logged(kind, tmp_path, in_turn(at(250.0), at(rate, 0.0013)))
    assert 1.0 / record.step == pytest.approx(rate, rel=1e-6)
    assert record.input is not None
    assert record.input[:, 0] == pytest.approx(effort(record.t), abs=1e-8)
    assert record.q[:, 0] == pytest.approx(position(record.t), abs=2e-7)
    assert record.remarks[-1] == "rows come in turn: q1 interpolated by splines at the instants of i1"


@pytest.mark.parametrize("kind", ["csv", "frame", "parquet"])
def test_a_few_blank_cells_of_a_short_log_are_no_rows_in_turn(kind: str, tmp_path: Path) -> None:
    """Nine of 36 are a quarter, and still readings that are missing, which nobody interpolates."""
    t = at(50.0)[:36]
    columns = {"t": t, "q1": position(t), "i1": effort(t)}
    columns["i1"][9:27:2] = np.nan
    with pytest.raises(InputError, match=r"found (nan|'nothing') in the column i1"):
        logged(kind, tmp_path, columns)


@pytest.mark.parametrize("kind", ["csv", "frame", "parquet"])
def test_a_channel_may_begin_after_thousands_of_rows(kind: str, tmp_path: Path) -> None:
    """Parquet is judged by its first rows; one that never begins is said by its name."""
    t = np.arange(6000) / 500.0
    columns = {"t": t, "q1": position(t), "i1": np.where(t < 10.0, np.nan, effort(t))}
    record = logged(kind, tmp_path, columns)
    assert (record.t[0], len(record.t)) == (pytest.approx(10.0), 1000)
    assert "5000 rows are left out, for they are without i1" in record.remarks[-1]
    with pytest.raises(InputError, match="the column i1 holds no readings"):
        logged(kind, tmp_path, columns | {"i1": np.full(len(t), np.nan)})
    spare = columns | {"i1": effort(t), "spare": np.full(len(t), np.nan)}
    assert not logged(kind, tmp_path, spare).remarks


def test_coarse_positions_and_slower_ones_keep_their_instants(tmp_path: Path) -> None:
    for columns in (in_turn(at(250.0), at(250.0, 0.002), digits=3), in_turn(at(100.0), at(1000.0, 0.0005))):
        record = read(from_csv(tmp_path, columns), ARM)
        there = columns["t"][~np.isnan(columns["q1"])]
        assert np.isin(np.round(record.t, 7), there).all()
        assert record.q[:, 0] == pytest.approx(np.round(position(record.t), 3), abs=6e-4)
        assert "i1 interpolated by straight lines at the instants of q1" in record.remarks[-1]


def test_a_part_has_the_rate_of_its_channel(tmp_path: Path) -> None:
    log = from_csv(tmp_path, in_turn(at(250.0), at(100.0, 0.0013)), "@2:8")
    assert 1.0 / read(log, ARM).step == pytest.approx(100.0, rel=1e-6)


def test_an_inspection_counts_what_was_read_most_seldom(tmp_path: Path) -> None:
    log = from_csv(tmp_path, in_turn(at(250.0), at(100.0, 0.0013)))
    assert inspect(log).rate == pytest.approx(100.0)
    assert inspect(log).samples == inspect(log, ARM).samples


def mapped(folder: Path, wrap: str, columns: dict[str, np.ndarray]) -> Record:
    (folder / "mapping.yaml").write_text(MAPPING.format(wrap=wrap), encoding="utf-8")
    return read(from_csv(folder, columns), ARM, folder / "mapping.yaml")


def test_an_angle_that_begins_anew_after_a_turn_is_not_interpolated(tmp_path: Path) -> None:
    """Half a turn is between its two readings about a whole one."""
    columns = in_turn(at(250.0), at(100.0, 0.0013), ("angle", "current"))
    columns["angle"] = np.mod(6.0 * columns["angle"], 2.0 * np.pi)
    record = mapped(tmp_path, ", wrap: 2*pi", columns)
    turns = record.q[:, 0] - 6.0 * position(record.t)
    assert turns == pytest.approx(turns[0], abs=1e-6)
    assert 1.0 / record.step == pytest.approx(250.0)
    columns["other"] = np.where(np.isnan(columns["angle"]), np.cos(columns["t"]), np.nan)
    two = loads(
        """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    joints: [{name: a}, {name: b, d: 0.1}]
"""
    )["two"]
    mapping = tmp_path / "two.yaml"
    mapping.write_text(
        """
schema: 1
time: {column: t, unit: s}
joints:
  - {position: {column: angle, unit: rad, wrap: 2*pi}}
  - {position: {column: other, unit: rad, wrap: 2*pi}}
""",
        encoding="utf-8",
    )
    with pytest.raises(InputError, match=r"the column other begins anew after a turn .* log it with them"):
        read(from_csv(tmp_path, columns), two, mapping)


def test_a_channel_that_pauses_is_refused(tmp_path: Path) -> None:
    efforts = at(100.0, 0.0013)
    columns = in_turn(at(250.0), efforts[(efforts < 5.0) | (efforts > 5.4)])
    with pytest.raises(InputError, match=r"the column i1 is blank for 0\.4.* s after t = "):
        read(from_csv(tmp_path, columns), ARM)
