"""The plant: the arm's generated C, compiled, called through ctypes and integrated."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np

FloatArray = np.ndarray
STEP = 5e-4  # s; dry friction keeps its sign, so the step is short

_REASONS = {
    1: "a lever has left its stroke",
    2: "the mass matrix is singular",
    4: "an input is out of bounds",
}


def compiled(folder: Path, name: str, build: Path) -> Path:
    """Compile the C in `folder/name` into a library. Raises RuntimeError without a compiler."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise RuntimeError("no C compiler: expected cc on the PATH (Debian: apt-get install build-essential)")
    build.mkdir(parents=True, exist_ok=True)
    library = build / f"lib{name}.so"
    sources = sorted((folder / name / "src").glob("*.c"))
    include = folder / name / "include"
    subprocess.run(
        [compiler, "-O2", "-shared", "-fPIC", f"-I{include}", *sources, "-lm", "-o", library], check=True
    )
    return library


class Plant:
    """Motion of an arm with the given base parameters under constant inputs."""

    def __init__(self, library: Path, name: str, parameters: FloatArray, joints: int) -> None:
        function = getattr(ctypes.CDLL(str(library)), f"{name}_forward_dynamics")
        pointer = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
        function.argtypes = [pointer] * 5
        function.restype = ctypes.c_int
        self._function: Callable[..., int] = function
        self._parameters = np.ascontiguousarray(parameters)
        self._n = joints

    def acceleration(self, q: FloatArray, dq: FloatArray, inputs: FloatArray) -> FloatArray:
        """[rad/s^2]. Raises RuntimeError where the C function refuses the state."""
        out = np.empty(self._n)
        status = self._function(
            np.ascontiguousarray(q), np.ascontiguousarray(dq), inputs, self._parameters, out
        )
        if status:
            why = " and ".join(text for bit, text in _REASONS.items() if status & bit)
            raise RuntimeError(f"the plant stops at q = {np.round(q, 4).tolist()} rad: {why}")
        return out

    def advance(self, state: FloatArray, inputs: FloatArray, duration: float) -> FloatArray:
        """The state (q, dq) after `duration` [s] of constant inputs: Runge-Kutta 4 in steps of about STEP."""
        inputs = np.ascontiguousarray(inputs)
        count = max(1, round(duration / STEP))
        h = duration / count
        for _ in range(count):
            a = self._slope(state, inputs)
            b = self._slope(state + h / 2 * a, inputs)
            c = self._slope(state + h / 2 * b, inputs)
            d = self._slope(state + h * c, inputs)
            state = state + h / 6 * (a + 2 * b + 2 * c + d)
        return state

    def _slope(self, state: FloatArray, inputs: FloatArray) -> FloatArray:
        q, dq = state[: self._n], state[self._n :]
        return np.concatenate([dq, self.acceleration(q, dq, inputs)])
