"""Errors of a description that are far beyond a slope: their value, and what it is worth on another record.

The plant is a planar arm by Lagrange's equations; the description has another torque constant than it.
"""

from pathlib import Path

import pytest
from made_up_plants import CONSTANT, PLAIN, description, log

import modelgen as mg
from modelgen.charts import number
from modelgen.description import loads
from modelgen.effects import known_effects


@pytest.mark.parametrize("error", [-0.5, -0.3, 0.8])
def test_a_torque_constant_is_found_however_far_it_is_off(error: float, tmp_path: Path) -> None:
    """The inputs are as the reciprocal of the constant: at -0.5 they are twice what was described."""
    told = f"torque_constant: {CONSTANT[1]}"
    text = description(2).replace(told, f"torque_constant: {CONSTANT[1] / (1 + error)!r}")
    assert told not in text
    arm = loads(text, "arms.yaml", known_effects())["made_up"]
    logs = [log(tmp_path / f"{k}.csv", PLAIN[2], k) for k in range(3)]
    found = mg.diagnose(arm, logs[:2], logs[2], experiment=False).to_json()
    (cause,) = found["causes"]
    assert cause["effect"] == "drive_gain_error"
    value = cause["parameters"]["error"]
    # of either drive, by the other one
    true = error if cause["joint"] == 2 else 1 / (1 + error) - 1
    assert abs(value["value"] - true) < 4 * value["std"] < 0.2 * abs(true)
    checks = {c["name"]: c for c in cause["checks"]}
    assert checks["confirmed"]["passed"]
    # the figure of a check is that of the table
    assert f"error is {number(value['value'])}," in checks["admissible"]["text"]
