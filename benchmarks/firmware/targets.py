"""The microcontrollers on which the generated code is tried, and the tools for them."""

from __future__ import annotations

import importlib.util
import shutil
from dataclasses import dataclass
from pathlib import Path

BOARD = Path(__file__).resolve().parent / "board"

# What the documentation recommends. -std=c99 alone would switch fused multiplication and addition off.
COMMON_FLAGS = (
    "-std=c99",
    "-O2",
    "-ffp-contract=fast",
    "-fno-math-errno",
    "-ffunction-sections",
    "-fdata-sections",
)
WARNINGS = ("-Wall", "-Wextra", "-Wdouble-promotion", "-Werror")


@dataclass(frozen=True)
class Target:
    """A processor with a floating-point unit.

    gcc, qemu: the programs. flags: for gcc. zig: target and processor for the compiler of the Python
    package ziglang, none where that path is not provided. startup: files of the board.
    """

    name: str
    real: str
    gcc: str
    flags: tuple[str, ...]
    qemu: tuple[str, ...]
    startup: tuple[str, ...]
    script: str
    zig: tuple[str, ...] = ()

    @property
    def missing(self) -> str:
        """The programs that are needed to compile and run and are not installed, for a message."""
        return " and ".join(program for program in (self.gcc, self.qemu[0]) if shutil.which(program) is None)


def _cortex(name: str, real: str, cpu: str, fpu: str, machine: str, zig: str) -> Target:
    return Target(
        name=name,
        real=real,
        gcc="arm-none-eabi-gcc",
        flags=(f"-mcpu={cpu}", "-mthumb", "-mfloat-abi=hard", f"-mfpu={fpu}", "--specs=nano.specs"),
        qemu=("qemu-system-arm", "-M", machine),
        startup=("cortex_m.c",),
        script="cortex_m.ld",
        zig=("-target", "thumb-linux-musleabihf", f"-mcpu={zig}"),
    )


M4F = _cortex("cortex-m4f", "float", "cortex-m4", "fpv4-sp-d16", "mps2-an386", "cortex_m4+vfp4d16sp")
M7 = _cortex("cortex-m7", "float", "cortex-m7", "fpv5-d16", "mps2-an500", "cortex_m7+fp_armv8d16")
M7_DOUBLE = _cortex("cortex-m7", "double", "cortex-m7", "fpv5-d16", "mps2-an500", "cortex_m7+fp_armv8d16")
RISCV = Target(
    name="rv32imafc",
    real="float",
    gcc="riscv64-unknown-elf-gcc",
    flags=("-march=rv32imafc", "-mabi=ilp32f", "--specs=picolibc.specs"),
    qemu=("qemu-system-riscv32", "-M", "virt", "-bios", "none"),
    startup=("riscv.c",),
    script="riscv.ld",
)
TARGETS = (M4F, M7, M7_DOUBLE, RISCV)


def python_tools_missing() -> str:
    """The Python packages of the path without Debian's tools that are not installed."""
    return " and ".join(name for name in ("ziglang", "unicorn") if importlib.util.find_spec(name) is None)
