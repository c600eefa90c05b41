"""Logs of other people's arms, read through the shipped mappings. Skipped where the logs are absent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from modelgen.backends.numpy import NumpyFunction
from modelgen.dataset import Record, Settings, choose, prepare, read
from modelgen.description import Arm, load
from modelgen.effects import known_effects
from modelgen.functions import Options, build_model

ROOT = Path(__file__).resolve().parents[2]
STUDIES = ROOT / "examples" / "case_studies"
DATA = ROOT.parent / "shared" / "data"

pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="needs the measured logs beside the repository")


def arm(name: str) -> Arm:
    return next(iter(load(STUDIES / f"{name}_arm.yaml", known_effects()).values()))


def record(name: str, file: str, mapping: str = "") -> Record:
    return read(str(DATA / file), arm(name), STUDIES / f"{mapping or name}_mapping.yaml")


def fitted(records: Sequence[Record], cutoff: float) -> tuple[dict[str, float], np.ndarray]:
    """Least squares weighted by joint: parameters by name, and RMS residuals by joint."""
    a = records[0].arm
    assert a is not None
    model = build_model(a, Options())
    regressor = NumpyFunction(next(f for f in model.functions if f.name == "regressor"))
    settings = choose(records, Settings(cutoff=cutoff))
    rows = []
    for p in (prepare(r, settings) for r in records):
        columns = p.parallel(regressor(p.q, p.dq, p.ddq))
        rows.append([(columns[p.moving[:, k], k], p.effort[p.moving[:, k], k]) for k in range(p.n)])
    joints = [
        tuple(np.concatenate(part) for part in zip(*joint, strict=True)) for joint in zip(*rows, strict=True)
    ]
    scale = np.ones(len(joints))
    for _ in range(3):
        wide = np.concatenate([w / s for (w, _), s in zip(joints, scale, strict=True)])
        high = np.concatenate([y / s for (_, y), s in zip(joints, scale, strict=True)])
        size = np.linalg.norm(wide, axis=0)
        values = np.linalg.lstsq(wide / size, high, rcond=None)[0] / size
        scale = np.array([np.sqrt(np.mean((y - w @ values) ** 2)) for w, y in joints])
    return dict(zip((b.name for b in model.grouping.base), values, strict=True)), scale


def without_rotors(found: Record) -> Record:
    """As the published model is."""
    assert found.arm is not None
    joints = [
        replace(j, effects=tuple(e for e in j.effects if e.name != "drive_inertia")) for j in found.arm.joints
    ]
    return replace(found, arm=replace(found.arm, joints=tuple(joints)))


def test_emps_gives_the_published_parameters() -> None:
    # Janot, Gautier and Brunot (2019): 95.1 kg, 203.5 N s/m, 20.4 N, -3.2 N.
    values, _ = fitted([record("emps", "emps/emps_train.csv")], 20.0)
    assert values["M1"] == pytest.approx(95.1, rel=0.02)
    assert values["FV1"] == pytest.approx(203.5, rel=0.02)
    assert values["FC1"] == pytest.approx(20.4, rel=0.02)
    assert values["FO1"] == pytest.approx(-3.2, abs=0.2)


def test_emps_effort_is_the_published_force() -> None:
    file = "emps/emps_train.csv"
    force = np.genfromtxt(DATA / file, delimiter=",", names=True)["force"]
    assert record("emps", file).input[:, 0] == pytest.approx(force, rel=1e-5)


def test_tx40_gives_the_published_friction() -> None:
    # figaroh-examples, examples/staubli_TX40: viscous friction of joints 1 to 4, and the coupled motor's.
    values, residual = fitted([record("tx40", "tx40/tx40_motor.csv@0:7.4")], 10.0)
    found = [values[f"FV{k}"] for k in (1, 2, 3, 4)]
    assert found == pytest.approx([8.05, 5.53, 1.97, 1.11], rel=0.1)
    assert values["IC6"] == pytest.approx(0.00964, rel=0.15)
    # What the reference models leave over, by joint, relative to the effort.
    effort = prepare(record("tx40", "tx40/tx40_motor.csv@0:7.4"), Settings(cutoff=10.0)).effort
    share = residual / np.sqrt(np.mean(effort**2, axis=0))
    assert np.all(share < [0.067, 0.065, 0.1, 0.089, 0.31, 0.2])


def test_dfki_gives_the_published_first_moment() -> None:
    # Masses 0.642 and 0.564 kg at 0.2 m, the elbow at 0.2 m: 0.2412 kg m about the shoulder.
    files = sorted((DATA / "dfki_double_pendulum_C0").glob("C0_0?.csv"))
    values, _ = fitted([without_rotors(record("dfki", str(f))) for f in files], 4.0)
    assert values["MX1R"] == pytest.approx(0.2412, rel=0.02)


def test_bam_is_a_pendulum_of_the_described_mass_under_a_voltage() -> None:
    files = sorted((DATA / "bam_xl330").glob("*sin_time_square.csv"))
    records = [record("bam", str(f)) for f in files]
    assert all(r.effort_unit == ("V",) and "back-EMF" in r.remarks[0] for r in records)
    assert np.ptp([1 / r.step for r in records]) < 2.0
    assert all(r.temperature is not None and 27 < r.temperature.mean() < 40 for r in records)


def test_ur10_is_read_from_its_bag() -> None:
    found = record("ur10", "ur10_unisa/ur10_exciting_trajectory.db3@0:20")
    assert len(found.t) == 2501
    assert 1 / found.step == pytest.approx(125.0, rel=1e-3)
    assert found.effort_unit == ("A",) * 6
    # The maker's masses of links 2 to 6 and the centre of link 2 (Universal Robots, "Parameters for
    # calculations of kinematics and dynamics"): 12.7 kg at 0.612 - 0.38 m, and 8.635 kg at the elbow. x of
    # the shoulder points away from the elbow.
    values, _ = fitted([found], 8.0)
    assert values["MX2R"] == pytest.approx(-(12.7 * (0.612 - 0.38) + 8.635 * 0.612), rel=0.05)


def test_laas_logs_are_resampled() -> None:
    slow = record("laas", "laas_cogging/laas_stopped.csv", "laas_slow")
    assert slow.step == pytest.approx(0.1)
    assert np.ptp(slow.q) == pytest.approx(2 * np.pi, rel=0.05)
    quick = record("laas", "laas_cogging/laas_speed_test.csv")
    # The drive's own estimate of the speed, which it logs beside the position.
    own = np.genfromtxt(DATA / "laas_cogging/laas_speed_test.csv", delimiter=",", names=True)
    p = prepare(quick, Settings(cutoff=20.0, trim=0.5))
    ours = p.parallel(p.dq)[:, 0]
    theirs = p.parallel(np.interp(p.time, own["t"], own["dq"])[:, None])[:, 0]
    assert np.sqrt(np.mean((ours - theirs) ** 2)) < 0.02 * np.mean(theirs)
