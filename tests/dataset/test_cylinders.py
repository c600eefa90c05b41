"""Cylinders on levers that report their length and force, as hydraulic and electric ones do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dataset_support import DRIVEN, LEVER, columns, times, write_csv

import modelgen as mg

MAP = """
schema: 1
joints:
  - {position: {column: q1, unit: rad}, effort: {column: i1, unit: A}}
  - {position: {column: length, unit: LENGTH, side: motor}, effort: {column: force, unit: FORCE, side: motor}}
"""
PER_METRE = LEVER["counts"] / (LEVER["high"] - LEVER["low"])
TORQUE_CONSTANT = 1e-4  # J per increment per A


@pytest.mark.parametrize(("length", "metres"), [("mm", 1e-3), ("m", 1.0)])
@pytest.mark.parametrize(("force", "newtons"), [("N", 1.0), ("kN", 1e3)])
def test_length_and_force_are_increments_and_current(
    length: str, metres: float, force: str, newtons: float, tmp_path: Path
) -> None:
    table = columns(times())
    plain = mg.read_log(table, DRIVEN)
    cylinder = {name: table[name] for name in ("t", "q1", "i1")}
    cylinder["length"] = (LEVER["low"] + table["qm2"] / PER_METRE) / metres
    # work: force times dL = torque constant times current times dq_m
    cylinder["force"] = table["i2"] * TORQUE_CONSTANT * PER_METRE / newtons
    mapping = tmp_path / "map.yaml"
    mapping.write_text(MAP.replace("LENGTH", length).replace("FORCE", force))
    for log in (write_csv(tmp_path / "log.csv", cylinder), cylinder):
        found = mg.read_log(log, DRIVEN, mapping=mapping)
        np.testing.assert_allclose(found.q, plain.q, atol=1e-9)
        np.testing.assert_allclose(found.motor, plain.motor, rtol=1e-9, atol=1e-6)
        np.testing.assert_allclose(found.input, plain.input, rtol=1e-9, atol=1e-9)
        assert found.effort_unit == ("A", "N")
        logged = (found.input * found.gain)[:, 1]
        np.testing.assert_allclose(logged, cylinder["force"] * newtons, rtol=1e-9)


def test_a_torque_is_no_force(tmp_path: Path) -> None:
    mapping = tmp_path / "map.yaml"
    mapping.write_text(MAP.replace("LENGTH", "mm").replace("FORCE", "N m"))
    table = columns(times())
    table |= {"length": table["qm2"], "force": table["i2"]}
    with pytest.raises(mg.InputError, match="expected a force's for joint knee"):
        mg.read_log(table, DRIVEN, mapping=mapping)
