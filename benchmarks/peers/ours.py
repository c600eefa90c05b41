"""The generated C behind the harness, and that of Pinocchio traced through CasADi."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from modelgen import __version__
from modelgen.backends import Provenance, c_files
from modelgen.functions import Model, nominal_base
from peers.build import object_file, program

# Name in the tables -> function without and with parameters folded in; inputs after q.
FUNCTIONS = {
    "inverse_dynamics": ("q, dq, third", True),
    "mass_matrix": ("q", True),
    "forward_dynamics": ("q, dq, third", True),
    "regressor": ("q, dq, third", False),
}
_CALL = """\
static const double *call_{key}(const double *q, const double *dq, const double *third)
{{
    static double out[{size}];
    (void)dq;
    (void)third;
    {call};
    return out;
}}
"""


def harness_source(head: str, calls: dict[str, tuple[str, int]]) -> str:
    """C text of a peer. `calls`: name -> (call that writes `out`, size of the result)."""
    text = [head, '#include "peer.h"', ""]
    text += [_CALL.format(key=key, size=size, call=call) for key, (call, size) in calls.items()]
    rows = "".join(f'    {{"{key}", {size}, call_{key}}},\n' for key, (_, size) in calls.items())
    text += [f"static const struct peer_function functions[] = {{\n{rows}    {{0, 0, 0}}}};"]
    text += ["", "const struct peer_function *peer_open(const char *model)", "{", "    (void)model;"]
    return "\n".join([*text, "    return functions;", "}", ""])


def generated(model: Model, folder: Path) -> tuple[Path, dict[str, Path]]:
    """The harness with an arm's C; the objects by function, for their size."""
    arm = model.arm.name
    files = c_files(model, Provenance(f"modelgen {__version__}", ""))
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    sizes = {f.name: f.outputs[0].size for f in model.functions}
    calls = {}
    for key, (inputs, parametric) in FUNCTIONS.items():
        if parametric:
            calls[key] = (f"{arm}_{key}_identified({inputs}, out)", sizes[key])
            calls[f"{key}_run_time"] = (f"{arm}_{key}({inputs}, parameters, out)", sizes[key])
        else:
            calls[key] = (f"{arm}_{key}({inputs}, out)", sizes[key])
    base = np.array(list(nominal_base(model).values()))
    numbers = ", ".join(f"{value:.17g}" for value in base)
    head = f'#include "{arm}.h"\n\nstatic const double parameters[] = {{{numbers}}};'
    wrapper = folder / "wrapper.c"
    wrapper.write_text(harness_source(head, calls), encoding="utf-8")
    include = f"-I{folder / 'include'}"
    objects = {"wrapper": object_file(wrapper, folder / "wrapper.o", include)}
    names = [key for pair in FUNCTIONS for key in (pair, f"{pair}_identified") if key in sizes]
    for name in [*names, "sincos"]:
        source = folder / "src" / f"{arm}_{name}.c"
        objects[name] = object_file(source, folder / f"{name}.o", include)
    return program(folder / "ours", list(objects.values())), objects


def traced(source: Path, joints: int, folder: Path) -> tuple[Path, Path]:
    """The harness with C that CasADi wrote, and the object with that C."""
    sizes = {"inverse_dynamics": joints, "mass_matrix": joints**2, "forward_dynamics": joints}
    sizes["regressor"] = 10 * joints**2
    declared = "int traced_{0}(const double **, double **, long long *, double *, int);"
    head = "\n".join(declared.format(name) for name in sizes)
    calls = {
        name: (
            f"const double *in[] = {{q, dq, third}};\n    double *res[] = {{out}};\n"
            f"    traced_{name}(in, res, 0, 0, 0)",
            size,
        )
        for name, size in sizes.items()
    }
    wrapper = folder / "traced_wrapper.c"
    wrapper.write_text(harness_source(head, calls), encoding="utf-8")
    code = object_file(source, folder / "traced.o")
    objects = [code, object_file(wrapper, folder / "traced_wrapper.o")]
    return program(folder / "traced", objects), code


def kane(source: Path, joints: int, folder: Path) -> Path:
    """The harness with C that sympy_kane wrote."""
    sizes = {"inverse_dynamics": joints, "mass_matrix": joints**2}
    types = "const double *, const double *, const double *, double *"
    head = "\n".join(f"void kane_{name}({types});" for name in sizes)
    calls = {name: (f"kane_{name}(q, dq, third, out)", size) for name, size in sizes.items()}
    wrapper = folder / "kane_wrapper.c"
    wrapper.write_text(harness_source(head, calls), encoding="utf-8")
    objects = [object_file(source, folder / "kane.o"), object_file(wrapper, folder / "kane_wrapper.o")]
    return program(folder / "kane", objects)
