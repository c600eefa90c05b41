"""Mapping files: names, scales, units, couplings, efforts, and every mistake with its place."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from dataset_support import AXIS, AXIS_LOG, AXIS_MAPPING, DRIVEN, FREE, T, counts_of, motion, write_csv

from modelgen.dataset import described, prepare, read
from modelgen.dataset.inspection.channels import inspect
from modelgen.dataset.mapping.files import load_mapping
from modelgen.dataset.mapping.formula import FormulaError, formula
from modelgen.dataset.mapping.schema import mapping_json_schema
from modelgen.dataset.objects import Wanted
from modelgen.dataset.reading.sources import open_source
from modelgen.description.document import parse
from modelgen.errors import InputError

Q, DQ, DDQ = motion(T)
DRIVEN_MAPPING = """
schema: 1
hold: previous
names: {turn: "motor/angle [deg]"}
joints:
  - position: {column: turn, unit: deg, side: motor}
    velocity: {column: speed, unit: rpm}
    effort: {column: cur, unit: mA}
  - position: {column: inc, unit: counts, side: motor, offset: 100}
    velocity: {column: w, unit: rad/s}
    effort: {column: tau, unit: N m}
"""
DRIVEN_LOG = {
    "t": T,
    "motor/angle [deg]": np.degrees(50 * Q[:, 0]),
    "speed": DQ[:, 0] * 30 / np.pi,
    "w": DQ[:, 1],
    "cur": 1e3 * np.cos(T),
    "inc": counts_of(Q[:, 1]) - 100,
    "tau": 5 * np.sin(T),
}


def written(folder: Path, text: str) -> Path:
    path = folder / "mapping.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_names_scales_offsets_and_formulas(tmp_path: Path) -> None:
    record = read(write_csv(tmp_path / "a.csv", AXIS_LOG), AXIS, written(tmp_path, AXIS_MAPPING))
    assert record.t == pytest.approx(T)
    assert record.q[:, 0] == pytest.approx(0.2 * np.cos(T), abs=1e-12)
    assert record.input[:, 0] == pytest.approx(AXIS_LOG["load"] / 885 * AXIS_LOG["vin"])
    assert record.temperature[:, 0] == pytest.approx(30 + T)
    assert record.effort_unit == ("V",)
    assert "the effort is a voltage [V]: back-EMF sits in the viscous friction" in record.remarks[0]


def test_units_sides_and_holds(tmp_path: Path) -> None:
    record = read(write_csv(tmp_path / "a.csv", DRIVEN_LOG), DRIVEN, written(tmp_path, DRIVEN_MAPPING))
    assert record.q == pytest.approx(Q)
    assert record.dq == pytest.approx(DQ)
    assert record.input[:, 0] == pytest.approx(np.cos(T))
    assert (record.input * record.gain)[:, 1] == pytest.approx(5 * np.sin(T))
    assert record.effort_unit == ("A", "N m")
    assert record.motor_side == (True, True)
    assert record.hold == pytest.approx(-1 / 400)


@pytest.mark.parametrize(("hold", "seconds"), [("instant", 0.0), ("0.004", 0.004), ("following", 0.0025)])
def test_the_hold_says_when_the_effort_was(hold: str, seconds: float, tmp_path: Path) -> None:
    mapping = written(tmp_path, DRIVEN_MAPPING.replace("hold: previous", f"hold: {hold}"))
    record = read(write_csv(tmp_path / "a.csv", DRIVEN_LOG), DRIVEN, mapping)
    assert record.hold == pytest.approx(seconds)
    assert record.held == (hold == "following")


def test_a_mapping_without_joints_says_the_rest_of_a_log_with_the_contracts_names(tmp_path: Path) -> None:
    log = {"t": 1e3 * T, "q1": Q[:, 0], "q2": Q[:, 1], "i1": np.cos(T), "i2": np.sin(T)}
    plain = read(write_csv(tmp_path / "plain.csv", log | {"t": T}), DRIVEN)
    text = "schema: 1\nhold: 0.004\ntime: {unit: ms}\n"
    record = read(write_csv(tmp_path / "a.csv", log), DRIVEN, written(tmp_path, text))
    assert record.t == pytest.approx(plain.t)
    assert record.q == pytest.approx(plain.q)
    assert record.input == pytest.approx(plain.input)
    assert (record.hold, record.hold_known) == (0.004, "mapping")
    # units in the names are checked as without a mapping; the stamps' is what the mapping says
    said = {
        f"{name} [{unit}]": log[name] for name, unit in zip(log, ("us", "deg", "rad", "A", "A"), strict=True)
    }
    with pytest.raises(InputError, match="the file says that q1 is in deg, expected rad"):
        read(write_csv(tmp_path / "said.csv", said), DRIVEN, written(tmp_path, text))
    with pytest.raises(InputError, match="the column i2 or tau2 is missing"):
        read(
            write_csv(tmp_path / "b.csv", {k: v for k, v in log.items() if k != "i2"}),
            DRIVEN,
            written(tmp_path, text),
        )
    # a file whose names are changed says its stamps' unit, and from when they count, as without a mapping
    alone = written(tmp_path, "schema: 1\nhold: instant\n")
    slow = {
        f"{name} [{'s' if name == 't' else 'rad' if name[0] == 'q' else 'A'}]": x for name, x in log.items()
    }
    slowly = read(write_csv(tmp_path / "slow.csv", slow), DRIVEN, alone)
    assert slowly.step == pytest.approx(1e3 * plain.step)
    start = datetime(2025, 3, 4, 5, 6, 7, tzinfo=UTC)
    lines = ["T,Q1,Q2,I1,I2"]
    for row in zip(*log.values(), strict=True):
        at = start + timedelta(milliseconds=float(row[0]))
        lines.append(",".join([at.isoformat(), *(f"{x:.9g}" for x in row[1:])]))
    (tmp_path / "dated.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    dated = [read(str(tmp_path / "dated.csv"), DRIVEN, mapping) for mapping in (None, alone)]
    assert [record.begins for record in dated] == [pytest.approx(start.timestamp())] * 2
    with pytest.raises(InputError, match="found no joints, expected them, or an arm too"):
        inspect(tmp_path / "a.csv", None, written(tmp_path, text))


def test_a_force_at_the_motor_is_divided_by_the_torque_constant(tmp_path: Path) -> None:
    text = DRIVEN_MAPPING.replace("{column: cur, unit: mA}", "{column: cur, unit: N mm, side: motor}")
    record = read(write_csv(tmp_path / "a.csv", DRIVEN_LOG), DRIVEN, written(tmp_path, text))
    assert record.input[:, 0] == pytest.approx(np.cos(T) / 0.1)
    assert (record.input * record.gain)[:, 0] == pytest.approx(np.cos(T))


COUPLED = """
schema: 1
joints:
  - {position: {column: a, unit: rad}, velocity: {column: da, unit: rad/s}, effort: {column: x, unit: N m}}
  - {position: {column: b, unit: rad}, velocity: {column: db, unit: rad/s}, effort: {column: y, unit: N m}}
coupling:
  matrix: [[40, 0], [24, 24]]
  joint_offset: [0, pi/2]
"""


def test_a_coupled_wrist_conserves_power(tmp_path: Path) -> None:
    coupling = np.array([[40.0, 0.0], [24.0, 24.0]])
    logged, rates = (Q - [0, np.pi / 2]) @ coupling.T, DQ @ coupling.T
    efforts = np.stack([np.cos(3 * T), np.sin(5 * T)], axis=1)
    table = {"t": T, "a": logged[:, 0], "b": logged[:, 1], "da": rates[:, 0], "db": rates[:, 1]}
    table |= {"x": efforts[:, 0], "y": efforts[:, 1]}
    record = read(write_csv(tmp_path / "a.csv", table), FREE, written(tmp_path, COUPLED))
    assert record.q == pytest.approx(Q)
    assert record.dq == pytest.approx(DQ)
    power = np.sum(record.input * record.dq, axis=1)
    assert power == pytest.approx(np.sum(efforts * rates, axis=1))


def test_resampling_to_a_rate_and_a_wider_gap(tmp_path: Path) -> None:
    keep = np.ones(len(T), dtype=bool)
    keep[600:640] = False
    table = {name: column[keep] for name, column in AXIS_LOG.items()}
    file = write_csv(tmp_path / "a.csv", table)
    with pytest.raises(InputError, match="found a gap"):
        read(file, AXIS, written(tmp_path, AXIS_MAPPING))
    text = AXIS_MAPPING.replace("unit: ms}", "unit: ms, resample: 50, largest_gap: 0.5}")
    record = read(file, AXIS, written(tmp_path, text))
    assert record.step == pytest.approx(0.02)
    assert record.q[:, 0] == pytest.approx(0.2 * np.cos(record.t), abs=2e-3)


def test_time_may_count_from_the_first_sample(tmp_path: Path) -> None:
    table = AXIS_LOG | {"stamp": (np.round(T * 1e9) + 1.7e18) / 1e6}
    text = AXIS_MAPPING.replace("unit: ms", "unit: ms, relative: true")
    record = read(write_csv(tmp_path / "a.csv", table) + "@1:3", AXIS, written(tmp_path, text))
    assert record.t[0] == pytest.approx(1.0, abs=1e-5)
    assert len(record.t) == 400
    assert record.begins == pytest.approx(1.7e9 + 1.0, abs=1e-3)


def test_a_sensor_that_starts_anew_is_made_continuous(tmp_path: Path) -> None:
    turns = {"t": T, "q1": 20 * np.sin(T), "a": np.cos(T)}
    wrapped = turns | {"q1": np.mod(np.degrees(turns["q1"]), 360.0)}
    file = write_csv(tmp_path / "a.csv", turns | {"q1": np.mod(turns["q1"], 2 * np.pi), "q2": np.sin(T)})
    with pytest.raises(InputError, match=r"q1 jumps by .* rad after t = .* declare `wrap: 2\*pi`"):
        read(file, FREE)
    file = write_csv(tmp_path / "b.csv", wrapped)
    text = "schema: 1\njoints:\n  - position: {column: q1, unit: deg, wrap: 360}\n"
    text += "  - position: {column: a, unit: rad}\n"
    record = read(file, FREE, written(tmp_path, text))
    assert record.q[:, 0] == pytest.approx(turns["q1"], abs=1e-9)
    # The same block by block.
    reader = open_source(file, FREE, tmp_path / "mapping.yaml").reader
    parts = [block[:, 0] for block in reader.blocks(Wanted(("q1",)), 100)]
    assert np.concatenate(parts) == pytest.approx(turns["q1"], abs=1e-9)


BROKEN = [
    (AXIS_MAPPING.replace("schema: 1", "schema: 2"), ":2:9: schema: found 2, expected 1"),
    (AXIS_MAPPING.replace("joints", "axes"), ":4:1: axes: found the unknown key 'axes'"),
    (AXIS_MAPPING.replace("unit: ms", "rate: 50"), "unknown key 'rate'; it belongs at the top level"),
    (
        AXIS_MAPPING.replace("unit: V", "columns: V"),
        "found the unknown key 'columns', did you mean 'column'?",
    ),
    (AXIS_MAPPING.replace("unit: V", "units: V"), "found the unknown key 'units', did you mean 'unit'?"),
    (AXIS_MAPPING.replace("unit: V", "scale: 1"), "joints.0.effort: the key 'unit' is missing"),
    (AXIS_MAPPING.replace("unit: V", "unit: volts"), ":6:46: joints.0.effort.unit: found the unit 'volts'"),
    (AXIS_MAPPING.replace("unit: mm", "unit: deg"), "found the unit 'deg', available: m, cm, mm, um"),
    (AXIS_MAPPING.replace("unit: ms", "unit: min"), "time.unit: found the unit 'min'"),
    (AXIS_MAPPING.replace("unit: ms", "unit: ms, resample: -1"), "found -1, expected a number above 0"),
    (AXIS_MAPPING.replace("scale: -1", "scale: 0"), "joints.0.position.scale: found 0, expected a scale"),
    (AXIS_MAPPING.replace("scale: -1", "scale: two"), "found 'two', expected a number"),
    (
        AXIS_MAPPING.replace("column: pos", "column: pose"),
        "found no column 'pose' in the log, did you mean 'pos'?",
    ),
    (AXIS_MAPPING.replace("885 * vin", "885 * volt"), "there is no column 'volt' (columns: stamp, pos, load"),
    (AXIS_MAPPING.replace("load / 885", "load.real / 885"), "expected columns, numbers, pi, + - * / **"),
    (AXIS_MAPPING + "hold: sometimes\n", "found 'sometimes', expected one of following, previous, instant"),
    (
        AXIS_MAPPING.replace("unit: V", "unit: N m"),
        "found the unit 'N m', expected a force's for joint slide",
    ),
    (AXIS_MAPPING.replace("unit: V", "unit: A"), "found a current, but joint slide has no drive"),
    (DRIVEN_MAPPING, "found 2 joints, expected 1, the coordinates of axis: slide"),
    ("arms: {}\nconvention: x\n", "this is the description of an arm, expected a mapping file"),
    ("- 1\n", "found a list of 1, expected a mapping with `schema` and `joints`"),
]


@pytest.mark.parametrize(("text", "message"), BROKEN)
def test_a_mistake_in_a_mapping_has_its_place(text: str, message: str, tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", AXIS_LOG)
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        read(file, AXIS, written(tmp_path, text))
    assert re.match(r".*mapping\.yaml:\d+:\d+: ", str(caught.value))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("counts, side: motor", "rad, side: motor", "found the unit 'rad', available: counts"),
        ("unit: deg, side: motor", "unit: counts, side: motor", "write unit: rev, scale: 1/4096"),
        ("unit: N m", "unit: N m, side: motor", "found the unit 'N m', expected a force's for joint knee"),
        ("motor/angle [deg]", "motor", "found no column 'motor' in the log"),
    ],
)
def test_a_unit_must_fit_the_drive(old: str, new: str, message: str, tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", DRIVEN_LOG)
    with pytest.raises(InputError, match=re.escape(message)):
        read(file, DRIVEN, written(tmp_path, DRIVEN_MAPPING.replace(old, new)))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[[40, 0], [24, 24]]", "[[40, 0], [20, 0]]", "the matrix is singular"),
        ("[[40, 0], [24, 24]]", "[[40, 0]]", "found 1 x 2 numbers, expected 2 x 2"),
        ("[0, pi/2]", "[0]", "found 1 numbers, expected 2, one per joint"),
        (", effort: {column: y, unit: N m}", "", "a coupling mixes the joints: found no tau2"),
        ("unit: N m}}\n  -", "unit: V}}\n  -", "efforts pass a coupling as torques or forces"),
    ],
)
def test_a_coupling_must_fit(old: str, new: str, message: str, tmp_path: Path) -> None:
    table = {"t": T} | {name: np.cos(T + k) for k, name in enumerate(("a", "b", "da", "db", "x", "y"))}
    with pytest.raises(InputError, match=re.escape(message)):
        read(write_csv(tmp_path / "a.csv", table), FREE, written(tmp_path, COUPLED.replace(old, new)))


def test_a_mapping_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such mapping file"):
        read(write_csv(tmp_path / "a.csv", AXIS_LOG), AXIS, tmp_path / "absent.yaml")


@pytest.mark.parametrize(
    ("text", "value"),
    [("a*2 + b", 7.0), ("-a**2", -4.0), ("sin(pi/2) * b", 3.0), ("abs(-b) - sqrt(a + a)", 1.0), ("a b", 5.0)],
)
def test_a_formula_is_arithmetic(text: str, value: float) -> None:
    names = {"a": np.array([2.0]), "b": np.array([3.0]), "a b": np.array([5.0])}
    assert formula(text, tuple(names))(names) == pytest.approx(value)


@pytest.mark.parametrize(
    "text",
    ["__import__('os')", "a.real", "a[0]", "lambda: a", "a if b else a", "open(a)", "'a'", "a; b", "c + 1",
     "sin(a, b)", "a @ b", "a == b", "(" * 100 + "a" + ")" * 100, "-" * 60 + "a", "1e999 * a", "x" * 300],
)  # fmt: skip
def test_a_formula_is_nothing_else(text: str) -> None:
    with pytest.raises(FormulaError):
        formula(text, ("a", "b"))


def test_the_schema_accepts_the_case_studies_and_refuses_a_misspelt_key(checkout: Path) -> None:
    schema = mapping_json_schema()
    files = sorted((checkout / "examples" / "case_studies").glob("*_mapping.yaml"))
    assert len(files) == 7
    for file in files:
        document = parse(file.read_text(encoding="utf-8"), str(file)).plain()
        jsonschema.validate(document, schema)
        load_mapping(file)
    document["joints"][0]["effort"]["units"] = "A"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(document, schema)


def test_a_column_that_stands_there_twice_is_refused(tmp_path: Path) -> None:
    (tmp_path / "map.yaml").write_text(AXIS_MAPPING)
    rows = [",".join(["stamp", "pos", "load", "vin", "temp", "pos"])]
    table = np.column_stack([*AXIS_LOG.values(), AXIS_LOG["pos"]])
    rows += [",".join(f"{x:.9g}" for x in row) for row in table]
    (tmp_path / "log.csv").write_text("\n".join(rows))
    with pytest.raises(InputError, match=r"the log's column pos stands there 2 times, expected once"):
        read(str(tmp_path / "log.csv"), AXIS, mapping=tmp_path / "map.yaml")


def test_the_report_says_what_a_voltage_puts_into_the_viscous_friction(tmp_path: Path) -> None:
    (tmp_path / "map.yaml").write_text(AXIS_MAPPING)
    write_csv(tmp_path / "log.csv", AXIS_LOG)
    lines = described(prepare(read(str(tmp_path / "log.csv"), AXIS, mapping=tmp_path / "map.yaml")))
    assert lines[-1].startswith("slide: the effort is a voltage [V]: back-EMF sits in the viscous friction")


PAIR_MAPPING = """
schema: 1
joints:
  - position: {column: a, unit: rad}
    effort: {column: i, unit: A}
    temperature: {column: warm, unit: degC}
  - position: {column: b, unit: rad}
    effort: {column: k, unit: A}
    temperature: {column: warm, unit: degC}
"""
PAIR_LOG = {
    "t": T,
    "a": Q[:, 0],
    "b": Q[:, 1],
    "i": np.cos(T),
    "k": np.sin(T),
    "warm": 30 + T,
}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "column: k,",
            "column: i,",
            r"joints\.1\.effort\.column: found the column 'i', which joints\.0\.effort",
        ),
        ("column: b,", "column: a,", r"joints\.1\.position\.column: .* joints\.0\.position is read from too"),
        ("column: k,", "column: a,", r"joints\.1\.effort\.column: .* joints\.0\.position is read from too"),
        ("column: k, unit: A", "column: i, unit: mA", None),
        ("column: b, unit: rad", "column: a, unit: rad, scale: -1", None),
        ("column: k,", "column: 0 * i,", None),
    ],
)
def test_a_column_is_read_once(old: str, new: str, said: str | None, tmp_path: Path) -> None:
    """A copied line of a mapping gives two joints one motion; one that follows another has its own scale."""
    log, mapping = write_csv(tmp_path / "a.csv", PAIR_LOG), written(tmp_path, PAIR_MAPPING)
    assert read(log, DRIVEN, mapping).temperature[:, 1] == pytest.approx(30 + T)
    mapping = written(tmp_path, PAIR_MAPPING.replace(old, new))
    if said is None:
        open_source(log, DRIVEN, mapping)
    else:
        with pytest.raises(InputError, match=said):
            read(log, DRIVEN, mapping)
