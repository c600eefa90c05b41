"""Pinocchio's derivatives, and its traced functions with modelgen's sine and cosine in them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from peers import build, symbolic
from peers.arms import Subject
from peers.field import pinocchio_parameters
from peers.measure import Call

Array = NDArray[np.float64]
SAME = ("inverse_dynamics", "mass_matrix", "forward_dynamics", "regressor")
BLOCKS = ("", "_by_q", "_by_dq")  # what the C++ gives of derivatives, in the order of our outputs


def traced(tracer: Path, case: Subject, model: Path, folder: Path, sines: Path | None = None) -> Call:
    """The traced functions; with `sines`, a folder with an arm's C, SAME by its sine and cosine, inlined."""
    folder.mkdir(parents=True, exist_ok=True)
    names = SAME if sines else (*SAME, *symbolic.TRACED_DERIVATIVES)
    source = folder / "traced.c"
    build.run([str(tracer), str(model), str(source), ",".join(names)])
    flags = _sines(case.arm.name, sines, folder) if sines else []
    return Call(symbolic.traced([source], case.joints, names, flags).program, folder, case)


def _sines(arm: str, sines: Path, folder: Path) -> list[str]:
    """Flags by which sin and cos of a source are those of the arm: what both share is computed once."""
    text = (sines / "src" / f"{arm}_sincos.c").read_text(encoding="utf-8")
    old = f"{arm}_pair_t {arm}_sincos({arm}_real_t x)"
    if old not in text:
        raise RuntimeError(f"{arm}_sincos.c does not begin its function as expected: {old}")
    inlined = "static inline __attribute__((always_inline)) "
    text = text.replace(old, f"{inlined}{arm}_pair_t peer_sincos({arm}_real_t x)")
    text += "#define sin(x) (peer_sincos(x).sine)\n#define cos(x) (peer_sincos(x).cosine)\n"
    header = folder / "sines.h"
    header.write_text(text, encoding="utf-8")
    return ["-include", str(header), f"-I{sines / 'include'}", f"-I{sines / 'src'}"]


def expected(case: Subject, name: str, mine: Mapping[str, Array]) -> Array:
    """What a function of Pinocchio has to give, from our results by function."""
    n = case.joints
    for place, block in enumerate(BLOCKS[1:]):
        if name.endswith(block):
            start = n + place * n * n
            return mine[name.removesuffix(block)][:, start : start + n * n]
    return mine["inverse_dynamics" if name == "regressor" else name]


def compared(case: Subject, name: str, found: Array) -> Array:
    """Its result as `expected` has it, or the first elements of that; regressors by their efforts."""
    n = case.joints
    if name == "regressor":
        parameters = np.concatenate([pinocchio_parameters(body) for body in case.bodies])
        efforts: Array = np.einsum("spn,p->sn", found.reshape(len(found), -1, n), parameters)
        return efforts
    if name == "mass_matrix":  # by columns, the lower triangle as the upper one
        square = found.reshape(-1, n, n)
        return np.where(square != 0, square, square.transpose(0, 2, 1)).reshape(len(found), -1)
    return found
