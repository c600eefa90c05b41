"""Tables as programs of all kinds write them: the right numbers, or a plain no with the key that decides."""

from __future__ import annotations

import os
import re
import threading
import tomllib
from collections.abc import Callable
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest

from modelgen.dataset import check_separate, read, read_columns
from modelgen.dataset.inspection import skeleton
from modelgen.dataset.inspection.channels import inspect
from modelgen.description import loads
from modelgen.errors import InputError
from modelgen.extras import DASK, LOGS

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    joints:
      - name: hip
        limits: {position: [-2, 2]}
        drive: {type: direct, ratio: 50, torque_constant: 0.1, current: 4}
"""
)["one"]
T = np.arange(360) / 120.0
Q, EFFORT = 0.8 * np.cos(2.0 * T), 1.5 * np.sin(3.0 * T) - 0.2
ROWS = [(f"{t:.6f}", f"{q:.6f}", f"{i:.6f}") for t, q, i in zip(T, Q, EFFORT, strict=True)]
COMMAS = [tuple(cell.replace(".", ",") for cell in row) for row in ROWS]
MAPPING = """
schema: 1
{more}
joints: [{{position: {{column: q1, unit: rad}}, effort: {{column: i1, unit: {unit}}}}}]
"""


def table(header: str, rows: list[tuple[str, ...]], between: str = ",") -> str:
    return "\n".join([header, *(between.join(row) for row in rows)]) + "\n"


def file_of(folder: Path, text: str, encoding: str = "utf-8") -> str:
    path = folder / "a.csv"
    path.write_bytes(text.encode(encoding))
    return str(path)


def mapping_of(folder: Path, more: str = "", unit: str = "A") -> Path:
    path = folder / "mapping.yaml"
    path.write_text(MAPPING.format(more=more, unit=unit), encoding="utf-8")
    return path


CERTAIN = {
    "decimal commas between semicolons": (table("t;q1;i1", COMMAS, ";"), "decimal sign is the comma"),
    "decimal commas between tabs": (table("t\tq1\ti1", COMMAS, "\t"), "decimal sign is the comma"),
    "a line that says the separator": ("sep=;\n" + table("t;q1;i1", COMMAS, ";"), "decimal sign"),
    "quoted decimal commas between commas": (
        table('"t","q1","i1"', [tuple(f'"{cell}"' for cell in row) for row in COMMAS]),
        "decimal sign is the comma",
    ),
    "a row of units": (table("t,q1,i1", [("s", "rad", "A"), *ROWS]), "line 2 holds units: s, rad, A"),
    "a preamble": (
        "Instrument,XY 100\nRate,120\nDate,2024-05-01\n\n" + table("t,q1,i1", ROWS),
        "3 lines before the header are passed over",
    ),
    "names with units": (table("t [s],q1 (rad),i1 [A]", ROWS), "names of columns are read without the units"),
    "names in capitals": (table("T,Q1,I1", ROWS), "small letters"),
    "a column without a name": (
        table(",t,q1,i1", [(str(k), *row) for k, row in enumerate(ROWS)]),
        "column 1 has no name",
    ),
    "a separator at the end of rows": (table("t,q1,i1", [(*row, "") for row in ROWS]), ""),
    "a last line that is cut off": (table("t,q1,i1", ROWS) + "3.0,0.7", "line 362, the last, is cut off"),
    "a column of words": (table("t,q1,state,i1", [(t, q, "on, off"[:2], i) for t, q, i in ROWS]), ""),
    "blanks": (table("t q1 i1", ROWS, "  "), ""),
}


@pytest.mark.parametrize("kind", CERTAIN)
def test_what_is_certain_is_read(kind: str, tmp_path: Path) -> None:
    text, remark = CERTAIN[kind]
    record = read(file_of(tmp_path, text), ARM)
    assert record.t == pytest.approx(T, abs=1e-6)
    assert record.q[:, 0] == pytest.approx(Q, abs=1e-6)
    assert record.input[:, 0] == pytest.approx(EFFORT, abs=1e-6)
    assert remark in "; ".join(record.remarks)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1"])
def test_texts_of_every_encoding(encoding: str, tmp_path: Path) -> None:
    rows = [(*row, "x") for row in ROWS]
    record = read(file_of(tmp_path, table("t,q1,i1,Öl °C", rows), encoding), ARM)
    assert record.input[:, 0] == pytest.approx(EFFORT, abs=1e-6)


@pytest.mark.parametrize(
    ("header", "unit"),
    [("t [ms],q1 [rad],i1 [A]", "ms"), ("t [s],q1 [deg],i1 [A]", "deg"), ("T,Q1,I1\ns,rad,mA", "mA")],
)
def test_another_unit_in_or_below_the_names_is_refused(header: str, unit: str, tmp_path: Path) -> None:
    file = file_of(tmp_path, table(header, ROWS))
    with pytest.raises(InputError, match=f"the file says that .* is in {unit}, expected"):
        read(file, ARM)
    written = skeleton(file, ARM)
    assert f"unit: {unit}" in written
    mapping = tmp_path / "mapping.yaml"
    mapping.write_text(written, encoding="utf-8")
    if unit != "ms":
        assert len(read(file, ARM, mapping).t) == len(T)


def test_units_that_a_parquet_file_says_count(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    said = {"t": "s", "q1": "deg", "i1": "A"}
    schema = pyarrow.schema(
        [pyarrow.field(k, pyarrow.float64(), metadata={"unit": u}) for k, u in said.items()]
    )
    file = str(tmp_path / "a.parquet")
    parquet.write_table(pyarrow.table({"t": T, "q1": Q, "i1": EFFORT}, schema=schema), file)
    with pytest.raises(InputError, match="the file says that q1 is in deg, expected rad"):
        read(file, ARM)


def test_rows_in_turn_whose_stamps_come_in_bursts_are_refused(tmp_path: Path) -> None:
    burst = [0.1 * (k // 8 + 1) + 1e-6 * (k % 8) for k in range(2 * len(ROWS))]
    rows = [
        (f"{burst[2 * k + j]:.6f}", *((q, "") if j == 0 else ("", i)))
        for k, (_, q, i) in enumerate(ROWS)
        for j in (0, 1)
    ]
    with pytest.raises(InputError, match=r"the stamps of the column q1 come in bursts, most 2e-06 s apart"):
        read(file_of(tmp_path, table("t,q1,i1", rows)), ARM)


def test_a_time_of_day_is_refused_with_what_is_read(tmp_path: Path) -> None:
    rows = [(f"12:00:{k // 60:02}.{k % 60:02}", *row[1:]) for k, row in enumerate(ROWS)]
    with pytest.raises(InputError, match=r"a\.csv:2:1: found '12:00:00\.00' .* a date and time such as 2026"):
        read(file_of(tmp_path, table("t,q1,i1", rows)), ARM)


def test_a_table_without_a_header_takes_its_names_from_the_mapping(tmp_path: Path) -> None:
    file = file_of(tmp_path, table(",".join(ROWS[0]), ROWS[1:]))
    with pytest.raises(InputError, match=r"found numbers in the first line.*`columns: \[t, q1, i1\]`"):
        read(file, ARM)
    record = read(file, ARM, mapping_of(tmp_path, "columns: [t, q1, i1]"))
    assert record.q[:, 0] == pytest.approx(Q, abs=1e-6)


UNCERTAIN = {
    "decimal commas between commas": (
        table("t,q1,i1", [(str(k), *row[1:]) for k, row in enumerate(COMMAS)]),
        ":2:1: found 5 cells, expected 3.*`columns:",
    ),
    "row numbers without a name": (
        table("t,q1,i1", [(str(k), *row) for k, row in enumerate(ROWS)]),
        ":2:1: found 4 cells, expected 3: t, q1, i1.*`columns:",
    ),
    "a row with a cell more": (
        table("t,q1,i1", [*ROWS[:200], (*ROWS[200], "7"), *ROWS[201:]]),
        ":202:1: found 4 cells, expected 3",
    ),
    "a row with a cell less": (
        table("t,q1,i1", [*ROWS[:200], ROWS[200][:2], *ROWS[201:]]),
        ":202:1: found 2 cells, expected 3",
    ),
    "two decimal signs": (
        table("t;q1;i1", [(t, q.replace(".", ","), i) for t, q, i in ROWS], ";"),
        "`decimal:",
    ),
    "commas that may be thousands": (
        table("t;q1;i1", [(str(k), f"{1 + k},{k % 10}00", f"{2 + k % 5},125") for k in range(1, 90)], ";"),
        "a decimal comma, or thousands?.*`decimal:",
    ),
    "units that are not those of the contract": (
        table("t,q1,i1", [("s", "[deg]", "A"), *ROWS]),
        "the file says that q1 is in deg, expected rad",
    ),
    "one blank cell": (
        table("t,q1,i1", [*ROWS[:200], (ROWS[200][0], "", ROWS[200][2]), *ROWS[201:]]),
        ":202:10: found 'nothing' in the column q1",
    ),
}


@pytest.mark.parametrize("kind", UNCERTAIN)
def test_what_is_uncertain_is_refused_with_the_key_that_decides(kind: str, tmp_path: Path) -> None:
    text, message = UNCERTAIN[kind]
    with pytest.raises(InputError, match=message):
        read(file_of(tmp_path, text), ARM)


def test_the_mapping_decides_between_decimal_signs(tmp_path: Path) -> None:
    rows = [(f"{k}", f"1,{k % 900 + 100}", f"2,{k % 7 + 1}25") for k in range(120)]
    file = file_of(tmp_path, table("t;q1;i1", rows, ";"))
    more = "decimal: ','\ndelimiter: ';'\ntime: {unit: ms}"
    assert read(file, ARM, mapping_of(tmp_path, more)).q[5, 0] == pytest.approx(1.105)


def test_channels_in_turn_keep_their_own_instants(tmp_path: Path) -> None:
    later = T + 0.003
    rows = []
    for k in range(len(T)):
        rows.append((ROWS[k][0], ROWS[k][1], ""))
        rows.append((f"{later[k]:.6f}", "", f"{1.5 * np.sin(3 * later[k]) - 0.2:.8f}"))
    record = read(file_of(tmp_path, table("t,q1,i1", rows)), ARM)
    assert record.q[:, 0] == pytest.approx(0.8 * np.cos(2 * record.t), abs=1e-5)
    # Straight lines: an eighth of the square of the step times the curvature.
    assert record.input[:, 0] == pytest.approx(1.5 * np.sin(3 * record.t) - 0.2, abs=13.5 / 8 / 120**2 * 1.1)
    assert "rows come in turn: q1" in record.remarks[-1]
    hole = [row for row in rows if not (row[1] == "" and 1.0 < float(row[0]) < 1.4)]
    with pytest.raises(InputError, match=r"the column i1 is blank for 0.4.* s after t = "):
        read(file_of(tmp_path, table("t,q1,i1", hole)), ARM)


@pytest.mark.parametrize("there", [slice(3, None), slice(60, None), slice(180, None), slice(None, 200)])
def test_a_channel_that_begins_late_or_ends_early_leaves_the_others_rows_out(
    there: slice, tmp_path: Path
) -> None:
    kept = range(len(ROWS))[there]
    rows = [(row[0], row[1], row[2] if k in kept else "") for k, row in enumerate(ROWS)]
    record = read(file_of(tmp_path, table("t,q1,i1", rows)), ARM)
    assert len(record.t) == len(kept)
    assert record.q[:, 0] == pytest.approx(Q[there], abs=1e-5)
    assert record.input[:, 0] == pytest.approx(EFFORT[there], abs=1e-5)
    left = len(ROWS) - len(kept)
    assert f"{left} rows are left out, for they are without i1" in record.remarks[-1]


def test_unsigned_readings_are_found_and_the_mapping_undoes_them(tmp_path: Path) -> None:
    raw = np.rint(100 * EFFORT).astype(int) % (1 << 16)
    rows = [(t, q, str(i)) for (t, q, _), i in zip(ROWS, raw, strict=True)]
    file = file_of(tmp_path, table("t,q1,i1", rows))
    message = r"the column i1 runs from \d+ to 655\d\d .* -1 is 65535; declare `bits: 16`"
    with pytest.raises(InputError, match=message):
        read(file, ARM)
    assert any(re.search(message, remark) for remark in inspect(file).remarks)
    mapping = mapping_of(tmp_path)
    with pytest.raises(InputError, match=message):
        read(file, ARM, mapping)
    mapping.write_text(mapping.read_text().replace("unit: A", "unit: A, bits: 16, scale: 0.01"))
    assert read(file, ARM, mapping).input[:, 0] == pytest.approx(EFFORT, abs=0.006)


def test_an_effort_beyond_its_limit_is_no_measurement(tmp_path: Path) -> None:
    one = [*ROWS[:99], (*ROWS[99][:2], "800"), *ROWS[100:]]
    with pytest.raises(
        InputError, match=r"i1 is 800 A at t = 0\.825\d* s, the limit of joint hip is 4 A; an impossible"
    ):
        read(file_of(tmp_path, table("t,q1,i1", one)), ARM)
    milli = [(t, q, f"{1000 * float(i):.3f}") for t, q, i in ROWS]
    with pytest.raises(InputError, match="these look like milliamperes; declare `unit: mA`"):
        read(file_of(tmp_path, table("t,q1,i1", milli)), ARM)
    double = [(t, q, f"{3 * float(i):.3f}") for t, q, i in ROWS]
    assert "the limit is 4 A" in read(file_of(tmp_path, table("t,q1,i1", double)), ARM).remarks[-1]


def test_a_pipe_is_read_to_its_end(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    text = table("t,q1,i1", ROWS * 3)

    def write() -> None:
        pipe.write_text(text, encoding="utf-8")

    writer = threading.Thread(target=write)
    writer.start()
    found = read_columns(str(pipe), ["q1"])
    writer.join()
    assert len(found["q1"]) == 3 * len(ROWS)
    # A pipe gives its bytes once; the check of what is shared reads them too.
    other = tmp_path / "b.csv"
    other.write_text(table("t,q1,i1", ROWS), encoding="utf-8")
    check_separate([str(pipe)], [str(other)])
    assert len(read_columns(str(pipe), ["q1"])["q1"]) == 3 * len(ROWS)


def test_a_spreadsheet_is_exported_first(tmp_path: Path) -> None:
    (tmp_path / "a.xlsx").write_bytes(b"PK")
    with pytest.raises(InputError, match=re.escape("'.xlsx'") + ".*save the sheet as CSV"):
        read(str(tmp_path / "a.xlsx"), ARM)


@pytest.mark.parametrize("kind", ["date in us", "date in ns", "span in us", "integer in us"])
def test_times_of_every_type_in_parquet(kind: str, tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    start = datetime(2025, 3, 4, 5, 6, 7, 89, tzinfo=UTC)
    if kind.startswith("span"):
        column = pyarrow.array([timedelta(seconds=5.0 + float(t)) for t in T], pyarrow.duration("us"))
    elif kind.startswith("date"):
        column = pyarrow.array(
            [start + timedelta(seconds=float(t)) for t in T], pyarrow.timestamp(kind[-2:], tz="UTC")
        )
    else:
        column = pyarrow.array([round(1e6 * (start.timestamp() + t)) for t in T], pyarrow.int64())
    file = tmp_path / "a.parquet"
    parquet.write_table(pyarrow.table({"t": column, "q1": Q, "i1": EFFORT}), file)
    whole = kind.startswith("integer")
    mapping = mapping_of(tmp_path, "time: {unit: us, relative: true}") if whole else None
    record = read(str(file), ARM, mapping)
    assert record.t == pytest.approx(T, abs=2e-6)
    assert record.q[:, 0] == pytest.approx(Q, abs=1e-4)


def test_what_stands_beside_modelgen_names_the_libraries_of_the_project() -> None:
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
    extras = project["project"]["optional-dependencies"]
    assert sorted(LOGS.values()) == sorted(extras["logs"])
    assert sorted(DASK.values()) == sorted(extras["dask"])


@pytest.mark.parametrize(
    ("date", "between"),
    [
        (lambda x: x.isoformat(timespec="microseconds"), ","),
        (lambda x: x.astimezone(timezone(timedelta(hours=5.5))).isoformat(sep=" "), ";"),
        (lambda x: x.strftime("%Y/%m/%d %H:%M:%S.%f"), ","),
        (lambda x: x.isoformat(timespec="microseconds").replace("+00:00", "Z"), "\t"),
    ],
)
def test_dates_are_times(tmp_path: Path, date: Callable[[datetime], str], between: str) -> None:
    """Over midnight, in any zone."""
    begin = datetime(2026, 2, 28, 23, 59, 59, 250000, tzinfo=UTC)
    dates = [date(begin + timedelta(seconds=float(row[0]))) for row in ROWS]
    rows = [(d, *row[1:]) for d, row in zip(dates, ROWS, strict=True)]
    found = read(file_of(tmp_path, table(between.join(("t", "q1", "i1")), rows, between)), ARM)
    np.testing.assert_allclose(found.t - found.t[0], T, atol=2e-6)
    np.testing.assert_allclose(found.q[:, 0], Q, atol=1e-6)
    assert found.begins == pytest.approx(begin.timestamp(), abs=1e-6)
    assert any("t holds dates" in remark for remark in found.remarks)


def test_a_date_that_is_none_is_refused_at_its_place(tmp_path: Path) -> None:
    begin = datetime(2026, 3, 1, tzinfo=UTC)
    rows = [((begin + timedelta(seconds=float(row[0]))).isoformat(), *row[1:]) for row in ROWS]
    rows[200] = ("2026-02-30T00:00:01", *rows[200][1:])
    path = file_of(tmp_path, table("t,q1,i1", rows))
    with pytest.raises(InputError, match=r"a.csv:202:1: found '2026-02-30T00:00:01' .* expected a date"):
        read(path, ARM)
