"""Parquet, ROS 1 and 2 bags and MCAP hold the record that CSV holds."""

from __future__ import annotations

import builtins
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from dataset_support import AXIS, DRIVEN, columns, motion, times, write_csv

from modelgen.dataset import Stream, read
from modelgen.dataset.inspection import inspect
from modelgen.dataset.objects import Wanted
from modelgen.errors import InputError

pyarrow = pytest.importorskip("pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")
rosbag1 = pytest.importorskip("rosbags.rosbag1")
rosbag2 = pytest.importorskip("rosbags.rosbag2")
typesys = pytest.importorskip("rosbags.typesys")
mcap = pytest.importorskip("mcap.writer")

T = times(4.0, 100.0)
Q, DQ, _ = motion(T)
EFFORT = np.stack([np.cos(T), 1 + np.sin(T)], axis=1)
EPOCH = 1_700_000_000_000_000_000

MAPPING = """
schema: 1
time: {column: TIME, relative: true}
hold: instant
joints:
  - {position: {column: "/joint_states.position[hip.a]", unit: rad}, effort: {column: HIP, unit: A}}
  - {position: {column: "/joint_states.position[knee]", unit: rad}, effort: {column: KNEE, unit: A}}
"""


def mapping(folder: Path, time: str = "/joint_states.header.stamp", **names: str) -> Path:
    text = MAPPING.replace("TIME", f'"{time}"')
    for word in ("HIP", "KNEE"):
        column = {"HIP": "hip.a", "KNEE": "knee"}[word]
        text = text.replace(word, '"' + names.get(word, f"/joint_states.effort[{column}]") + '"')
    path = folder / "mapping.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def joint_states(store: Any, ros1: bool) -> list[tuple[int, Any]]:
    """Joint states whose joints change places now and then, as publishers' do."""
    kinds = store.types
    found = []
    for k, t in enumerate(T):
        time = EPOCH + round(t * 1e9)
        stamp = kinds["builtin_interfaces/msg/Time"](sec=time // 10**9, nanosec=time % 10**9)
        head = {"stamp": stamp, "frame_id": ""} | ({"seq": k} if ros1 else {})
        order = [0, 1] if k % 5 else [1, 0]
        message = kinds["sensor_msgs/msg/JointState"](
            header=kinds["std_msgs/msg/Header"](**head),
            name=[["hip.a", "knee"][i] for i in order],
            position=Q[k][order],
            velocity=DQ[k][order],
            effort=EFFORT[k][order],
        )
        found.append((time + 3_000_000, message))
    return found


def ros1_bag(folder: Path) -> Path:

    store = typesys.get_typestore(typesys.Stores.ROS1_NOETIC)
    path = folder / "a.bag"
    with rosbag1.Writer(path) as writer:
        connection = writer.add_connection("/joint_states", "sensor_msgs/msg/JointState", typestore=store)
        for time, message in joint_states(store, ros1=True):
            writer.write(connection, time, store.serialize_ros1(message, connection.msgtype))
    return path


def ros2_bag(folder: Path, plugin: str = "SQLITE3") -> Path:

    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    path = folder / f"bag_{plugin.lower()}"
    with rosbag2.Writer(path, version=9, storage_plugin=rosbag2.StoragePlugin[plugin]) as writer:
        connection = writer.add_connection("/joint_states", "sensor_msgs/msg/JointState", typestore=store)
        for time, message in joint_states(store, ros1=False):
            writer.write(connection, time, store.serialize_cdr(message, connection.msgtype))
    return path


def ros2_mcap(folder: Path) -> Path:
    return next(ros2_bag(folder, "MCAP").glob("*.mcap"))


def json_mcap(folder: Path) -> Path:
    """Positions on one topic, currents on another that is sampled between them, twice as often."""
    path = folder / "a.mcap"
    with path.open("wb") as stream:
        writer = mcap.Writer(stream)
        writer.start()
        schema = writer.register_schema(name="any", encoding="jsonschema", data=b"{}")
        topics = {
            name: writer.register_channel(topic=name, message_encoding="json", schema_id=schema)
            for name in ("/joint_states", "/drives")
        }

        def add(topic: str, t: float, data: dict[str, Any]) -> None:
            time = EPOCH + round(t * 1e9)
            writer.add_message(topics[topic], time, json.dumps(data).encode(), time)

        for t in np.arange(-0.05, 5.0, 0.005):
            add("/drives", t + 0.001, {"current": {"hip": np.cos(t + 0.001), "knee": 1 + np.sin(t + 0.001)}})
        for t, q in zip(T, Q, strict=True):
            add("/joint_states", t, {"name": ["hip.a", "knee"], "position": list(q), "note": "text"})
        writer.finish()
    return path


@pytest.mark.parametrize("make", [ros1_bag, ros2_bag, ros2_mcap])
def test_a_bag_holds_the_record(make: Callable[[Path], Path], tmp_path: Path) -> None:
    record = read(str(make(tmp_path)), DRIVEN, mapping(tmp_path))
    assert record.t == pytest.approx(T, abs=1e-6)
    assert record.q == pytest.approx(Q, abs=1e-9)
    assert record.input == pytest.approx(EFFORT, abs=1e-9)


def test_topics_are_joined_at_the_times_of_one(tmp_path: Path) -> None:
    names = {"HIP": "/drives.current.hip", "KNEE": "/drives.current.knee"}
    file = str(json_mcap(tmp_path))
    record = read(file, DRIVEN, mapping(tmp_path, "/joint_states.log_time", **names))
    assert record.q == pytest.approx(Q, abs=1e-12)
    # Straight lines over 5 ms: error below 1/8 of the square of the step times the curvature.
    assert record.input == pytest.approx(EFFORT, abs=0.005**2 / 8 * 1.01)
    with pytest.raises(InputError, match="/joint_states and /drives have no common clock"):
        read(file, DRIVEN, mapping(tmp_path, "/joint_states.position[knee]", **names))


def test_a_bag_needs_a_mapping_and_says_its_columns(tmp_path: Path) -> None:
    file = str(ros2_bag(tmp_path))
    with pytest.raises(InputError, match=r"needs a mapping file.*/joint_states\.position\[hip\.a\]"):
        read(file, DRIVEN)
    with pytest.raises(InputError, match=r"found no column '/joint_states\.stamp' in the log, did you mean"):
        read(file, DRIVEN, mapping(tmp_path, "/joint_states.stamp"))


@pytest.mark.parametrize("name", ["a.bag", "a.mcap", "a.db3"])
def test_what_is_no_bag_is_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    with pytest.raises(InputError, match="there is no such log"):
        read(str(path), DRIVEN, mapping(tmp_path))
    path.write_bytes(b"no bag at all")
    with pytest.raises(InputError, match="cannot be read as a bag: "):
        read(str(path), DRIVEN, mapping(tmp_path))


def test_a_bag_that_was_not_closed_says_what_mends_it(tmp_path: Path) -> None:
    path = ros1_bag(tmp_path)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="`rosbag reindex FILE` mends it"):
        read(str(path), DRIVEN, mapping(tmp_path))
    active = path.with_suffix(".bag.active")
    path.rename(active)
    with pytest.raises(InputError, match=r"`rosbag reindex FILE`, then name it \.bag"):
        read(str(active), DRIVEN, mapping(tmp_path))


def written(path: Path, table: dict[str, Any]) -> str:
    parquet.write_table(pyarrow.table(table), path, row_group_size=300)
    return str(path)


def test_parquet_holds_the_record_and_streams(tmp_path: Path) -> None:
    t = times(20.0)
    csv = read(write_csv(tmp_path / "a.csv", columns(t)), DRIVEN)
    file = written(tmp_path / "a.parquet", columns(t) | {"text": ["x"] * len(t)})
    record = read(file, DRIVEN)
    assert np.array_equal(record.q, csv.q)
    assert np.array_equal(record.input, csv.input)
    assert Stream(file, DRIVEN).samples == len(t)


def test_parquet_that_cannot_be_meant_is_refused(tmp_path: Path) -> None:
    t = times()
    file = written(tmp_path / "a.parquet", {"t": t, "q1": ["x"] * len(t), "tau1": t})
    with pytest.raises(InputError, match="found string in the column q1, expected numbers"):
        read(file, AXIS)
    holes = pyarrow.array([None if k == 7 else float(x) for k, x in enumerate(0.1 * np.cos(t))])
    file = written(tmp_path / "b.parquet", {"t": t, "q1": holes, "tau1": t})
    with pytest.raises(InputError, match=r"found nan in the column q1 at t = 0\.035 s"):
        read(file, AXIS)
    (tmp_path / "c.parquet").write_bytes(b"nothing")
    with pytest.raises(InputError, match="this is no Parquet file"):
        read(str(tmp_path / "c.parquet"), AXIS)


def test_columns_of_several_lengths_are_a_damaged_file(monkeypatch: pytest.MonkeyPatch) -> None:
    class Halved:
        """A reader whose columns can be read one by one alone, the last of them to its half."""

        names, by_column, remarks = ("t", "q1"), True, ()

        def blocks(self, wanted: Wanted, rows: int) -> Iterator[np.ndarray]:
            if len(wanted.names) > 1:
                raise InputError("columns differ")
            yield times()[: 800 if wanted.names == ("q1",) else 1600, None]

    monkeypatch.setattr("modelgen.dataset.inspection.channels.opened", lambda spec: Halved())
    with pytest.raises(InputError, match="the column q1 has 800 readings, others 1600"):
        inspect("a.parquet")


def test_damaged_parquet_is_no_column_without_numbers(tmp_path: Path) -> None:
    t = times()
    file = tmp_path / "a.parquet"
    parquet.write_table(pyarrow.table(columns(t)), file, compression="none", write_page_checksum=True)
    data, place = file.read_bytes(), 8 * len(t)  # of a reading of the first columns
    file.write_bytes(data[:place] + b"\x55" + data[place + 1 :])
    for asked in (lambda: read(str(file), DRIVEN), lambda: inspect(str(file))):
        with pytest.raises(InputError, match="cannot be read on"):
            asked()


@pytest.mark.parametrize(("library", "file"), [("pyarrow", "a.parquet"), ("rosbags", "a.bag")])
def test_a_missing_extra_is_named(
    library: str, file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / file).write_bytes(b"x")
    original = builtins.__import__

    def missing(name: str, *args: Any, **kwargs: Any) -> Any:
        if name.partition(".")[0] == library:
            raise ImportError(name=library)
        return original(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(InputError, match=rf"need(s)? {library}: pip install '{library}>="):
        read(str(tmp_path / file), AXIS, mapping(tmp_path))
