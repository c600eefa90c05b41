"""Logs of MATLAB and NumPy: the same record as the text file of the same numbers, or one line that helps."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from modelgen.dataset import read
from modelgen.dataset.inspection import inspect
from modelgen.description import Arm, loads
from modelgen.errors import InputError

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    joints:
      - {name: hip, drive: {type: direct, ratio: 1, torque_constant: 1}}
      - {name: knee, d: 0.3, drive: {type: direct, ratio: 1, torque_constant: 1}}
"""
)["two"]
T = np.arange(300) / 100.0
Q = np.stack([np.sin(T), 0.5 * np.cos(3.0 * T)], axis=1)
CURRENT = np.random.default_rng(0).normal(size=Q.shape)
MAPPING = """schema: 1
time: {{column: {0}time}}
joints:
  - {{position: {{column: {0}y1, unit: deg}}, effort: {{column: {0}u1, unit: A}}}}
  - {{position: {{column: {0}y2, unit: deg}}, effort: {{column: {0}u2, unit: A}}}}
"""


def same(path: Path, arm: Arm = ARM, mapping: Path | None = None, rows: slice = slice(None)) -> None:
    found = read(str(path), arm, mapping)
    assert found.input is not None
    np.testing.assert_allclose(found.q, Q[rows], atol=1e-12)
    np.testing.assert_allclose(found.input, CURRENT[rows], atol=1e-12)


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize("across", [False, True])
def test_a_matrix_of_matlab_is_a_column_for_each_joint(
    compressed: bool, across: bool, tmp_path: Path
) -> None:
    """Upright or lying, packed or not, beside single numbers and words."""
    path = tmp_path / "log.mat"
    tables = {"q": Q, "i": CURRENT}
    columns = {"t": T[None, :] if across else T[:, None]}
    columns |= {name: x.T if across else x for name, x in tables.items()}
    savemat(path, columns | {"fs": 100.0, "who": "rig 3"}, do_compression=compressed)
    same(path)
    assert [c.name for c in inspect(str(path), ARM).channels] == ["q1", "q2", "i1", "i2"]


@pytest.mark.parametrize("order", ["<", ">"])
def test_numbers_may_stand_in_either_order(order: str, tmp_path: Path) -> None:
    """A file written byte by byte after the format's description: SciPy writes one order alone."""

    def element(kind: int, data: bytes) -> bytes:
        return struct.pack(f"{order}II", kind, len(data)) + data + bytes(-len(data) % 8)

    def matrix(name: str, values: np.ndarray) -> bytes:
        parts = [
            element(6, struct.pack(f"{order}II", 6, 0)),  # a full array of doubles
            element(5, struct.pack(f"{order}ii", *values.shape)),
            element(1, name.encode()),
            element(9, values.T.astype(f"{order}f8").tobytes()),
        ]
        return element(14, b"".join(parts))

    head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack(f"{order}H", 0x0100)
    head += b"IM" if order == "<" else b"MI"
    arrays = {"t": T[:, None], "q": Q, "i": CURRENT}
    (tmp_path / "log.mat").write_bytes(head + b"".join(matrix(*x) for x in arrays.items()))
    same(tmp_path / "log.mat")


def test_fields_of_a_struct_are_columns_by_their_names(tmp_path: Path) -> None:
    path = tmp_path / "log.mat"
    savemat(path, {"log": {"t": T, "q": Q, "i": CURRENT, "about": {"rate": 100.0}}})
    same(path)


def test_two_records_of_a_file_are_told_apart_by_a_mapping(tmp_path: Path) -> None:
    path, mapping = tmp_path / "both.mat", tmp_path / "mapping.yaml"
    half = slice(0, 150)
    short = {"time": T[half], "y": np.degrees(Q[half]), "u": CURRENT[half]}
    savemat(path, {"train": {"time": T, "y": np.degrees(Q), "u": CURRENT}, "test": short})
    for name, rows in (("train.", slice(None)), ("test.", half)):
        mapping.write_text(MAPPING.format(name), encoding="utf-8")
        same(path, mapping=mapping, rows=rows)
    seen = inspect(str(path))
    assert {c.name.partition(".")[0] for c in seen.channels} == {"train"}
    assert any("more than one record" in remark for remark in seen.remarks)


def test_arrays_of_numpy_are_columns(tmp_path: Path) -> None:
    """By name, as fields, and by the names that a mapping gives."""
    np.savez_compressed(tmp_path / "log.npz", t=T, q=Q, i=CURRENT)
    same(tmp_path / "log.npz")
    fields = np.zeros(len(T), dtype=[(name, float) for name in ("t", "q1", "q2", "i1", "i2")])
    table = np.column_stack([T, Q, CURRENT])
    for name, column in zip(fields.dtype.names or (), table.T, strict=True):
        fields[name] = column
    np.save(tmp_path / "fields.npy", fields)
    same(tmp_path / "fields.npy")
    np.save(tmp_path / "bare.npy", table)
    with pytest.raises(InputError, match=r"5 columns without names; `columns: \[t, q1, i1\]`"):
        read(str(tmp_path / "bare.npy"), ARM)
    mapping = tmp_path / "mapping.yaml"
    named = MAPPING.format("").replace("deg", "rad") + "columns: [time, y1, y2, u1, u2]\n"
    mapping.write_text(named, encoding="utf-8")
    same(tmp_path / "bare.npy", mapping=mapping)


def test_what_cannot_be_read_says_how_to_export_it(tmp_path: Path) -> None:
    path = tmp_path / "log.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(512) + b"\x89HDF\r\n\x1a\n" + bytes(200))
    with pytest.raises(InputError, match=r"MATLAB 7\.3, expected .*: save\('log\.mat', '-v7'\)"):
        read(str(path), ARM)
    savemat(path, {"fs": 100.0, "who": "rig 3"})
    with pytest.raises(InputError, match=r"no array of numbers.*writetimetable"):
        read(str(path), ARM)
    path.write_bytes(b"t,q1\n0,1\n")
    with pytest.raises(InputError, match="no MATLAB file of version 5 to 7"):
        read(str(path), ARM)
    (tmp_path / "log.npz").write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(InputError, match="no file of NumPy's arrays, or a damaged one"):
        read(str(tmp_path / "log.npz"), ARM)
    np.savez(tmp_path / "log.npz", t=T, q=np.array([{}, None], dtype=object), allow_pickle=True)
    with pytest.raises(InputError, match="no file of NumPy's arrays, or a damaged one"):
        read(str(tmp_path / "log.npz"), ARM)


def test_names_in_a_comment_above_the_numbers_are_the_header(tmp_path: Path) -> None:
    """As numpy.savetxt writes them; words that are no names are no header."""
    path = tmp_path / "log.dat"
    table = np.column_stack([T, Q, CURRENT])
    for delimiter, names in ((" ", "t q1 q2 i1 i2"), (",", "t,q1,q2,i1,i2"), (" ", "t, q1, q2, i1, i2")):
        np.savetxt(path, table, delimiter=delimiter, header=f"rig 3, Monday\n{names}")
        same(path)
        assert any("those of a comment" in remark for remark in read(str(path), ARM).remarks)
    np.savetxt(path, table, header="measured on the rig 3")
    with pytest.raises(InputError, match="expected the names of the columns"):
        read(str(path), ARM)
