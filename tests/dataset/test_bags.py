"""Bags as robots write them: several publishers, late topics, other encodings, files that end too early."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from modelgen.dataset import read
from modelgen.dataset.inspection import inspect
from modelgen.description import loads
from modelgen.errors import InputError

rosbag2 = pytest.importorskip("rosbags.rosbag2")
typesys = pytest.importorskip("rosbags.typesys")
mcap = pytest.importorskip("mcap.writer")

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    joints:
      - {name: a, drive: {type: direct, ratio: 1, torque_constant: 1}}
      - {name: b, d: 0.1, drive: {type: direct, ratio: 1, torque_constant: 1}}
"""
)["two"]
T = np.arange(150) / 50.0
Q = np.stack([np.sin(T), 0.5 * np.cos(2 * T)], axis=1)
EPOCH = 1_650_000_000_000_000_000


def mapping(folder: Path, one: str, two: str, topic: str = "/js", time: str = "header.stamp") -> Path:
    lines = "\n".join(
        f'  - {{position: {{column: "{topic}.position[{name}]", unit: rad}}, '
        f'effort: {{column: "{topic}.effort[{name}]", unit: A}}}}'
        for name in (one, two)
    )
    path = folder / "mapping.yaml"
    path.write_text(
        f'schema: 1\ntime: {{column: "{topic}.{time}", relative: true}}\nhold: instant\njoints:\n{lines}\n'
    )
    return path


Message = tuple[float, list[str], list[float]]  # stamp, names, positions; efforts are twice those


def bag(folder: Path, messages: list[Message]) -> Path:
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    kinds = store.types
    with rosbag2.Writer(folder / "bag", version=9) as writer:
        connection = writer.add_connection("/js", "sensor_msgs/msg/JointState", typestore=store)
        for t, names, values in messages:
            time = EPOCH + round(1e9 * t)
            stamp = kinds["builtin_interfaces/msg/Time"](sec=time // 10**9, nanosec=time % 10**9)
            head = kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="")
            v = np.array(values)
            message = kinds["sensor_msgs/msg/JointState"](head, names, v, 0 * v, 2 * v)
            writer.write(connection, time, store.serialize_cdr(message, connection.msgtype))
    return folder / "bag"


def states(names: list[str]) -> list[Message]:
    return [(float(t), names, list(q)) for t, q in zip(T, Q, strict=True)]


def test_a_name_made_of_digits_is_a_name(tmp_path: Path) -> None:
    record = read(str(bag(tmp_path, states(["2", "0"]))), ARM, mapping(tmp_path, "0", "2"))
    assert record.q == pytest.approx(Q[:, ::-1])
    with pytest.raises(InputError, match=r"found no column '/js.position\[1\]'"):
        read(str(tmp_path / "bag"), ARM, mapping(tmp_path, "0", "1"))


@pytest.mark.parametrize("time", ["header.stamp", "log_time"])
def test_a_bag_says_when_it_began(tmp_path: Path, time: str) -> None:
    """By the stamp of the message, and by the instant at which it was recorded."""
    record = read(bag(tmp_path, states(["a", "b"])), ARM, mapping(tmp_path, "a", "b", time=time))
    assert record.t[0] == pytest.approx(0.0, abs=1e-6)
    assert record.begins == pytest.approx(1e-9 * EPOCH, abs=1e-3)


def test_messages_without_the_named_joints_are_passed_over(tmp_path: Path) -> None:
    gripper = [(float(t) + 0.004, ["finger"], [0.02]) for t in T]
    mixed = sorted([*states(["a", "b"]), *gripper, (-0.001, ["finger"], [0.02])])
    record = read(str(bag(tmp_path, mixed)), ARM, mapping(tmp_path, "a", "b"))
    assert record.q == pytest.approx(Q)
    assert record.input == pytest.approx(2 * Q)
    assert any("151 of 301 messages have none of the columns" in remark for remark in record.remarks)


@pytest.mark.parametrize("part", ["", "@0:2"])
@pytest.mark.parametrize("jitter", [0.0, 0.001])
def test_messages_without_the_named_joints_do_not_count_for_the_rate(
    part: str, jitter: float, tmp_path: Path
) -> None:
    gripper = [(float(t) + 0.004, ["finger"], [0.02]) for t in T]
    late = jitter * (np.arange(len(T)) % 3 == 1)
    arm = [(t + x, names, q) for (t, names, q), x in zip(states(["a", "b"]), late, strict=True)]
    log = f"{bag(tmp_path, sorted([*arm, *gripper]))}{part}"
    seen = inspect(log, ARM, mapping(tmp_path, "a", "b"))
    assert seen.samples == (100 if part else len(T))
    assert seen.rate == pytest.approx(50.0, rel=0.06)
    assert 1.0 / read(log, ARM, mapping(tmp_path, "a", "b")).step == pytest.approx(50.0, rel=0.06)


def test_joints_of_two_publishers_are_joined(tmp_path: Path) -> None:
    later = T + 0.009
    second = [(float(t), ["b"], [float(0.5 * np.cos(2 * t))]) for t in later]
    first = [(float(t), ["a"], [float(q)]) for t, q in zip(T, Q[:, 0], strict=True)]
    record = read(str(bag(tmp_path, sorted([*first, *second]))), ARM, mapping(tmp_path, "a", "b"))
    assert record.q[:, 0] == pytest.approx(Q[1:, 0])
    assert record.q[:, 1] == pytest.approx(Q[1:, 1], abs=2.0 / 8 / 50**2 * 1.1)
    assert any("rows come in turn" in remark for remark in record.remarks)


def test_a_folder_without_metadata_is_its_files(tmp_path: Path) -> None:
    folder = bag(tmp_path, states(["a", "b"]))
    (folder / "metadata.yaml").unlink()
    assert read(str(folder), ARM, mapping(tmp_path, "a", "b")).q == pytest.approx(Q)


def json_file(
    folder: Path, before: int = 0, other: str = "", compression: Any = mcap.CompressionType.ZSTD
) -> Path:
    path = folder / "a.mcap"
    with path.open("wb") as stream:
        writer = mcap.Writer(stream, chunk_size=2000, compression=compression)
        writer.start()
        schema = writer.register_schema(name="any", encoding="jsonschema", data=b"{}")
        kinds = {"/imu": other or "json", "/js": "json"}
        ids = {name: writer.register_channel(name, kind, schema) for name, kind in kinds.items()}

        def add(topic: str, t: float, data: dict[str, Any]) -> None:
            time = EPOCH + round(t * 1e9)
            writer.add_message(ids[topic], time, json.dumps(data).encode(), time)

        for k in range(before):
            add("/imu", 1e-4 * (k - before), {"x": k})
        for t, q in zip(T, Q, strict=True):
            add("/js", t, {"name": ["a", "b"], "position": list(q), "effort": list(2 * q)})
        writer.finish()
    return path


def test_a_topic_that_begins_late_is_found(tmp_path: Path) -> None:
    file = json_file(tmp_path, before=2100)
    record = read(str(file), ARM, mapping(tmp_path, "a", "b", time="log_time"))
    assert record.q == pytest.approx(Q)


def test_json_beside_other_messages_is_read(tmp_path: Path) -> None:
    file = json_file(tmp_path, before=5, other="protobuf")
    record = read(str(file), ARM, mapping(tmp_path, "a", "b", time="log_time"))
    assert record.q == pytest.approx(Q)
    assert any("/imu: messages of the kind protobuf are not read" in remark for remark in record.remarks)


def test_a_file_that_is_cut_off_is_read_up_to_there(tmp_path: Path) -> None:
    file = json_file(tmp_path)
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) * 6 // 10])
    record = read(str(file), ARM, mapping(tmp_path, "a", "b", time="log_time"))
    assert 40 < len(record.t) < 150
    assert record.q == pytest.approx(Q[: len(record.t)])
    assert any("the file is cut off or damaged after" in remark for remark in record.remarks)


def test_a_chunk_that_has_changed_is_not_read(tmp_path: Path) -> None:
    """Its bytes are JSON as before, with another digit in a position; the chunk's checksum says so."""
    file = json_file(tmp_path, compression=mcap.CompressionType.NONE)
    whole = file.read_bytes()
    place = whole.index(b'"position": [0.', len(whole) // 2) + len(b'"position": [0.')
    changed = b"%d" % ((whole[place] - ord("0") + 5) % 10)
    file.write_bytes(whole[:place] + changed + whole[place + 1 :])
    record = read(str(file), ARM, mapping(tmp_path, "a", "b", time="log_time"))
    assert 40 < len(record.t) < 150
    assert record.q == pytest.approx(Q[: len(record.t)])
    assert any("the file is cut off or damaged after" in remark for remark in record.remarks)
