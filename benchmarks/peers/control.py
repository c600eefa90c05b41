"""What optimisers and control ticks call: derivatives and combined functions, beside Pinocchio and MuJoCo."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.description.objects import Combined
from modelgen.functions import Function, Model, build_model, nominal_base
from peers import mujoco_model, ours, pinocchio_control
from peers.arms import LINKS_ALONE, Subject
from peers.build import object_file, program
from peers.harness_source import harness_source
from peers.measure import Call, instructions, values

Array = NDArray[np.float64]
COMBINED = {
    "tick": ("inverse_dynamics", "mass_matrix"),
    "adaptive": ("inverse_dynamics", "mass_matrix", "regressor"),
}
DERIVATIVES = ("inverse_dynamics_derivatives", "forward_dynamics_derivatives")
PARTS = ("inverse_dynamics", "mass_matrix", "forward_dynamics")
OURS, MUJOCO = "modelgen", "MuJoCo"
PINOCCHIO, TRACED = "Pinocchio, C++", "Pinocchio, traced with CasADi"
SAME = "traced, with modelgen's sine and cosine"
_THIRD = ("ddq", "input")
_AGREEMENT = 1e-10


@dataclass(frozen=True)
class Programs:
    """What others compute with; None where a package is missing."""

    mujoco: Path | None = None
    derivatives: Path | None = None
    tracer: Path | None = None


def measured(case: Subject, programs: Programs, folder: Path) -> dict[str, dict[str, dict[str, float]]]:
    """Instructions per call and operations by who computes, by function. Raises RuntimeError where results
    differ.
    """
    mujoco = programs.mujoco
    folder.mkdir(parents=True, exist_ok=True)
    model = _model(case)
    mine = _ours(case, model, folder / "modelgen")
    reference = values(mine)
    counts = {OURS: {key: float(_total(f.operations)) for key, f in _functions(model).items()}}
    calls = {OURS: mine}
    if mujoco:
        mujoco_model.save(case, folder / "model.mjb")
        calls[MUJOCO] = Call(mujoco, folder, case, folder / "model.mjb")
    if programs.derivatives:
        calls[PINOCCHIO] = Call(programs.derivatives, folder, case)
    if programs.tracer:
        model_file = Path(mine.command()[1])
        given = programs.tracer, case, model_file
        calls[TRACED] = pinocchio_control.traced(*given, folder / "traced")
        calls[SAME] = pinocchio_control.traced(*given, folder / "same", folder / "modelgen")
    found = {}
    for who, call in calls.items():
        if who != OURS:
            _agree(case, who, reference, values(call))
        found[who] = {key: round(count, 1) for key, count in instructions(call).items()}
    return {"instructions": found, "operations": counts}


def _total(count: Mapping[str, int]) -> int:
    return sum(count[kind] for kind in ("mul", "add", "neg"))


def _model(case: Subject) -> Model:
    """The arm's functions, parameters folded in where there are any, and what is combined of them."""
    combined = tuple(Combined(name, parts) for name, parts in COMBINED.items())
    arm = replace(case.arm, combined=combined)
    identified = nominal_base(build_model(case.arm, LINKS_ALONE))
    return build_model(arm, replace(LINKS_ALONE, identified=identified))


def _functions(model: Model) -> dict[str, Function]:
    """What is called, by its name in the tables."""
    functions = {f.name: f for f in model.functions}
    folded = {key: functions[f"{key}_identified"] for key in (*PARTS, *DERIVATIVES, *COMBINED)}
    return {**folded, **{key: functions[key] for key in ("regressor", "regressor_standard")}}


def _ours(case: Subject, model: Model, folder: Path) -> Call:
    """The generated C behind the harness; several outputs lie one after the other."""
    ours.write(model, folder)
    arm, include, calls = model.arm.name, f"-I{folder / 'include'}", {}
    made = _functions(model)
    for key, f in made.items():
        inputs = ["third" if a.name in _THIRD else a.name for a in f.arguments]
        places, size = [], 0
        for output in f.outputs:
            places.append(f"out + {size}")
            size += output.size
        calls[key] = (f"{arm}_{f.name}({', '.join([*inputs, *places])})", size)
    wrapper = folder / "wrapper.c"
    wrapper.write_text(harness_source(f'#include "{arm}.h"', calls), encoding="utf-8")
    names = [*(f.name for f in made.values()), "sincos"]
    objects = [
        object_file(folder / "src" / f"{arm}_{name}.c", folder / f"{name}.o", include) for name in names
    ]
    objects.append(object_file(wrapper, folder / "wrapper.o", include))
    return Call(program(folder / "program", objects), folder, case)


def _agree(case: Subject, who: str, mine: Mapping[str, Array], theirs: Mapping[str, Array]) -> None:
    """Their results are ours, to 1e-10 of the largest."""
    for name, value in theirs.items():
        if who == MUJOCO:
            found, reference = value, mine[name.removesuffix("_alone")]
        else:
            found = pinocchio_control.compared(case, name, value)
            reference = pinocchio_control.expected(case, name, mine)[:, : found.shape[1]]
        difference = np.abs(reference - found).max() / np.abs(reference).max()
        if not difference < _AGREEMENT:
            raise RuntimeError(f"{case.arm.name}: {who} and modelgen differ by {difference:.1e} in {name}")
