"""Logs that identify refuses: one line, exit 2, nothing written. An arm of two undriven joints."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import CliRunner

from modelgen.cli.app import app

Array = NDArray[np.float64]
HEADER = "t,q1,q2,tau1,tau2"
ARM = """schema: 1
convention: khalil_kleinfinger
arms:
  two:
    joints:
      - {name: j1, alpha: pi/2, limits: {position: [-100 deg, 100 deg]}, effects: [coulomb_friction]}
      - {name: j2, d: 0.4, limits: {position: [-100 deg, 100 deg]}, effects: [coulomb_friction]}
"""


def motion(seed: int = 1) -> Array:
    """Time, positions, efforts (N, 5)."""
    rng, t = np.random.default_rng(seed), np.arange(1500) / 100
    q = [0.5 * np.sin(1.9 * t + k) + 0.3 * np.sin(4.4 * t + seed) for k in range(2)]
    effort = [np.cos(1.9 * t + k) + 0.01 * rng.normal(size=len(t)) for k in range(2)]
    return np.column_stack([t, *q, *effort])


def setting(column: int, rows: slice, value: float) -> Callable[[Array], Array]:
    """The table with other values in it."""

    def change(table: Array) -> Array:
        table[rows, column] = value
        return table

    return change


def scaled(table: Array) -> Array:
    table[:, 1:3] *= 180.0 / np.pi
    return table


def reversed_time(table: Array) -> Array:
    table[700:710, 0] = table[700:710, 0][::-1].copy()
    return table


@pytest.mark.parametrize(
    ("change", "header", "message"),
    [
        (lambda x: x[:, [0, 1, 3, 4]], "t,q1,tau1,tau2", "q2"),
        (lambda x: np.column_stack([x, x[:, 1]]), HEADER + ",q1", "the column q1 stands there 2 times"),
        (reversed_time, HEADER, "time runs backwards after t = "),
        (lambda x: np.delete(x, slice(500, 700), axis=0), HEADER, "found a gap of 2.01 s after t = 4.99 s"),
        (setting(3, slice(50, 51), np.nan), HEADER, "found nan in the column tau1 at t = 0.5 s"),
        (setting(2, slice(None), 0.3), HEADER, "the position q2 is 0.3 in all 1500 samples"),
        (setting(4, slice(None), 1.0), HEADER, "the effort tau2 is 1 in all 1500 samples"),
        (scaled, HEADER, "these look like degrees"),
        (lambda x: x[:30], HEADER, "too short a record"),
        (lambda x: x[:0], HEADER, "found 0 samples"),
    ],
)
@pytest.mark.parametrize("bad", ["train", "test"])
def test_what_cannot_be_identified_from_is_refused(
    tmp_path: Path, bad: str, change: Callable[[Array], Array], header: str, message: str
) -> None:
    (tmp_path / "arm.yaml").write_text(ARM, encoding="utf-8")
    for seed, name in enumerate(("train", "test"), 1):
        table = motion(seed)
        names = HEADER
        if name == bad:
            table, names = change(table), header
        np.savetxt(tmp_path / f"{name}.csv", table, fmt="%.9g", delimiter=",", header=names, comments="")
    call = ["identify", str(tmp_path / "arm.yaml"), "--arm", "two", "--out", str(tmp_path / "out")]
    logs = ["--train", str(tmp_path / "train.csv"), "--test", str(tmp_path / "test.csv")]
    result = CliRunner().invoke(app, [*call, *logs])
    assert result.exit_code == 2, result.output
    assert message in result.output
    assert result.output.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_an_effort_without_a_unit_is_refused(tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(ARM, encoding="utf-8")
    joint = "  - {position: {column: q%d, unit: rad}, effort: {column: tau%d}}\n"
    mapping = "schema: 1\ntime: {column: t, unit: s}\njoints:\n" + joint % (1, 1) + joint % (2, 2)
    (tmp_path / "mapping.yaml").write_text(mapping, encoding="utf-8")
    np.savetxt(tmp_path / "a.csv", motion(), fmt="%.9g", delimiter=",", header=HEADER, comments="")
    call = ["identify", str(tmp_path / "arm.yaml"), "--arm", "two", "--train", f"{tmp_path / 'a.csv'}@0:10"]
    call += ["--test", f"{tmp_path / 'a.csv'}@10:15", "--mapping", str(tmp_path / "mapping.yaml")]
    result = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "out")])
    assert result.exit_code == 2, result.output
    assert "effort: the key 'unit' is missing" in result.output
    assert not (tmp_path / "out").exists()


def test_a_mapping_that_declares_a_duty_cycle_is_told_what_that_means(tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(ARM, encoding="utf-8")
    joint = "  - {position: {column: q%d, unit: rad}, effort: {column: tau%d, unit: duty}}\n"
    mapping = "schema: 1\ntime: {column: t, unit: s}\njoints:\n" + joint % (1, 1) + joint % (2, 2)
    (tmp_path / "mapping.yaml").write_text(mapping, encoding="utf-8")
    np.savetxt(tmp_path / "a.csv", motion(), fmt="%.9g", delimiter=",", header=HEADER, comments="")
    call = ["identify", str(tmp_path / "arm.yaml"), "--arm", "two", "--train", f"{tmp_path / 'a.csv'}@0:10"]
    call += ["--test", f"{tmp_path / 'a.csv'}@10:15", "--mapping", str(tmp_path / "mapping.yaml")]
    result = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "out")])
    assert result.exit_code == 0, result.output
    assert "back-EMF sits in the viscous friction" in result.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "back-EMF" in page
    assert '<iframe title="the arm two" srcdoc="' in page
