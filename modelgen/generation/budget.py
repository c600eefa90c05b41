"""Flash and stack of every function, measured by a compiler for the target, against a budget."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from modelgen.errors import InputError
from modelgen.generation.arm import GeneratedArm


@dataclass(frozen=True)
class Target:
    """A compiler and its flags; `package` is where Debian has it, `real` the type of the arm's numbers."""

    compiler: str
    size: str
    package: str
    real: str
    flags: tuple[str, ...] = ()


_CORTEX = ("-mthumb", "-mfloat-abi=hard")
TARGETS: Mapping[str, Target] = {
    "cortex-m4f": Target(
        "arm-none-eabi-gcc",
        "arm-none-eabi-size",
        "gcc-arm-none-eabi libnewlib-arm-none-eabi",
        "float",
        ("-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", *_CORTEX),
    ),
    "cortex-m7": Target(
        "arm-none-eabi-gcc",
        "arm-none-eabi-size",
        "gcc-arm-none-eabi libnewlib-arm-none-eabi",
        "double",
        ("-mcpu=cortex-m7", "-mfpu=fpv5-d16", *_CORTEX),
    ),
    "host": Target("cc", "size", "build-essential", "double"),
}
_FLASH = re.compile(r"^\.(?:text|rodata)\S*\s+(\d+)\s", re.MULTILINE)


@dataclass(frozen=True)
class Budget:
    """Bytes that one function may take at most, None where any number will do; `target` is one of TARGETS."""

    target: str
    flash: int | None = None
    stack: int | None = None


@dataclass(frozen=True)
class Excess:
    """A function that takes more than its budget: `kind` is "flash" or "stack", in bytes."""

    function: str
    kind: str
    bytes: int
    budget: int


@dataclass(frozen=True)
class Size:
    """Bytes of flash (code and constants) and of stack of one function, the C library's apart."""

    flash: int
    stack: int


def excesses(arms: Sequence[GeneratedArm], budget: Budget) -> list[Excess]:
    """List what exceeds the budget, arm after arm. Raises InputError as `sizes` does."""
    found = []
    for arm in arms:
        for name, size in sizes(arm, TARGETS[budget.target]).items():
            for kind, figure, most in (
                ("flash", size.flash, budget.flash),
                ("stack", size.stack, budget.stack),
            ):
                if most is not None and figure > most:
                    found.append(Excess(f"{arm.name}_{name}", kind, figure, most))
    return found


def sizes(arm: GeneratedArm, target: Target) -> dict[str, Size]:
    """Bytes by function, compiled with -O2; the stack includes that of the arm's own sine and cosine.

    Raises InputError where the compiler fails or is missing.
    """
    for tool in (target.compiler, target.size):
        if shutil.which(tool) is None:
            raise InputError(
                f"found no {tool}, which measures the sizes; install it (Debian: {target.package})"
            )
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for name, text in arm.files.items():
            if name.endswith((".c", ".h")):
                path = folder / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
        with ThreadPoolExecutor() as pool:
            found = pool.map(lambda name: _size(folder, arm.name, name, target), arm.operations)
            measured = dict(zip(arm.operations, found, strict=True))
            shared = _size(folder, arm.name, "sincos", target).stack
    return {
        name: Size(size.flash, size.stack + (shared if "_SINCOS(" in _source(arm, name) else 0))
        for name, size in measured.items()
    }


def _source(arm: GeneratedArm, function: str) -> str:
    return arm.files[f"src/{arm.name}_{function}.c"]


def _size(folder: Path, arm: str, function: str, target: Target) -> Size:
    made = folder / f"{function}.o"
    flags = ["-std=c99", "-O2", f"-D{arm.upper()}_REAL={target.real}", "-fstack-usage", *target.flags]
    _run(
        [
            target.compiler,
            *flags,
            f"-I{folder}/include",
            "-c",
            f"{folder}/src/{arm}_{function}.c",
            "-o",
            str(made),
        ]
    )
    flash = sum(int(bytes_) for bytes_ in _FLASH.findall(_run([target.size, "-A", str(made)])))
    usage = made.with_suffix(".su")
    lines = usage.read_text(encoding="utf-8").splitlines() if usage.exists() else []
    return Size(flash, max((int(line.split("\t")[1]) for line in lines), default=0))


def _run(command: Sequence[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        first = (done.stderr.strip().splitlines() or ["no message"])[0]
        raise InputError(f"{command[0]} failed, so the sizes are unknown: {first}")
    return done.stdout
