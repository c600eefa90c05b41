"""A log in memory is read as the file with the same numbers is, and refused with the same words."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pyarrow
import pytest

from modelgen.dataset import ColumnTable, Record, Stream, check_separate, named, parse, read, read_columns
from modelgen.description import Arm, loads
from modelgen.effects import known_effects
from modelgen.errors import InputError

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    joints:
      - {name: a, alpha: 0, d: 0, r: 0, drive: {type: direct, ratio: 100, torque_constant: 0.05}}
      - {name: b, alpha: pi/2, d: 0.3, r: 0, drive: {type: direct, ratio: 80, torque_constant: 0.05}}
"""


@pytest.fixture(scope="module")
def arm() -> Arm:
    return loads(ARM, "arms.yaml", known_effects())["two"]


def columns(seed: int = 1, count: int = 400) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    t = np.arange(count) * 0.01
    return {
        "t": t,
        "q1": np.sin(t + seed),
        "q2": 0.5 * np.cos(2 * t),
        "i1": rng.normal(size=count),
        "i2": rng.normal(size=count),
    }


def file(folder: Path, table: dict[str, np.ndarray], name: str = "log.csv") -> str:
    rows = np.stack(list(table.values()), axis=1)
    text = io.StringIO()
    np.savetxt(text, rows, delimiter=",", fmt="%.17g", header=",".join(table), comments="")
    (folder / name).write_text(text.getvalue(), encoding="utf-8")
    return str(folder / name)


class LikePolars:
    """Names as a list, columns that are no arrays: what polars gives."""

    class Series:
        def __init__(self, values: np.ndarray) -> None:
            self._values = values

        def __len__(self) -> int:
            return len(self._values)

        def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
            return np.asarray(self._values, dtype=dtype)

    def __init__(self, table: dict[str, np.ndarray]) -> None:
        self._table = table
        self.columns = list(table)

    def __getitem__(self, name: str) -> Series:
        return self.Series(self._table[name])


def fields(table: dict[str, np.ndarray]) -> np.ndarray:
    return np.rec.fromarrays(list(table.values()), names=list(table))


KINDS = {
    "dict": dict,
    "lists": lambda table: {name: values.tolist() for name, values in table.items()},
    "pandas": pandas.DataFrame,
    "pyarrow": pyarrow.table,
    "polars": LikePolars,
    "fields": fields,
}


def same(one: Record, other: Record) -> None:
    for name in ("t", "q", "motor", "input", "gain"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    assert (one.effort_unit, one.hold, one.held) == (other.effort_unit, other.hold, other.held)


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_is_read_as_its_file(kind: str, arm: Arm, tmp_path: Path) -> None:
    table = columns()
    found = read(named(KINDS[kind](table), "train[0]"), arm)
    assert found.name == "train[0]"
    same(found, read(file(tmp_path, table), arm))


def test_a_mapping_file_renames_and_scales_the_columns_of_a_table(arm: Arm, tmp_path: Path) -> None:
    table = columns()
    foreign = {"ms": 1e3 * table["t"], "A": table["q1"], "B": np.degrees(table["q2"])}
    foreign |= {"ia": table["i1"], "ib": table["i2"]}
    mapping = tmp_path / "mapping.yaml"
    mapping.write_text(
        "schema: 1\ntime: {column: ms, unit: ms}\njoints:\n"
        "  - {position: {column: A, unit: rad}, effort: {column: ia, unit: A}}\n"
        "  - {position: {column: B, unit: deg}, effort: {column: ib, unit: A}}\n",
        encoding="utf-8",
    )
    same(read(named(foreign, "log"), arm, mapping), read(file(tmp_path, foreign), arm, mapping))


def test_uneven_time_is_resampled_as_in_a_file(arm: Arm, tmp_path: Path) -> None:
    table = columns()
    t = table["t"] + np.random.default_rng(2).uniform(-0.001, 0.001, len(table["t"]))
    table |= {"t": t, "q1": np.sin(t + 1), "q2": 0.5 * np.cos(2 * t)}
    found = read(named(table, "log"), arm)
    assert any("resampled" in remark for remark in found.remarks)
    same(found, read(file(tmp_path, table), arm))


def spoilt(table: dict[str, Any], how: str) -> dict[str, Any]:
    if how == "missing":
        del table["q2"]
    elif how == "no time":
        table["time"] = table.pop("t")
    elif how == "not finite":
        table["i2"][7] = np.nan
    elif how == "backwards":
        table["t"][9] = table["t"][7]
    elif how == "constant":
        table["q1"][:] = 1.0
    elif how == "short":
        table = {name: values[:3] for name, values in table.items()}
    elif how == "gap":
        table["t"][200:] += 5.0
    return table


@pytest.mark.parametrize("how", ["missing", "no time", "not finite", "backwards", "constant", "short", "gap"])
def test_a_table_is_refused_with_the_words_for_its_file(how: str, arm: Arm, tmp_path: Path) -> None:
    table = spoilt(columns(), how)
    path = file(tmp_path, table)
    with pytest.raises(InputError) as of_file:
        read(path, arm)
    with pytest.raises(InputError) as of_table:
        read(named(table, "train[0]"), arm)
    assert str(of_table.value).replace("train[0]", path) == str(of_file.value)


@pytest.mark.parametrize(
    ("log", "words"),
    [
        (3.0, "train[0]: found float, expected a path, FILE@t0:t1, a record or a table of columns"),
        (np.zeros((3, 2)), "train[0]: found ndarray, expected a path"),
        ({}, "train[0]: the table has no columns"),
        (columns() | {"q1": np.zeros(3)}, "differ in length"),
        (columns() | {"i1": ["a"] * 400}, "in the column i1, expected numbers"),
        (columns() | {"i1": np.zeros((400, 2))}, "found 2 dimensions in the column i1"),
        (
            columns() | {"t": np.arange(400).astype(complex)},
            "found complex128 in the column t, expected numbers",
        ),
    ],
)
def test_what_is_no_table_of_numbers_is_refused(log: Any, words: str, arm: Arm) -> None:
    with pytest.raises(InputError) as refused:
        read(named(log, "train[0]"), arm)
    assert words in str(refused.value)


def test_missing_values_of_every_library_are_not_finite(arm: Arm) -> None:
    table = columns()
    holes = [None, *table["i1"].tolist()[1:]]
    for log in (
        pandas.DataFrame(table | {"i1": pandas.array(holes, dtype="Float64")}),
        pyarrow.table(table | {"i1": holes}),
        table | {"i1": holes},
        table | {"i1": np.ma.array(table["i1"], mask=[True] + [False] * 399)},
    ):
        with pytest.raises(InputError, match="found nan in the column i1 at t = 0 s"):
            read(named(log, "log"), arm)


def test_a_record_is_taken_as_it_is_and_refused_for_another_arm(arm: Arm) -> None:
    record = read(named(columns(), "log"), arm)
    assert read(record, arm) is record
    other = loads(ARM.replace("name: b", "name: c"), "arms.yaml", known_effects())["two"]
    with pytest.raises(InputError, match=r"log: found a record of 2 coordinates \(a, b\)"):
        read(record, other)
    with pytest.raises(InputError, match="expected a log as it was recorded"):
        read_columns(record, ["q1"])


def test_tables_with_the_same_numbers_overlap_whatever_they_are_made_of(arm: Arm) -> None:
    one, two = named(columns(), "train"), named(pandas.DataFrame(columns()), "test")
    with pytest.raises(InputError, match="--train train and --test test share samples"):
        check_separate([one], [two])
    with pytest.raises(InputError, match="share samples"):
        check_separate([read(one, arm)], [read(two, arm)])
    check_separate([one], [named(columns(2), "test")])
    assert isinstance(one, ColumnTable)
    assert parse(one).content() == parse(two).content()


def test_a_streamed_table_gives_the_blocks_of_its_file(arm: Arm, tmp_path: Path) -> None:
    table = columns(count=3000)
    of_table = list(Stream(named(table, "log"), arm, block=512))
    of_file = list(Stream(file(tmp_path, table), arm, block=512))
    assert len(of_table) == len(of_file) > 1
    for one, other in zip(of_table, of_file, strict=True):
        assert np.array_equal(one.record.q, other.record.q)


def test_a_table_imports_no_library_of_tables() -> None:
    code = (
        "import sys; from modelgen.dataset import named; named({'t': [0.0]}, 'log');"
        "print([name for name in ('pandas', 'polars', 'pyarrow', 'xarray') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def dated(kind: str, t: np.ndarray) -> Any:
    """Times (N,) [s] as dates or times of day from a moment of 2026 on."""
    ns = np.rint(1e9 * t).astype(np.int64)
    stamps = np.datetime64("2026-03-29T00:59:58", "ns") + ns.astype("timedelta64[ns]")
    return {
        "numpy": stamps,
        "microseconds": stamps.astype("datetime64[us]"),
        "timedelta": ns.astype("timedelta64[ns]"),
        "pandas": pandas.Series(stamps),
        "zone": pandas.Series(stamps).dt.tz_localize("UTC").dt.tz_convert("Europe/Paris"),  # its clock jumps
        "index": pandas.DatetimeIndex(stamps).tz_localize("UTC").tz_convert("Europe/Paris"),
        "python": np.array([x.to_pydatetime() for x in pandas.Series(stamps)], dtype=object),
        "python, zone": [
            x.to_pydatetime() for x in pandas.Series(stamps).dt.tz_localize("UTC").dt.tz_convert("Asia/Tokyo")
        ],
        "pyarrow": pyarrow.chunked_array([pyarrow.array(stamps)]),
        "pyarrow, zone": pyarrow.array(stamps, type=pyarrow.timestamp("us", tz="Europe/Paris")),
    }[kind]


DATES = ("numpy", "microseconds", "timedelta", "pandas", "zone", "index", "python", "python, zone", "pyarrow")


@pytest.mark.parametrize("kind", [*DATES, "pyarrow, zone"])
def test_dates_are_seconds_from_the_first_one(kind: str, arm: Arm) -> None:
    table = columns()
    plain = read(named(table, "log"), arm)
    found = read(named({**table, "t": dated(kind, table["t"])}, "log"), arm)
    assert found.t == pytest.approx(plain.t - plain.t[0], abs=1e-9)
    assert np.array_equal(found.q, plain.q)
    assert any("t is a date or time: seconds are counted from the first one" in x for x in found.remarks)


def test_a_clock_that_was_put_back_is_refused(arm: Arm) -> None:
    """Local times without their zone on the night that has an hour twice."""
    table = columns()
    stamps = dated("numpy", table["t"])
    stamps[200:] -= np.timedelta64(1, "h")
    with pytest.raises(InputError, match=r"time runs backwards after t = 1\.99 s"):
        read(named({**table, "t": stamps}, "log"), arm)
    stamps[200:] += np.timedelta64(2, "h")
    with pytest.raises(InputError, match=r"found a gap of 3600 s after t = 1\.99 s"):
        read(named({**table, "t": stamps}, "log"), arm)


def test_a_blank_date_is_refused(arm: Arm) -> None:
    table = columns()
    stamps = dated("numpy", table["t"])
    stamps[7] = np.datetime64("NaT")
    with pytest.raises(InputError, match="found nan in the column t"):
        read(named({**table, "t": stamps}, "log"), arm)


def test_a_time_with_its_unit_in_its_name_is_asked_about(arm: Arm) -> None:
    table = columns()
    table["t [s]"] = table.pop("t")
    with pytest.raises(InputError, match=r"did you mean the column 't \[s\]'"):
        read(named(table, "log"), arm)


@pytest.mark.parametrize("index", ["t", "dates", "times"])
def test_the_index_of_a_frame_is_the_time_where_it_is_one(index: str, arm: Arm) -> None:
    frame = pandas.DataFrame(columns())
    spans = pandas.to_timedelta(frame["t"], unit="s")
    frame = frame.set_index(
        {"t": frame["t"], "dates": pandas.Timestamp("2026-03-01") + spans}.get(index, spans)
    )
    frame = frame.drop(columns="t")
    frame.index.name = "t" if index == "t" else None
    record = read(named(frame, "log"), arm)
    assert record.t == pytest.approx(columns()["t"], abs=1e-9)
    assert "t is the table's index" in record.remarks
    with pytest.raises(InputError, match=r"the column t \[s\] is missing"):
        read(named(frame.reset_index(drop=True), "log"), arm)
