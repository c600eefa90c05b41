"""One arm of any size: generated, compiled function by function, counted."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np

from peers import build, cost, growing, ours
from peers.arms import Subject
from peers.harness_source import harness_source
from peers.measure import Call, instructions, values
from peers.symbolic import sizes

LIMIT = 60  # CPU seconds of one step
_COMPARED = ("inverse_dynamics", "mass_matrix", "forward_dynamics")  # regressors have other columns
_AGREEMENT = 1e-9


def measured(
    shape: str, case: Subject, tracer: Path | None, folder: Path, tired: dict[str, set[str]]
) -> dict[str, Any]:
    """Figures of modelgen and of the trace. `tired`: functions not to be tried; those over the limit join.

    Raises RuntimeError where the results differ.
    """
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "traced").mkdir(parents=True)
    spent = cost.generated(growing.__name__, shape, str(case.joints), str(folder))
    found: dict[str, Any] = {"modelgen": {"generation": _rounded(spent), "functions": {}}}
    results = {"modelgen": _ours(case, folder, tired["modelgen"], found["modelgen"]["functions"])}
    if tracer:
        found["traced"] = {"functions": {}}
        results["traced"] = _traced(case, tracer, folder, tired["traced"], found["traced"]["functions"])
        for key in _COMPARED:
            if key in results["traced"] and key in results["modelgen"]:
                mine, theirs = results["modelgen"][key], results["traced"][key]
                error = np.abs(mine - theirs).max() / np.abs(mine).max()
                if not error < _AGREEMENT:
                    raise RuntimeError(f"{case.arm.name}: {key} differs by {error:.1e}")
    return found


def _rounded(costs: dict[str, float]) -> dict[str, float]:
    return {key: round(value, 3) for key, value in costs.items()}


def _compiled(source: Path, *flags: str) -> tuple[Path, dict[str, float]] | None:
    """An object and what it cost; None where the compiler takes longer than the limit."""
    out = source.with_suffix(".o")
    command = [*build.C, f"-I{build.HERE}", *flags, "-c", str(source), "-o", str(out)]
    spent = cost.limited(command, LIMIT)
    if spent is None:
        return None
    return out, {"compilation": round(spent[0], 3), **cost.sections(out)}


def _ours(case: Subject, folder: Path, tired: set[str], found: dict[str, Any]) -> dict[str, Any]:
    arm, include = case.arm.name, f"-I{folder / 'include'}"
    sines = _compiled(folder / "src" / f"{arm}_sincos.c", include)
    assert sines is not None
    objects, calls = [sines[0]], {}
    for key, (inputs, parametric) in ours.FUNCTIONS.items():
        name = f"{arm}_{key}_identified" if parametric else f"{arm}_{key}"
        done = None if key in tired else _compiled(folder / "src" / f"{name}.c", include)
        if done is None:
            tired.add(key)
            continue
        objects.append(done[0])
        found[key] = done[1]
        size = case.joints ** (2 if key == "mass_matrix" else 1)
        if key == "regressor":
            macro = f"{arm.upper()}_N_PARAMETERS"
            size = case.joints * int(_macro(folder / "include" / f"{arm}.h", macro))
        calls[key] = (f"{name}({inputs}, out)", size)
    return _counted(case, folder, f'#include "{arm}.h"', calls, objects, found, include)


def _macro(header: Path, name: str) -> str:
    lines = header.read_text(encoding="utf-8").splitlines()
    return next(line.split()[2] for line in lines if line.startswith(f"#define {name} "))


def _traced(
    case: Subject, tracer: Path, folder: Path, tired: set[str], found: dict[str, Any]
) -> dict[str, Any]:
    objects, calls = [], {}
    model = Call(tracer, folder, case).command()[1]
    head = []
    for key, size in sizes(case.joints).items():
        source = folder / "traced" / f"{key}.c"
        spent = None if key in tired else cost.limited([str(tracer), model, str(source), key], LIMIT)
        done = _compiled(source) if spent is not None else None
        if spent is None or done is None:
            tired.add(key)
            continue
        objects.append(done[0])
        found[key] = {"generation": round(spent[0], 3), "memory": round(spent[1], 1), **done[1]}
        head.append(f"int traced_{key}(const double **, double **, long long *, double *, int);")
        call = "const double *in[] = {q, dq, third};\n    double *res[] = {out};\n"
        calls[key] = (f"{call}    traced_{key}(in, res, 0, 0, 0)", size)
    return _counted(case, folder / "traced", "\n".join(head), calls, objects, found, "")


def _counted(
    case: Subject,
    folder: Path,
    head: str,
    calls: dict[str, tuple[str, int]],
    objects: list[Path],
    found: dict[str, Any],
    include: str,
) -> dict[str, Any]:
    """Instructions of every function into `found`; the results."""
    if not calls:
        return {}
    wrapper = folder / "wrapper.c"
    wrapper.write_text(harness_source(head, calls), encoding="utf-8")
    flags = [include] if include else []
    objects = [*objects, build.object_file(wrapper, folder / "wrapper.o", *flags)]
    call = Call(build.program(folder / "program", objects), folder, case)
    for key, count in instructions(call).items():
        found[key]["instructions"] = round(count, 1)
    return values(call)
