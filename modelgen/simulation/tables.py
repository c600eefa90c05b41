"""Tables that a simulation reads: references and inputs over time."""

from __future__ import annotations

from typing import Any

import numpy as np

from modelgen.dataset import named, read_columns
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.simulation.control import Reference
from modelgen.simulation.plant import Plant


def reference_of(n: int, log: Any) -> Reference:
    """t [s] and q<n> [rad, m] of a table, of modelgen excite say, for n coordinates. Raises InputError."""
    names = ["t", *(f"q{k + 1}" for k in range(n))]
    return Reference(*_table("--reference", log, names))


def inputs_of(p: Plant, log: Any) -> tuple[Array, Array]:
    """t (S,) [s] and inputs (S, n): i<n> [A] of driven joints, tau<n> [N m, N] of the others."""
    return _table("--input", log, ["t", *input_names(p)])


def input_names(p: Plant) -> list[str]:
    """The inputs' columns in a log."""
    drives = [p.arm.joints[i].drive for i in p.arm.coordinates]
    return [f"{'i' if d.driven else 'tau'}{k + 1}" for k, d in enumerate(drives)]


def _table(option: str, log: Any, names: list[str]) -> tuple[Array, Array]:
    log = named(log, option.removeprefix("--"))
    columns = read_columns(log, names)
    t, *rest = (np.asarray(columns[name], dtype=float) for name in names)
    if len(t) < 4 or not (np.diff(t) > 0).all() or not np.isfinite(np.array([t, *rest])).all():
        raise InputError(f"{option} {log}: expected four finite samples at least, with t growing")
    return t, np.stack(rest, axis=1)
