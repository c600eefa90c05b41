"""Tracking of a levered arm with and without its model in the controller; see README.md beside this file.

    python examples/firmware/run.py [--python]     writes tracking.png and tracking.json

The controller runs on a Cortex-M4F in QEMU where that and arm-none-eabi-gcc are installed, else (or with
--python) in a processor emulated within Python.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent.parent / "benchmarks")]

import numpy as np  # noqa: E402
from firmware.targets import M4F  # noqa: E402
from tracking_board import controller, program  # noqa: E402
from tracking_loop import MODES, Plant, Record, closed_loop, plant_library  # noqa: E402
from tracking_plot import plot  # noqa: E402
from tracking_values import CURRENT_LIMIT, model, values  # noqa: E402

DURATION = 15.0  # s


def runs(qemu: bool, duration: float) -> list[Record]:
    """The same motion in every mode."""
    v = values(model())
    records = []
    with tempfile.TemporaryDirectory() as name:
        compiled, library = program(v, Path(name), qemu=qemu), plant_library(Path(name))
        for mode in range(len(MODES)):
            folder = Path(name) / str(mode)
            folder.mkdir()
            with controller(compiled, folder, qemu=qemu) as board:
                records.append(closed_loop(board, Plant(v, library), mode, duration))
    return records


def main(arguments: Sequence[str]) -> int:
    """Run, print the errors, write the plot."""
    parser = argparse.ArgumentParser(description="Computed-torque control on an emulated Cortex-M4F.")
    parser.add_argument("--python", action="store_true", help="emulate within Python")
    given = parser.parse_args(arguments)
    if M4F.missing and not given.python:
        print(f"{M4F.missing} not installed: emulated within Python instead", file=sys.stderr)
    records = runs(qemu=not (M4F.missing or given.python), duration=DURATION)
    summary = {
        mode: {
            "rms_deg": [round(float(x), 4) for x in np.degrees(record.rms)],
            "largest_current_a": round(float(np.abs(record.current).max()), 3),
        }
        for mode, record in zip(MODES, records, strict=True)
    }
    print(json.dumps(summary, indent=2))
    (HERE / "tracking.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    plot(records, MODES, CURRENT_LIMIT, HERE / "tracking.png")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
