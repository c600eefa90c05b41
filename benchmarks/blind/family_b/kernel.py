"""plant.c, compiled on this machine and called."""

from __future__ import annotations

import ctypes
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from blind.case import Array

SOURCE = Path(__file__).with_name("plant.c")
FLAGS = (
    "-O2",
    "-ffp-contract=off",
    "-shared",
    "-fPIC",
)  # no fused operations: the same bytes on every machine
STEP = 2e-4  # s
PER_TICK = 5  # steps of a tick of the joints' loops: 1 kHz
TICK = STEP * PER_TICK
COLUMNS = 9  # link angles, motor angles, currents


class Unstable(Exception):
    """The motion ran away."""


@cache
def fields(struct: str) -> tuple[str, ...]:
    """Names of a struct's numbers, in their order, from the source.

    struct: "arm_t" or "joint_t".
    """
    text = re.sub(r"/\*.*?\*/", "", SOURCE.read_text(), flags=re.DOTALL)
    body = next(
        b
        for b, name in re.findall(r"typedef struct \{(.*?)\} (\w+);", text, flags=re.DOTALL)
        if name == struct
    )
    return tuple(name.strip() for line in re.findall(r"double ([^;]*);", body) for name in line.split(","))


@cache
def library() -> ctypes.CDLL:
    """The compiled plant, kept in a folder of this user beside other temporary files."""
    compiler = os.environ.get("CC") or shutil.which("cc")
    if compiler is None:
        raise RuntimeError("family B needs a C compiler: none is called cc, and CC is not set")
    key = hashlib.sha256(SOURCE.read_bytes() + repr((compiler, FLAGS)).encode()).hexdigest()[:16]
    folder = Path(tempfile.gettempdir()) / f"blind-family-b-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if folder.stat().st_uid != os.getuid():
        raise RuntimeError(f"{folder} belongs to another user")
    target = folder / f"plant-{key}.so"
    if not target.exists():
        fresh = folder / f"plant-{key}-{os.getpid()}.so"
        subprocess.run([compiler, *FLAGS, "-o", str(fresh), str(SOURCE), "-lm"], check=True)
        fresh.replace(target)
    loaded = ctypes.CDLL(str(target))
    for which, struct in enumerate(("arm_t", "joint_t")):
        if loaded.plant_sizes(which) != len(fields(struct)):
            raise RuntimeError(f"{struct} of plant.c was not read right")
    return loaded


def packed(struct: str, values: dict[str, float]) -> Array:
    """Numbers of a struct; what is not given is zero. Raises KeyError for names that it lacks."""
    names = fields(struct)
    unknown = sorted(set(values) - set(names))
    if unknown:
        raise KeyError(f"{struct} has no {', '.join(unknown)}")
    return np.array([values.get(name, 0.0) for name in names])


def run(
    arm: dict[str, float],
    joints: list[dict[str, float]],
    reference: Array,
    *,
    begin: int = 0,
    push: Array | None = None,
    gain: Array | None = None,
    start: Array | None = None,
    heat: Array | None = None,
) -> tuple[Array, Array]:
    """Motion of the three axes under their loops.

    arm, joints: numbers of plant.c by name.
    reference: (ticks, 6) angles and speeds of the motors [rad, rad/s].
    begin: tick at which the heat is set (again) to `heat` (3); push: (ticks, 3) joint efforts from outside;
    gain: (ticks) factor of the torque constants; start: (6) link angles and speeds, at rest at 0 else.
    Returns link angles, motor angles and currents of every step (ticks * PER_TICK, 9), and the last heat.
    Raises Unstable.
    """
    ticks = len(reference)
    reference = np.ascontiguousarray(reference, float)
    push = np.zeros((ticks, 3)) if push is None else np.ascontiguousarray(push, float)
    gain = np.ones(ticks) if gain is None else np.ascontiguousarray(gain, float)
    start = np.zeros(6) if start is None else np.ascontiguousarray(start, float)
    warm = np.zeros(3) if heat is None else np.array(heat, float)
    if (
        push.shape != (ticks, 3)
        or gain.shape != (ticks,)
        or reference.shape != (ticks, 6)
        or start.shape != (6,)
    ):
        raise ValueError("reference, push, gain or start is of the wrong shape")
    log = np.empty((ticks * PER_TICK, COLUMNS))
    a, j = packed("arm_t", arm), np.concatenate([packed("joint_t", joint) for joint in joints])

    def at(x: Array) -> ctypes.c_void_p:
        return ctypes.c_void_p(x.ctypes.data)

    failed = library().plant_run(
        at(a), at(j), ctypes.c_int(ticks), ctypes.c_int(PER_TICK), ctypes.c_double(STEP), ctypes.c_int(begin),
        at(reference), at(push), at(gain), at(start), at(warm), at(log),
    )  # fmt: skip
    if failed:
        raise Unstable("the motion ran away")
    return log, warm
