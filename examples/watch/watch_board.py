"""The watch, compiled for a Cortex-M4F and run under emulation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from firmware.build import zig_link
from firmware.machine import Machine
from firmware.targets import M4F
from numpy.typing import NDArray
from watch_loop import HERE, JOINTS, RESULT, SLOW, STATES

ALARMS = STATES + JOINTS  # where the result has them


class Board:
    """A processor with the watch in it."""

    def __init__(self, generated: Path, folder: Path) -> None:
        folder.mkdir()
        sources = [*sorted((generated / "src").glob("*.c")), HERE / "watch.c"]
        flags = ["-DARIANE4_REAL=float", f"-I{generated / 'include'}", f"-I{HERE}"]
        _, program = zig_link(M4F, sources, flags, folder)
        self.machine = Machine(program, M4F, count=True)
        self.steps: list[tuple[bool, int]] = []

    def agrees(self, given: NDArray[np.float32], found: Any) -> bool:
        """Whether the board, from the states at the first row of `given` on, comes to the same alarm at the
        last row, and to none before.
        """
        states, alarms = given[0, -STATES:], []
        for row in given:
            self.machine.instructions = 0
            _, result = self.machine.call("watch_step", [np.concatenate([row[:-STATES], states])], [RESULT])
            self.steps.append((bool(row[4 * JOINTS + 1]), self.machine.instructions))
            states = result[:STATES].astype(np.float32)
            alarms.append((int(result[ALARMS]), int(result[ALARMS + 1])))
        none = [a for a in alarms[:-1] if a != (0, 0)]
        return not none and alarms[-1] == (found.outside, found.changed)

    def instructions(self) -> dict[str, int]:
        """The most that a step took: of the observer alone, and with the monitor."""
        return {
            "observer": max(n for slow, n in self.steps if not slow),
            "observer_and_monitor": max(n for slow, n in self.steps if slow),
            "steps_of_the_observer_in_one_of_the_monitor": SLOW,
        }
