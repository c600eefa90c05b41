"""A watch beside a controller; see README.md beside this file.

    python examples/watch/run.py [--hours H]     prints the figures and writes watch.json

Logs of a simulated arm are identified, the watch generated from identification.json, and the arm runs on: a
day without an event, then friction that rises, a payload, an end stop. The seconds before each alarm run once
more on a Cortex-M4F, emulated within Python.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE), str(ROOT / "benchmarks")]

import numpy as np  # noqa: E402
from watch_board import Board  # noqa: E402
from watch_loop import JOINTS, built, simulated  # noqa: E402

import modelgen as mg  # noqa: E402
from modelgen.description import Arm  # noqa: E402
from modelgen.functions.nominal import grouped, nominal_standard  # noqa: E402
from modelgen.resources import shipped_arms  # noqa: E402

ARM = "ariane4"
CENTRE = np.radians([-29.0, 50.0, 177.0])
# Of each joint two sines: amplitudes [deg] and periods [s], of training, test, and the work that is watched.
MOTIONS = {
    "train": (((35, 8), (30, 7), (42, 12)), ((11.0, 3.1), (24.0, 5.3), (13.0, 3.7))),
    "test": (((30, 10), (28, 8), (38, 14)), ((9.7, 2.9), (21.0, 6.1), (12.1, 4.3))),
    "work": (((33, 8), (29, 8), (40, 12)), ((10.3, 3.3), (23.0, 5.9), (12.7, 4.1))),
}
NOISE = {"noise": [0.01, 0.01, 0.01], "noise_time": 0.02}  # of the measured currents [A], [s]
SMOOTHING = 0.05  # of the motors' largest speed
RISE, HOUR = 0.10, 3600.0  # of the friction, over an hour
SHARE, BEGIN = 0.01, 900.0  # of the arm's mass; when payload and end stop appear [s]
FRICTION = ("FC2", "FV2")


def smoothed(arm: Arm) -> Arm:
    """The arm with dry friction that turns round within a twentieth of the motors' speed.

    A sign would follow the noise of the measured speed where a joint turns back.
    """
    joints = []
    for joint in arm.joints:
        effects = list(joint.effects)
        for k, use in enumerate(effects):
            if use.name == "coulomb_friction" and joint.drive.driven:
                speed = SMOOTHING * float(joint.drive.limits.velocity or 1.0)
                effects[k] = replace(use, values={**use.values, "smoothing": speed})
        joints.append(replace(joint, effects=tuple(effects)))
    return replace(arm, joints=tuple(joints))


def motion(name: str) -> dict[str, Any]:
    """Fields of the loop."""
    amplitudes, periods = MOTIONS[name]
    return {"centre": CENTRE, "amplitude": np.radians(amplitudes), "frequency": 2 * np.pi / np.array(periods)}


def identification(arm: Any, true: np.ndarray, folder: Path) -> dict[str, Any]:
    """identification.json of logs of the simulated arm."""
    mg.generate(arm, folder / "generated", mg.ModelOptions(derivatives=False))
    library = built(folder / "generated" / ARM, folder / "plain", watching=False)
    tables = {}
    for k, name in enumerate(("train", "test")):
        values = {**motion(name), **NOISE, "parameters": true, "assumed": true, "seed": 7 + k}
        _, log, _ = simulated(library, 300.0, values, record=True)
        columns = ["t", *(f"qm{j + 1}" for j in range(JOINTS)), *(f"i{j + 1}" for j in range(JOINTS))]
        tables[name] = dict(zip(columns, log.T, strict=True))
    found: dict[str, Any] = mg.identify(arm, tables["train"], tables["test"]).to_json()
    return found


def figures(hours: float, folder: Path) -> dict[str, Any]:
    """What happens in so many hours without an event, and at each event. folder: of sources and programs."""
    arm = smoothed(mg.load_arms(shipped_arms())[ARM])
    made = mg.build_model(arm)
    standard = nominal_standard(made.built)
    true = np.array(list(grouped(made.built, list(standard.values())).values()))
    names = [b.name for b in made.built.grouping.base]
    mass = sum(standard[f"M{i + 1}"] for i in range(len(arm.joints)))
    payload = [SHARE * mass if name == "M4" else 0.0 for name in standard]
    data = identification(arm, true, folder)
    mg.generate(arm, folder, identification=data)
    library = built(folder / ARM, folder / "watched", watching=True)
    board = Board(folder / ARM, folder / "board")
    assumed = [p["value"] for p in data["parameters"]]
    work = {**motion("work"), **NOISE, "parameters": true, "assumed": assumed, "seed": 3, "watching": 1}
    quiet, _, _ = simulated(library, hours * HOUR, work)
    summary: dict[str, Any] = {"quiet": {"hours": hours, "alarms": quiet.alarms}}
    drift = [RISE * true[k] if n in FRICTION else 0.0 for k, n in enumerate(names)]
    events: dict[str, tuple[dict[str, Any], float]] = {
        "friction": ({"drift": drift, "drift_time": HOUR}, HOUR),
        "payload": ({"jump": list(grouped(made.built, payload).values()), "jump_time": BEGIN}, HOUR),
        "end_stop": ({"stop": 0.0, "stop_time": BEGIN, "stiffness": 5000.0}, HOUR),
    }
    for event, (fields, duration) in events.items():
        found, _, last = simulated(library, duration, {**work, **fields, "until_alarm": 1})
        times = [t for t in (found.outside_time, found.changed_time) if t >= 0]
        begin = {"friction": 0.0, "payload": BEGIN, "end_stop": found.touched_time}[event]
        summary[event] = {
            "detected_after_s": round(times[0] - begin, 3) if times else None,
            "observer": found.outside,
            "monitor": found.changed,
            "board": bool(times) and board.agrees(last, found),
        }
    found, _, _ = simulated(library, HOUR, {**work, **events["payload"][0]})
    summary["payload"]["named_after_s"] = round(found.named_time[2] - BEGIN, 3)
    summary["payload"]["mass_kg"] = round(SHARE * mass, 3)
    summary["instructions"] = board.instructions()
    return summary


def main(arguments: Sequence[str]) -> int:
    """Run and print."""
    parser = argparse.ArgumentParser(description="A watch beside a controller.")
    parser.add_argument("--hours", type=float, default=24.0, help="without an event (default: 24)")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as name:
        summary = figures(given.hours, Path(name))
    print(json.dumps(summary, indent=2))
    (HERE / "watch.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
