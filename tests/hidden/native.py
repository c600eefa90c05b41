"""The plant's C files, compiled once for each state of their text, and their structure in NumPy."""

import ctypes
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Plant = NDArray[np.void]
"""One record of the C structure of plant.h: plant["mass"][j], plant["sag"][()]."""

HERE = Path(__file__).parent
SOURCES = ("body.c", "drives.c", "stepping.c")
HEADERS = ("plant.h", "body.h", "drives.h")
FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC")


class PlantError(RuntimeError):
    """The simulated arm left its bounds, or cannot do what was asked."""


@cache
def layout() -> np.dtype[np.void]:
    """The C structure as read from its header."""
    text = re.sub(r"/\*.*?\*/", "", (HERE / "plant.h").read_text(encoding="utf-8"), flags=re.DOTALL)
    sizes = {name: int(value) for name, value in re.findall(r"#define (\w+) (\d+)", text)}
    body = re.search(r"typedef struct \{(.*?)\} Plant;", text, flags=re.DOTALL)
    assert body is not None
    fields: list[tuple[str, Any, tuple[int, ...]]] = []
    for kind, names in re.findall(r"(int|double)\s+([^;]+);", body.group(1)):
        for declared in names.split(","):
            name, *brackets = re.split(r"[\[\]]+", declared.strip().rstrip("]"))
            shape = tuple(sizes.get(size, 0) or int(size) for size in brackets if size)
            fields.append((name, np.int32 if kind == "int" else np.float64, shape))
    return np.dtype(fields, align=True)


def new() -> Plant:
    """An arm of nothing but zeros."""
    return np.zeros((), dtype=layout())


@cache
def library() -> ctypes.CDLL:
    """The compiled plant."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        raise PlantError("needs a C compiler (cc, gcc or clang) to build the simulated arms")
    digest = hashlib.sha256(" ".join((compiler, *FLAGS)).encode())
    for name in (*HEADERS, *SOURCES):
        digest.update((HERE / name).read_bytes())
    folder = Path(tempfile.gettempdir()) / f"hidden-plant-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    target = folder / f"{digest.hexdigest()[:16]}.so"
    if not target.exists():
        with tempfile.TemporaryDirectory(dir=folder) as made:
            built = Path(made) / "plant.so"
            command = [compiler, *FLAGS, "-o", str(built), *(str(HERE / name) for name in SOURCES), "-lm"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                raise PlantError(f"the plant does not compile:\n{done.stderr}")
            built.replace(target)
    return ctypes.CDLL(str(target))


def _at(values: NDArray[Any]) -> ctypes.c_void_p:
    return ctypes.c_void_p(values.ctypes.data)


def simulate(
    plant: Plant, rate: float, duration: float, substeps: int, warm_up: float = 2.0, energy: bool = False
) -> tuple[Array, Array, Array, Array | None]:
    """Joint coordinates, encoder readings and currents, each (N, n), at `rate` [Hz]; energies (N,) [J].

    The controller runs `warm_up` [s] before the first row.
    Raises PlantError where the motion leaves its bounds.
    """
    n, rows = int(plant["n"]), round(rate * duration)
    out = np.zeros((rows, 3 * n))
    energies = np.zeros(rows) if energy else None
    failed = library().simulate(
        _at(plant),
        ctypes.c_double(1.0 / rate),
        ctypes.c_int(substeps),
        ctypes.c_int(round(warm_up * rate)),
        ctypes.c_int(rows),
        _at(out),
        _at(energies) if energies is not None else None,
    )
    if failed:
        raise PlantError("the simulated motion left its bounds")
    return out[:, :n], out[:, n : 2 * n], out[:, 2 * n :], energies


def regressor(plant: Plant, q: Array, dq: Array, ddq: Array) -> Array:
    """(N, n, 13 n): current per standard parameter of links, then of drives."""
    n = int(plant["n"])
    out = np.zeros((len(q), n, 13 * n))
    q, dq, ddq = (np.ascontiguousarray(values, dtype=float) for values in (q, dq, ddq))
    library().regressor(_at(plant), ctypes.c_int(len(q)), _at(q), _at(dq), _at(ddq), _at(out))
    return out


def mass_and_bias(plant: Plant, q: Array, dq: Array) -> tuple[Array, Array]:
    """Joint-space inertia (n, n) of the links and bodies they carry, and torques (n,) at ddq = 0."""
    n = int(plant["n"])
    mass, bias = np.zeros((n, n)), np.zeros(n)
    q, dq = np.ascontiguousarray(q, dtype=float), np.ascontiguousarray(dq, dtype=float)
    library().mass_and_bias(_at(plant), _at(q), _at(dq), _at(mass), _at(bias))
    return mass, bias


def drive(plant: Plant, joint: int, q: float) -> tuple[float, float, float]:
    """Motor coordinate, its slope and its second derivative by the joint's."""
    x, slope, bend = np.zeros(1), np.zeros(1), np.zeros(1)
    library().drive(_at(plant), ctypes.c_int(joint), ctypes.c_double(q), _at(x), _at(slope), _at(bend))
    return float(x[0]), float(slope[0]), float(bend[0])


def joint_from_motor(plant: Plant, joint: int, x: Array) -> Array:
    """Joint coordinate of motor coordinates (N,).

    Raises PlantError where a lever leaves its stroke by more than a tenth: nobody takes that for the lever.
    """
    kind = plant["kind"][joint]
    if kind < 0.5:
        return x
    if kind < 1.5:
        return np.asarray(x / plant["ratio"][joint])
    (begin, end), (first, last) = plant["length"][joint], plant["motor"][joint]
    part = (x - first) / (last - first)
    if part.min() < -0.1 or part.max() > 1.1:
        raise PlantError(f"motor {joint + 1} leaves the stroke of the lever that is described")
    length = begin + part * (end - begin)
    l1, l2 = plant["l1"][joint], plant["l2"][joint]
    inner = np.arccos(np.clip((l1**2 + l2**2 - length**2) / (2 * l1 * l2), -1, 1))
    return np.asarray(plant["offset"][joint] + plant["rev"][joint] * inner)
