"""What a function costs on a Cortex-M4F in single precision: flash, stack, instructions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from firmware.build import (
    compile_arm,
    function_sizes,
    gcc_version,
    link_functions,
    write,
    zig_program,
    zig_version,
)
from firmware.machine import Machine
from firmware.states import Inputs
from firmware.targets import M4F
from modelgen.backends import Provenance, c_files
from modelgen.backends.c.dialect import arrays
from modelgen.functions import Model

STATES = 20
# Growth of a figure that passes without being accepted.
SLACK = 0.03


@dataclass(frozen=True)
class Size:
    """Bytes of code and constants, bytes of stack (None: not known), instructions of one call."""

    flash: int
    stack: int | None
    instructions: int


Sizes = Mapping[str, Size]


def compiler(tool: str) -> str:
    """The compiler behind "gcc" or "zig", with its version."""
    return gcc_version(M4F) if tool == "gcc" else zig_version()


def measure(model: Model, folder: Path, tool: str) -> dict[str, Size]:
    """The sizes of every function by name. `tool`: "gcc" or "zig"; `folder` takes sources and objects.

    Instructions are the most that one of STATES random states took: q uniform in [-pi, pi] or in the
    levers' strokes. Raises RuntimeError where it does not compile, or a state gives a status.
    """
    arm = model.arm.name
    write(c_files(model, Provenance("modelgen", "0" * 64)), folder)
    if tool == "gcc":
        objects = {o.path.stem: o for o in compile_arm(M4F, arm, folder, folder / "objects")}
        flash = {name: o.flash for name, o in objects.items()}
        shared = objects[f"{arm}_sincos"]
        stack = {
            name: o.stack + (shared.stack if shared.path.stem in o.undefined else 0)
            for name, o in objects.items()
        }
        machine = Machine(link_functions(M4F, list(objects.values()), folder / "arm.elf"), M4F, count=True)
    else:
        _, program = zig_program(M4F, arm, folder, folder / "objects")
        flash = function_sizes(program)
        stack = {}
        machine = Machine(program, M4F, count=True)
    found = {}
    sample = Inputs(model, 0)
    for function in model.functions:
        name = f"{arm}_{function.name}"
        most = 0
        for _ in range(STATES):
            machine.instructions = 0
            status, _ = machine.call(name, sample(function), list(arrays(function).values()))
            if status:
                raise RuntimeError(f"{name} returned the status {status}")
            most = max(most, machine.instructions)
        found[function.name] = Size(flash[name], stack.get(name), most)
    found["sincos"] = Size(flash[f"{arm}_sincos"], stack.get(f"{arm}_sincos"), 0)
    return found


def grown(before: Sizes, now: Sizes) -> list[str]:
    """A line for each figure that has grown by more than SLACK, with the old and the new figure."""
    lines = []
    for name, size in now.items():
        for kind, new in asdict(size).items():
            old = getattr(before.get(name), kind, None)
            if old is not None and new is not None and new > old * (1 + SLACK):
                lines.append(f"{name}: {kind} {old} -> {new} (+{(new - old) / max(old, 1):.1%})")
    return lines
