"""The generated C behind the harness.

python -m peers.ours ARM FOLDER     generates, and prints what it cost
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from modelgen import __version__
from modelgen.backends import Provenance, c_files
from modelgen.functions import Model, nominal_base
from peers.arms import links_alone, subject
from peers.build import Built, object_file, program
from peers.cost import generation
from peers.harness_source import harness_source

# Name in the tables -> function without and with parameters folded in; inputs after q.
FUNCTIONS = {
    "inverse_dynamics": ("q, dq, third", True),
    "mass_matrix": ("q", True),
    "forward_dynamics": ("q, dq, third", True),
    "regressor": ("q, dq, third", False),
}


def write(model: Model, folder: Path) -> None:
    """An arm's C."""
    for name, text in c_files(model, Provenance(f"modelgen {__version__}", "")).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def built(model: Model, folder: Path, flags: Sequence[str] = (), units: Sequence[str] | None = None) -> Built:
    """The harness with an arm's C that `write` wrote, parameters folded in and at run time.

    `flags` are added to those of the compiler; `units`: sources to compile in place of the functions'.
    """
    arm = model.arm.name
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
    run_time = [key for key, (_, parametric) in FUNCTIONS.items() if parametric]
    folded = [f"{key}_identified" if parametric else key for key, (_, parametric) in FUNCTIONS.items()]
    if units is not None:
        made = [object_file(Path(unit), Path(unit).with_suffix(".o"), include, *flags) for unit in units]
        made.append(object_file(wrapper, folder / "wrapper.o", include))
        return Built(program(folder / "program", made), made)
    objects = {
        name: object_file(folder / "src" / f"{arm}_{name}.c", folder / f"{name}.o", include, *flags)
        for name in [*run_time, *folded, "sincos"]
    }
    everything = [object_file(wrapper, folder / "wrapper.o", include), *objects.values()]
    return Built(program(folder / "program", everything), [objects[name] for name in [*folded, "sincos"]])


def operations(model: Model) -> dict[str, dict[str, int]]:
    """Operations of each function as it is tabulated, and with parameters at run time."""
    counts = {f.name: dict(f.operations) for f in model.functions}
    found = {}
    for key, (_, parametric) in FUNCTIONS.items():
        found[key] = counts[f"{key}_identified" if parametric else key]
        if parametric:
            found[f"{key}_run_time"] = counts[key]
    return found


if __name__ == "__main__":
    arm = subject(sys.argv[1]).arm
    generation(lambda: write(links_alone(arm), Path(sys.argv[2])))
