"""Many states in one call: the generated functions over arrays beside themselves one by one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.functions import Function, build_model, nominal_base
from peers import ours
from peers.arms import LINKS_ALONE, Subject
from peers.build import object_file, program
from peers.harness_source import harness_source
from peers.measure import Call, instructions, nanoseconds, values

Array = NDArray[np.float64]
_STATES = 60  # in one call
_AGREEMENT = 1e-12
_SECONDS = 4.0
_THIRD = ("ddq", "input")


def _head(arm: str, joints: int, largest: int) -> str:
    """Arrays of states, and how they are filled: every one with the same state."""
    return "\n".join(
        [
            f'#include "{arm}.h"',
            f"enum {{ N = {_STATES}, JOINTS = {joints} }};",
            f"static double v_q[JOINTS * N], v_dq[JOINTS * N], v_third[JOINTS * N], v_out[{largest} * N];",
            f"static {arm}_status_t status[N];",
            "static void fill(const double *q, const double *dq, const double *third)",
            "{",
            "    for (int k = 0; k < JOINTS; k++)",
            "        for (int i = 0; i < N; i++) {",
            "            v_q[k * N + i] = q[k];",
            "            v_dq[k * N + i] = dq[k];",
            "            v_third[k * N + i] = third[k];",
            "        }",
            "}",
        ]
    )


def _calls(arm: str, functions: Mapping[str, Function]) -> dict[str, tuple[str, int]]:
    """Each function in one state, and in many; of those the last one's result; and what is done around it."""
    calls: dict[str, tuple[str, int]] = {}
    for key, f in functions.items():
        names = ["third" if a.name in _THIRD else a.name for a in f.arguments]
        size = f.outputs[0].size
        calls[f"{key}_one"] = (f"{arm}_{f.name}({', '.join(names)}, out)", size)
        given = ", ".join(["N", *(f"v_{name}" for name in names), "v_out", "status"])
        before = "fill(q, dq, third)"
        after = f"for (int k = 0; k < {size}; k++)\n        out[k] = v_out[k * N + N - 1]"
        calls[f"{key}_many"] = (f"{before};\n    {arm}_{f.name}_batch({given});\n    {after}", size)
        calls[f"{key}_around"] = (f"{before};\n    {after}", size)
    return calls


def packed(case: Subject, folder: Path, *, timed: bool = True) -> dict[str, dict[str, dict[str, float]]]:
    """Instructions and nanoseconds per state of each function, states one by one and many in one call.

    Without `timed` the instructions alone. All that a call does is in them: sine and cosine, the tests of
    inputs, pivots and results. Raises RuntimeError where the results differ.
    """
    folder = folder / "vectors"
    model = build_model(case.arm, LINKS_ALONE)
    names = {key: f"{key}_identified" if both else key for key, (_, both) in ours.FUNCTIONS.items()}
    options = replace(LINKS_ALONE, identified=nominal_base(model), batch=frozenset(names.values()))
    model = build_model(case.arm, options)
    functions = {f.name: f for f in model.functions}
    made = {key: functions[name] for key, name in names.items()}
    ours.write(model, folder)
    arm, include = case.arm.name, f"-I{folder / 'include'}"
    largest = max(f.outputs[0].size for f in made.values())
    calls = _calls(arm, made)
    unit = folder / "vectors.c"
    unit.write_text(harness_source(_head(arm, case.joints, largest), calls), encoding="utf-8")
    sources = [folder / "src" / f"{arm}_{n}.c" for f in made.values() for n in (f.name, f"{f.name}_batch")]
    sources.append(folder / "src" / f"{arm}_sincos.c")
    objects = [object_file(source, source.with_suffix(".o"), include) for source in (*sources, unit)]
    call = Call(program(folder / "vectors", objects), folder, case)
    found = values(call)
    for key in made:
        one, many = found[f"{key}_one"], found[f"{key}_many"]
        if not np.abs(many - one).max() < _AGREEMENT * np.abs(one).max():
            raise RuntimeError(f"{arm}: {key} in vectors differs")
    result = {"instructions": _by_state(made, instructions(call))}
    if timed:
        times = {key: float(np.median(blocks)) for key, blocks in nanoseconds(call, _SECONDS).items()}
        result["time"] = _by_state(made, times)
    return result


def _by_state(made: Mapping[str, Function], found: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """A state's share of what was measured: what fills arrays and reads results is no part of it."""
    return {
        "one": {key: round(found[f"{key}_one"], 1) for key in made},
        "many": {key: round((found[f"{key}_many"] - found[f"{key}_around"]) / _STATES, 1) for key in made},
    }
