"""Records of the experiment as modelgen reads them, and the parameters that are true of the simulated arm."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML
from twin_body import LINKS, MOTORS
from twin_plant import Recording, record

from modelgen.dataset import Record, drives_of
from modelgen.description import Arm, loads
from modelgen.functions import build_model
from modelgen.functions.nominal import nominal_base

Array = NDArray[np.float64]
HERE = Path(__file__).resolve().parent
ARMS = HERE.parents[1] / "arms.yaml"
ARM = "ariane4"
PERIODS = 2  # of the trajectory in a record
MARKER = 0.0235  # rad, standard deviation of an angle from a marker under a camera
# What a tape measure made of the third lever, 6 to 7 mm off; the joint's range is left out till calibration.
DRAWN = (
    ("l1: 0.489\n", "l1: 0.495\n"),
    ("l2: 0.054\n", "l2: 0.061\n"),
    ("length: [0.437448, 0.536595]", "length: [0.437448, 0.531]"),
    ("limits: {position: [110 deg, 244 deg], velocity: 25 deg}", "limits: {velocity: 25 deg}"),
)


def set_points(path: Path) -> tuple[Array, Array]:
    """Times (N,) [s] and motor coordinates (N, 3) [increments] of `modelgen excite`."""
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    return table[:, 0], table[:, 1:]


def recorded(points: Path, seed: int, periods: int = PERIODS) -> Recording:
    """The arm tracks the set-points of a file."""
    return record(*set_points(points), periods, seed)


def write_log(recording: Recording, path: Path, current: Array) -> None:
    """CSV: t [s], qm1 ... [whole increments], i1 ... [A]."""
    names = ["t", *(f"{x}{k + 1}" for x in ("qm", "i") for k in range(3))]
    rows = np.column_stack([recording.t, recording.counts, current])
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savetxt(path, rows, "%.9g", ",", header=",".join(names), comments="")


def write_calibration(recording: Recording, folder: Path) -> None:
    """marker.csv: t, qm3, q3 [rad] under a camera; measured_arms.yaml: the description with wrong lengths."""
    noise = MARKER * np.random.default_rng(0).normal(size=len(recording.t))
    rows = np.column_stack([recording.t, recording.counts[:, 2], recording.q[:, 2] + noise])
    np.savetxt(folder / "marker.csv", rows, "%.9g", ",", header="t,qm3,q3", comments="")
    text = ARMS.read_text(encoding="utf-8")
    for old, new in DRAWN:
        if old not in text:
            raise ValueError(f"{ARMS}: found no '{old.strip()}'")
        text = text.replace(old, new, 1)
    (folder / "measured_arms.yaml").write_text(text, encoding="utf-8")


def as_record(recording: Recording, arm: Arm) -> Record:
    """The same without a file: what `modelgen.dataset.read` makes of it."""
    drives = drives_of(arm)
    q = np.column_stack([d.joint(recording.counts[:, k]) for k, d in enumerate(drives)])
    return Record(
        name="experiment",
        t=recording.t,
        q=q,
        motor=recording.counts,
        input=recording.sample,
        gain=np.ones_like(q),
        effort_unit=("A",) * 3,
        motor_side=(True,) * 3,
        arm=arm,
    )


def truth() -> dict[str, float]:
    """Base parameters of the simulated arm: its inertials and frictions put into the description."""
    yaml = YAML(typ="safe")
    document = yaml.load(ARMS.read_text(encoding="utf-8"))
    arm = document["arms"][ARM]
    document["arms"] = {ARM: arm}
    arm["links"] = {
        name: {"mass": mass, "com": list(com), "inertia": list(inertia)}
        for name, (mass, com, inertia) in LINKS.items()
    }
    for joint, motor in zip(arm["joints"], MOTORS, strict=False):  # the fourth is locked
        joint["effects"] = [
            {"viscous_friction": {"coefficient": motor.viscous}},
            {"coulomb_friction": {"magnitude": motor.dry}},
            {"drive_inertia": {"inertia": motor.inertia}},
        ]
    return nominal_base(build_model(_loaded(document)))


def _loaded(document: Any) -> Arm:
    text = io.StringIO()
    YAML(typ="safe").dump(document, text)
    return loads(text.getvalue())[ARM]
