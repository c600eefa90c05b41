"""The controller, compiled for a Cortex-M4F and run under emulation, one step at a time."""

from __future__ import annotations

import os
import select
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

import numpy as np
from firmware.build import link, zig_link
from firmware.machine import Machine
from firmware.targets import M4F
from numpy.typing import NDArray
from tracking_values import ARM, Values, header

HERE = Path(__file__).resolve().parent
GENERATED = HERE.parent.parent / "generated" / ARM
INPUTS, OUTPUTS = 16, 7  # numbers of controller_input_t and controller_output_t
_PATIENCE = 20.0  # s without an answer
_FLAGS = ("-DARIANE4_REAL=float", f"-I{GENERATED / 'include'}", f"-I{HERE}")

Array = NDArray[np.float32]


class Controller(Protocol):
    """Something that answers a controller_input_t with a controller_output_t."""

    def step(self, given: Array) -> Array:
        """One millisecond."""


class _InPython:
    """The controller in a processor within Python."""

    def __init__(self, program: Path) -> None:
        self.machine = Machine(program, M4F)

    def step(self, given: Array) -> Array:
        _, result = self.machine.call("controller_step", [given], [OUTPUTS])
        return result.astype(np.float32)


class _OnBoard:
    """The controller on a board in QEMU, in lock step over two named pipes."""

    def __init__(self, program: Path, folder: Path) -> None:
        self.pipes = []
        for name in ("measured", "commanded"):
            os.mkfifo(folder / name)
            self.pipes.append(os.open(folder / name, os.O_RDWR))  # does not wait for the other side
        quiet = ["-nographic", "-monitor", "none", "-serial", "none"]
        semihosting = ["-semihosting-config", "enable=on,target=native"]
        command = [*M4F.qemu, *quiet, *semihosting, "-kernel", str(program)]
        self.process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL)

    def step(self, given: Array) -> Array:
        measured, commanded = self.pipes
        os.write(measured, given.tobytes())
        answer = b""
        while len(answer) < OUTPUTS * 4:
            if not select.select([commanded], [], [], _PATIENCE)[0]:
                raise RuntimeError(f"no answer from {M4F.qemu[0]} within {_PATIENCE:g} s")
            answer += os.read(commanded, OUTPUTS * 4 - len(answer))
        return np.frombuffer(answer, np.float32)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        for pipe in self.pipes:
            os.close(pipe)


def program(v: Values, folder: Path, *, qemu: bool) -> Path:
    """The controller with its numbers, compiled below `folder`. Raises RuntimeError where that fails."""
    (folder / "values.h").write_text(header(v), encoding="utf-8")
    sources, flags = (
        [*sorted((GENERATED / "src").glob("*.c")), HERE / "controller.c"],
        [*_FLAGS, f"-I{folder}"],
    )
    if qemu:
        return link(M4F, [], [*sources, HERE / "main.c"], folder / "controller.elf", flags)
    return zig_link(M4F, sources, flags, folder)[1]


@contextmanager
def controller(program: Path, folder: Path, *, qemu: bool) -> Iterator[Controller]:
    """A controller at its beginning; `folder` takes its pipes. Raises RuntimeError."""
    if not qemu:
        yield _InPython(program)
        return
    board = _OnBoard(program, folder)
    try:
        yield board
    finally:
        board.close()


def message(
    motor: NDArray[np.float64],
    speed: NDArray[np.float64],
    reference: Sequence[NDArray[np.float64]],
    mode: int,
) -> Array:
    """A controller_input_t."""
    return np.concatenate([motor, speed, *reference, [mode]]).astype(np.float32)
