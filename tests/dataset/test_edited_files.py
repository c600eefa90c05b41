"""Random bytes in logs and mappings: a record whose columns are where they were, or one line.

`python tests/dataset/test_edited_files.py 100000` runs so many edits of each kind of file.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from modelgen.dataset import read
from modelgen.dataset.inspection import inspect
from modelgen.description import loads
from modelgen.errors import InputError

parquet = pytest.importorskip("pyarrow.parquet")
mcap = pytest.importorskip("mcap.writer")

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  one: {joints: [{name: hip, drive: {type: direct, ratio: 1, torque_constant: 1}}]}
"""
)["one"]
T = np.arange(60) / 50.0
Q, EFFORT = 0.7 * np.cos(T), 30.0 + np.sin(T)
PIECES = [
    b"",
    b",",
    b";",
    b"\n",
    b"\t",
    b'"',
    b"\x00",
    b"\xff",
    b"-",
    b"e",
    b".",
    b" ",
    b"#",
    b"1",
    b"[",
    b": ",
]
KINDS = ("csv", "parquet", "mcap", "mat", "packed mat", "npz", "mapping")
PLAIN = "schema: 1\njoints: [{position: {column: q1, unit: rad}, effort: {column: i1, unit: A}}]\n"
JSON = (
    "schema: 1\ntime: {column: /a.log_time}\n"
    "joints: [{position: {column: /a.q1, unit: rad}, effort: {column: /a.i1, unit: A}}]\n"
)


def made(folder: Path) -> dict[str, tuple[Path, str, bytes]]:
    """The file to be edited, the mapping, and the bytes as they are, by kind."""
    import pyarrow  # noqa: PLC0415 - skipped where it is not there

    table = {"t": T, "q1": Q, "i1": EFFORT}
    lines = ["t,q1,i1", *(",".join(f"{x:.6f}" for x in row) for row in zip(*table.values(), strict=True))]
    csv, columns, bag = folder / "a.csv", folder / "a.parquet", folder / "a.mcap"
    csv.write_text("\n".join(lines) + "\n")
    parquet.write_table(pyarrow.table(table), columns, write_page_checksum=True)
    with bag.open("wb") as stream:
        writer = mcap.Writer(stream)
        writer.start()
        schema = writer.register_schema(name="any", encoding="jsonschema", data=b"{}")
        topic = writer.register_channel("/a", "json", schema)
        for t, q, i in zip(T, Q, EFFORT, strict=True):
            writer.add_message(topic, round(1e9 * t), json.dumps({"q1": q, "i1": i}).encode(), round(1e9 * t))
        writer.finish()
    found = {"csv": (csv, PLAIN), "parquet": (columns, PLAIN), "mcap": (bag, JSON)}
    for kind, packed in (("mat", False), ("packed mat", True)):
        found[kind] = folder / f"{kind}.mat", PLAIN
        savemat(found[kind][0], {"t": T, "q": {"q1": Q}, "i1": EFFORT}, do_compression=packed)
    found["npz"] = folder / "a.npz", PLAIN
    np.savez(found["npz"][0], **table)
    files = {kind: (file, text, file.read_bytes()) for kind, (file, text) in found.items()}
    return files | {"mapping": (csv, PLAIN, PLAIN.encode())}


def edited(data: bytes, rng: np.random.Generator) -> bytes:
    for _ in range(rng.integers(1, 4)):
        place, length = int(rng.integers(0, len(data) + 1)), int(rng.choice([0, 1, 1, 2, 9]))
        data = data[:place] + PIECES[rng.integers(len(PIECES))] + data[place + length :]
    return data if rng.random() < 0.95 else data[: rng.integers(len(data) + 1)]


def attempts(kind: str, count: int, folder: Path, seed: int = 0) -> int:
    """Edit a file `count` times; the number of records read. Fails at a traceback or a shifted column."""
    rng, accepted = np.random.default_rng(seed), 0
    file, text, data = made(folder)[kind]
    mapping = folder / "mapping.yaml"
    mapping.write_text(text)
    for number in range(count):
        (mapping if kind == "mapping" else file).write_bytes(edited(data, rng))
        try:
            record = read(str(file), ARM, mapping)
            inspect(str(file))
        except InputError as error:
            said = str(error)
        else:
            said = ""
        assert "\n" not in said, (kind, seed, number)
        if said:
            continue
        accepted += 1
        if kind != "mapping":  # an edited number is another number, and a column is where it was
            assert abs(float(np.median(record.input)) - 30.5) < 1.0, (kind, seed, number)
            assert float(np.median(np.abs(record.q))) < 0.8, (kind, seed, number)
    return accepted


@pytest.mark.parametrize("kind", KINDS)
def test_edited_files(kind: str, tmp_path: Path) -> None:
    attempts(kind, 60, tmp_path)


if __name__ == "__main__":
    each, start = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    for name in KINDS:
        with tempfile.TemporaryDirectory() as place:
            read_rightly = attempts(name, each, Path(place), start)
        sys.stdout.write(f"{name}: {each} edits, {read_rightly} records, no traceback\n")
