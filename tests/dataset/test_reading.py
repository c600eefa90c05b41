"""Logs by the contract: what a record holds, and every refusal by its message."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import sympy
from arms_support import ARMS
from dataset_support import AXIS, DRIVEN, FREE, LEVER, columns, counts_of, motion, times, write_csv

from modelgen.dataset import Settings, Stream, check_separate, gather, prepare, read, read_columns, split
from modelgen.dataset.inspection import inspect, skeleton
from modelgen.description import geometry_symbol
from modelgen.errors import InputError
from modelgen.transmission import of_joint

T = times()
Table = dict[str, np.ndarray]


def test_positions_are_in_joint_and_motor_coordinates(tmp_path: Path) -> None:
    record = read(write_csv(tmp_path / "a.csv", columns(T)), DRIVEN)
    q, _, _ = motion(T)
    assert record.q == pytest.approx(q, abs=1e-12)
    assert record.motor[:, 0] == pytest.approx(50 * q[:, 0])
    assert record.motor[:, 1] == pytest.approx(counts_of(q[:, 1]))
    assert record.motor_side == (False, True)
    assert record.step == pytest.approx(1 / 200)
    assert record.hold == pytest.approx(1 / 400)
    assert record.effort_unit == ("A", "A")
    assert np.all(record.gain == 1.0)


def test_a_joint_effort_becomes_the_current_that_makes_it(tmp_path: Path) -> None:
    table = columns(T)
    effort = 30.0 * np.cos(T)
    del table["i2"]
    table["tau2"] = effort
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    q, _, _ = motion(T)
    # Virtual work on the lever: K = torque constant * counts per length * l1 l2 sin(inner) / length.
    inner = q[:, 1] - LEVER["offset"]
    length = np.sqrt(LEVER["l1"] ** 2 + LEVER["l2"] ** 2 - 2 * LEVER["l1"] * LEVER["l2"] * np.cos(inner))
    gain = 1e-4 * LEVER["counts"] / (LEVER["high"] - LEVER["low"])
    gain *= LEVER["l1"] * LEVER["l2"] * np.sin(inner) / length
    assert record.input[:, 1] == pytest.approx(effort / gain)
    assert record.input * record.gain == pytest.approx(np.stack([table["i1"], effort], axis=1))
    assert record.effort_unit == ("A", "N m")


def test_a_part_of_a_file_is_what_lies_in_it(tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", columns(T))
    record = read(f"{file}@2:3.5", DRIVEN)
    assert record.t == pytest.approx(T[(T >= 2) & (T < 3.5)])
    assert read(f"{file}@6:", DRIVEN).t[0] == 6.0
    assert read(f"{file}@:1", DRIVEN).t[-1] == pytest.approx(0.995)


def test_a_free_motion_has_no_input_and_locked_joints_no_column(tmp_path: Path) -> None:
    table = {"t": T, "q1": np.cos(T), "q2": np.sin(T)}
    record = read(write_csv(tmp_path / "a.csv", table), FREE)
    assert record.input is None
    assert record.n == 2


def test_rates_and_temperatures_are_kept(tmp_path: Path) -> None:
    _, dq, ddq = motion(T)
    table = columns(T) | {"dq1": dq[:, 0], "dq2": dq[:, 1], "ddq1": ddq[:, 0], "ddq2": ddq[:, 1]}
    table["temperature2"] = 30 + T
    record = read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    assert record.dq == pytest.approx(dq)
    assert record.ddq == pytest.approx(ddq)
    assert record.temperature[:, 1] == pytest.approx(30 + T)


def test_a_jittering_clock_is_resampled_without_delay(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    stamps = T + rng.uniform(0, 0.002, len(T))
    effort = np.sin(3 * stamps)
    table = {"t": stamps, "q1": 0.2 * np.cos(2 * stamps), "tau1": effort}
    record = read(write_csv(tmp_path / "a.csv", table), AXIS)
    assert np.ptp(np.diff(record.t)) < 1e-12
    assert record.q[:, 0] == pytest.approx(0.2 * np.cos(2 * record.t), abs=1e-6)
    assert "resampled at" in record.remarks[0]
    # A held effort keeps its integral: the staircase's area over the record.
    area = np.sum(effort[:-1] * np.diff(stamps))
    assert np.sum(record.input[:, 0]) * record.step == pytest.approx(area, abs=0.01)


def edited(change: Callable[[Table], None]) -> Callable[[], Table]:
    def make() -> Table:
        table = columns(T)
        change(table)
        return table

    return make


def without(*names: str, **more: np.ndarray) -> Callable[[], Table]:
    def change(table: Table) -> None:
        for name in names:
            del table[name]
        table.update(more)

    return edited(change)


def setting(name: str, where: slice | int, value: float) -> Callable[[], Table]:
    def change(table: Table) -> None:
        table[name] = table[name].copy()
        table[name][where] = value

    return edited(change)


def scaled(name: str, factor: float) -> Callable[[], Table]:
    return edited(lambda table: table.update({name: table[name] * factor}))


ONES = np.linspace(0, 1, len(T))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (without("t", time=T), r"the column t \[s\] is missing, did you mean"),
        (without("q1", Q1=ONES), r"the column q1 or qm1 is missing, did you mean the column 'Q1'\?"),
        (without("i2", cur2=ONES), "the column i2 or tau2 is missing"),
        (without("i1", tau3=ONES), "found the column tau3, but driven has 2 coordinates"),
        (edited(lambda x: x.update(qm1=ONES)), "found both q1 and qm1 for one joint"),
        (edited(lambda x: x.update(tau1=ONES)), "found both i1 and tau1 for one joint"),
        (edited(lambda x: x.update(dq2=ONES)), "found dq2, but the column dq1 is missing"),
        (without("i1", "i2"), "found no effort, expected i<n> or tau<n>"),
        (setting("t", 700, 1.0), r"time runs backwards after t = 3\.495 s: the next stamp is 1 s"),
        (setting("t", 700, 3.495), r"time stands still after t = 3\.495 s: .*`rate:` in a mapping file"),
        (setting("t", slice(800, None), np.nan), "found nan in the column t at sample 801"),
        (setting("i2", 10, np.nan), r"found nan in the column i2 at t = 0\.05 s, expected a finite number"),
        (setting("q1", 10, np.inf), "found inf in the column q1"),
        (
            setting("q1", slice(None), 5e299),
            r"found 5e\+299 in the column q1 .* expected a finite number below",
        ),
        (setting("q1", slice(None), 0.5), r"the position q1 is 0\.5 in all 1600 samples.*locked: \{hip: "),
        (setting("i2", slice(None), 0.0), "the effort i2 is 0 in all 1600 samples.*leave the effort columns"),
        (
            scaled("q1", 50.0),
            "these look like degrees or the motor's positions; declare `unit: deg` or `side: motor`",
        ),
        (setting("q1", slice(2, None), 3.0), "q1 runs from .* correct unit, sign or offset"),
        (scaled("q1", 1000.0), "q1 runs from .* correct unit, sign or offset"),
        (scaled("qm2", 2.0), "qm2 runs from .* joint knee from 0 to 20000 motor units"),
    ],
)
def test_a_log_that_cannot_be_meant_is_refused(
    table: Callable[[], Table], message: str, tmp_path: Path
) -> None:
    file = write_csv(tmp_path / "a.csv", table())
    with pytest.raises(InputError, match=message) as caught:
        read(file, DRIVEN)
    assert str(caught.value).startswith(file)
    assert "\n" not in str(caught.value)


def test_millimetres_are_recognised(tmp_path: Path) -> None:
    table = {"t": T, "q1": 200 * np.cos(T), "tau1": np.sin(T)}
    with pytest.raises(InputError, match="these look like millimetres; declare `unit: mm`"):
        read(write_csv(tmp_path / "a.csv", table), AXIS)


def test_a_current_needs_a_drive(tmp_path: Path) -> None:
    table = {"t": T, "q1": 0.2 * np.cos(T), "i1": np.sin(T)}
    with pytest.raises(InputError, match=r"joint slide has no drive: its input is tau1 \[N\]"):
        read(write_csv(tmp_path / "a.csv", table), AXIS)


def test_a_gap_is_refused(tmp_path: Path) -> None:
    table = {name: np.delete(column, slice(500, 560)) for name, column in columns(T).items()}
    with pytest.raises(
        InputError, match=r"found a gap of 0\.305 s after t = 2\.495 s, expected at most 0\.05 s"
    ):
        read(write_csv(tmp_path / "a.csv", table), DRIVEN)


@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (1e3, r"stamps are 5 apart: are they in ms \(200 Hz\), or in s \(0\.2 Hz\)\? `time: {unit: \.\.\.}`"),
        (1e6, r"stamps are 5000 apart: are they in us \(200 Hz\), or in s"),
        (1e9, r"stamps are 5e\+06 apart: are they in ns \(200 Hz\), or in s"),
        (2e4, r"stamps are 100 apart: are they in ms \(10 Hz\) or us \(10000 Hz\), or in s"),
        (1 / 3600, r"stamps are 1\.38889e-06 apart: are they in s \(720000 Hz\)\?"),
    ],
)
def test_the_unit_of_the_time_is_asked_for(factor: float, said: str, tmp_path: Path) -> None:
    table = columns(T) | {"t": factor * T}
    with pytest.raises(InputError, match=said):
        read(write_csv(tmp_path / "a.csv", table), DRIVEN)
    with pytest.raises(InputError, match=said):
        next(Stream(str(tmp_path / "a.csv"), DRIVEN, Settings(cutoff=0.01)).records())
    assert any(remark.startswith("stamps are") for remark in inspect(str(tmp_path / "a.csv")).remarks)


def test_a_slow_log_is_read_where_the_mapping_says_that_it_is(tmp_path: Path) -> None:
    q, dq, _ = motion(T)
    file = write_csv(tmp_path / "a.csv", {"t": 1e3 * T, "q1": 0.1 * q[:, 0], "tau1": dq[:, 0]})
    skeletons = skeleton(file, AXIS)
    assert "unit: ms" in skeletons
    mapping = tmp_path / "m.yaml"
    mapping.write_text(skeletons, encoding="utf-8")
    assert read(file, AXIS, mapping).step == pytest.approx(5e-3)
    mapping.write_text(skeletons.replace("unit: ms", "unit: s"), encoding="utf-8")
    record = read(file, AXIS, mapping)
    assert record.step == pytest.approx(5.0)
    assert record.remarks == ("a sample every 5 s, by the unit that the mapping file declares",)


def test_parts_of_a_file_have_one_rate(tmp_path: Path) -> None:
    """Steps of 3 and 4 ms in turn, of which one is more frequent here and the other there."""
    random = np.random.default_rng(3)
    steps = [random.choice([3e-3, 4e-3], size=3000, p=p) for p in ([0.6, 0.4], [0.4, 0.6])]
    t = np.concatenate([[0.0], np.cumsum(np.concatenate(steps))])
    file, half = write_csv(tmp_path / "a.csv", columns(t)), t[3000]
    parts = [read(f"{file}@{ends}", DRIVEN) for ends in (f":{half}", f"{half}:")]
    assert parts[0].step == pytest.approx(parts[1].step, rel=1e-9)
    q, _, _ = motion(parts[1].t)
    assert parts[1].q == pytest.approx(q, abs=1e-3)


def test_a_short_record_is_refused(tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", columns(T))
    with pytest.raises(InputError, match="found 10 samples, expected at least 20"):
        read(f"{file}@1:1.05", DRIVEN)
    with pytest.raises(InputError, match=r"found 0 samples, .* the log has 1600, from 0 to 7\.995 s"):
        read(f"{file}@100:200", DRIVEN)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the log is empty, expected a header"),
        ("0.0,1.0\n0.1,1.1\n", ":1:1: found numbers in the first line"),
        ("t,q1,q1,tau1\n0,1,1,2\n", "the column q1 stands there 2 times, expected once"),
        ("t,q1,tau1\n" + "0,1,2\n" * 20000 + "\udcff,1,2\n", ":20002:1: found bytes that are no UTF-8 text"),
        ("t,q1,tau1\n0,1,2\n0.1,x,2\n", ":3:5: found 'x' in the column q1, expected a number"),
        ("t,q1,tau1\n0,1,2\n0.1,,2\n", ":3:5: found 'nothing' in the column q1, expected a number"),
        ("t,q1,tau1\n0,1,2\n0.1,1\n", ":3:1: found 2 cells, expected 3: t, q1, tau1"),
    ],
)
def test_a_broken_file_is_refused_with_its_place(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8", errors="surrogateescape")
    with pytest.raises(InputError, match=re.escape(message)):
        read(str(path), AXIS)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("absent.csv", "there is no such log"),
        ("a.csv@3:1", "found the part 3 s to 1 s, expected FILE@t0:t1 with t0 < t1"),
        ("a.csv@x:1", "found 'x' as a time"),
        ("a.xlsx", "found a log of the kind '.xlsx', expected"),
        (".", "found a folder"),
    ],
)
def test_what_is_no_log_is_refused(name: str, message: str, tmp_path: Path) -> None:
    for file in ("a.csv", "a.xlsx"):
        write_csv(tmp_path / file, columns(T))
    with pytest.raises(InputError, match=re.escape(message)):
        read(str(tmp_path / name), DRIVEN)


def test_separators_quotes_comments_and_marks_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    rows = "\n".join(f"{k / 100};{np.cos(k / 50) / 5};{k % 7}" for k in range(60))
    path.write_text(f'\ufeff# a remark\n"t";"q1";"tau1"\n{rows}\n', encoding="utf-8")
    assert len(read(str(path), AXIS).t) == 60


def test_columns_by_their_own_names(tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", {"t": T, "qm1": 100 * T, "q1": T**2})
    found = read_columns(f"{file}@1:2", ["q1", "qm1"])
    assert found["q1"] == pytest.approx(found["t"] ** 2)
    with pytest.raises(InputError, match="the column q2 is missing"):
        read_columns(file, ["q2"])


def test_training_and_test_share_nothing(tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", columns(T))
    copy = write_csv(tmp_path / "b.csv", columns(T))
    other = write_csv(tmp_path / "c.csv", columns(T[:-1]))
    check_separate([f"{file}@0:4"], [f"{file}@4:8", other])
    for test in (file, f"{file}@3.9:8", f"{copy}@2:3"):
        with pytest.raises(InputError, match=r"share samples.*--train .*@:T --test .*@T:"):
            check_separate([f"{file}@0:4"], [test])
    with pytest.raises(InputError, match="the files have the same content"):
        check_separate([file], [copy])
    with pytest.raises(InputError, match=r"--train .* and --train .* share samples"):
        check_separate([f"{file}@0:4", f"{file}@3:5"], [other])
    with pytest.raises(InputError, match="found no test record, expected one; one file can serve for both"):
        check_separate([file], [])


def test_a_copy_under_another_name_is_no_test(tmp_path: Path) -> None:
    rng = np.random.default_rng(7)
    table = columns(T)
    table["i1"] = table["i1"] + rng.normal(0, 0.1, len(T))
    file = write_csv(tmp_path / "a.csv", table)
    copied = {name: column[1000:1200] for name, column in table.items()} | {"t": T[:200] + 0.5}
    copy = write_csv(tmp_path / "b.csv", copied)
    with pytest.raises(InputError, match=r"--train .*a\.csv and --test .*b\.csv share samples: .* t = 0\.5"):
        gather([file], [copy], DRIVEN)
    train, test = gather([f"{file}@:4"], [copy, f"{file}@6:"], DRIVEN)
    assert (len(train), len(test)) == (1, 2)
    # The same motion with other noise is another measurement.
    other = write_csv(tmp_path / "c.csv", table | {"i1": table["i1"] + 1e-6 * rng.normal(size=len(T))})
    gather([file], [other], DRIVEN)


def test_a_record_is_split_into_blocks_in_time(tmp_path: Path) -> None:
    record = read(write_csv(tmp_path / "a.csv", columns(T)), DRIVEN)
    first, second = split(record)
    assert np.concatenate([first.t, second.t]) == pytest.approx(record.t)
    assert np.concatenate([first.input, second.input]) == pytest.approx(record.input)
    assert read(second.name, DRIVEN).q == pytest.approx(second.q)


@pytest.mark.parametrize("name", ARMS)
def test_every_shipped_arm_reads_its_log(name: str, tmp_path: Path) -> None:
    """Half of the joints logged as motor coordinates: both ways lead to the same joint coordinates."""
    arm = ARMS[name]
    rng = np.random.default_rng(6)
    symbols = {geometry_symbol(name): value for name, value in arm.symbols.items()}
    t = times(4.0, 100.0)
    table = {"t": t}
    joints = []
    for k, i in enumerate(arm.coordinates, 1):
        joint = arm.joints[i]
        transmission = of_joint(arm, joint)
        low, high = joint.limits.position or transmission.joint_range() or (-0.5, 0.5)
        q = low + (high - low) * (0.5 + 0.4 * np.sin((1 + 0.2 * k) * t + rng.uniform(0, 6)))
        joints.append(q)
        motor = sympy.lambdify(transmission.q, sympy.sympify(transmission.motor()).subs(symbols), "numpy")
        table |= {f"qm{k}": motor(q)} if k % 2 and transmission.driven else {f"q{k}": q}
        table |= {f"{'i' if transmission.driven else 'tau'}{k}": np.cos(t + k)}
    record = read(write_csv(tmp_path / "a.csv", table), arm)
    assert record.q == pytest.approx(np.stack(joints, axis=1), abs=1e-9)
    prepared = prepare(record)
    assert np.isfinite(prepared.ddmotor).all()


@pytest.mark.parametrize(("origin", "known"), [(1_700_000_000.0, True), (86_400.0, False), (0.0, False)])
def test_when_a_record_began_is_known_from_stamps_that_count_from_1970(
    tmp_path: Path, origin: float, known: bool
) -> None:
    """A clock that counts from its own start says nothing of the day."""
    file = write_csv(tmp_path / "a.csv", columns(T) | {"t": origin + T})
    record = read(f"{file}@{origin + 2:.1f}:{origin + 6:.1f}", DRIVEN)
    later = record.part(200, 600)
    if known:
        assert record.begins == pytest.approx(1_700_000_002.0, abs=1e-3)
        assert later.begins == pytest.approx(1_700_000_003.0, abs=1e-3)
    else:
        assert record.begins is None
        assert later.begins is None


def test_rows_that_lost_their_order_are_refused(tmp_path: Path) -> None:
    table, order = columns(T), np.random.default_rng(4).permutation(len(T))
    shuffled = {name: x if name == "t" else x[order] for name, x in table.items()}
    with pytest.raises(InputError, match="are the rows not in the order of time"):
        read(write_csv(tmp_path / "a.csv", shuffled), DRIVEN)


def test_a_joint_that_only_trembles_is_remarked_on(tmp_path: Path) -> None:
    random = np.random.default_rng(2)
    table = columns(T)
    noise = 0.3 + 1e-4 * random.normal(size=len(T))
    (said,) = read(write_csv(tmp_path / "a.csv", table | {"q1": noise}), DRIVEN).remarks
    assert said.startswith("q1 shows no motion, only noise of 0.0001 about 0.3")
    assert not read(write_csv(tmp_path / "b.csv", table | {"q1": table["q1"] + noise}), DRIVEN).remarks
