"""Functions of an arm run on an emulated board: states in by a file, results out by another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from firmware.build import Object, link, run
from firmware.targets import Target
from modelgen.backends.c.dialect import arrays
from modelgen.functions import Function, Model

_MAIN = """\
/** Reads calls from inputs.bin and writes their results to results.bin. */
#include "{arm}.h"
#include "semihosting.h"

#define REAL {arm}_real_t

static const unsigned short sizes[][2] = {{{sizes}}};
static REAL in[{most_in} + 1], out[{most_out} + 1];

static int32_t call(uint32_t function)
{{
    switch (function) {{
{cases}
    default:
        return -1;
    }}
}}

int main(void)
{{
    const int32_t from = semihosting_open("inputs.bin", 10, 1);
    const int32_t to = semihosting_open("results.bin", 11, 5);
    uint32_t function;
    if (from < 0 || to < 0) {{
        return 71;
    }}
    while (semihosting_read(from, &function, sizeof function) == 0) {{
        if (function >= sizeof sizes / sizeof sizes[0]
            || semihosting_read(from, in, sizes[function][0] * sizeof(REAL)) != 0) {{
            return 72;
        }}
        const int32_t status = call(function);
        if (semihosting_write(to, &status, sizeof status) != 0
            || semihosting_write(to, out, sizes[function][1] * sizeof(REAL)) != 0) {{
            return 73;
        }}
    }}
    return 0;
}}
"""


@dataclass(frozen=True)
class Call:
    """A function by its place in the model, and its inputs."""

    function: int
    inputs: Sequence[NDArray[np.float64]]


def program(target: Target, model: Model, folder: Path, objects: Sequence[Object], out: Path) -> Path:
    """A program for the target's board that answers calls. `folder`: the arm's generated code."""
    out.mkdir(parents=True, exist_ok=True)
    source = out / "main.c"
    source.write_text(_main(model), encoding="utf-8")
    defines = [f"-D{model.arm.name.upper()}_REAL={target.real}", "-I", str(folder / "include")]
    return link(target, objects, [source], out / "program.elf", defines)


def on_board(
    target: Target, model: Model, program: Path, calls: Sequence[Call], folder: Path
) -> list[tuple[int, NDArray[np.float64]]]:
    """Status and outputs of every call, in QEMU; `folder` takes the two files. Raises RuntimeError."""
    folder.mkdir(parents=True, exist_ok=True)
    real: Any = np.dtype(np.float32 if target.real == "float" else np.float64)
    data = b"".join(
        np.uint32(c.function).tobytes() + b"".join(np.asarray(x, dtype=real).tobytes() for x in c.inputs)
        for c in calls
    )
    (folder / "inputs.bin").write_bytes(data)
    semihosting = ["-semihosting-config", "enable=on,target=native"]
    quiet = ["-nographic", "-monitor", "none", "-serial", "none"]
    run([*target.qemu, *quiet, *semihosting, "-kernel", program], folder)
    results = (folder / "results.bin").read_bytes()
    found, position = [], 0
    for call in calls:
        size = sum(arrays(model.functions[call.function]).values())
        status = int(np.frombuffer(results, np.int32, 1, position)[0])
        outputs = np.frombuffer(results, real, size, position + 4).astype(float)
        found.append((status, outputs))
        position += 4 + size * real.itemsize
    if position != len(results):
        raise RuntimeError(f"results.bin holds {len(results)} bytes, expected {position}")
    return found


def _main(model: Model) -> str:
    sizes = [(sum(a.size for a in f.arguments), sum(arrays(f).values())) for f in model.functions]
    return _MAIN.format(
        arm=model.arm.name,
        sizes=", ".join(f"{{{i}, {o}}}" for i, o in sizes),
        most_in=max(i for i, _ in sizes),
        most_out=max(o for _, o in sizes),
        cases="\n".join(_case(model.arm.name, k, f) for k, f in enumerate(model.functions)),
    )


def _case(arm: str, number: int, function: Function) -> str:
    listed, position = [], 0
    for argument in function.arguments:
        listed.append(f"in + {position}")
        position += argument.size
    position = 0
    for size in arrays(function).values():
        listed.append(f"out + {position}")
        position += size
    return f"    case {number}:\n        return {arm}_{function.name}({', '.join(listed)});"
