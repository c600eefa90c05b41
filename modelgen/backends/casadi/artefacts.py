"""CasADi makes these of an arm's module: serialised functions, and a compiled plant with derivatives.

Both belong to the release of CasADi that made them. They are built beside the generated code, never
committed, and left out of its manifest.
"""

from __future__ import annotations

import importlib.util
import tempfile
from importlib.machinery import ModuleSpec
from pathlib import Path

import casadi as ca

from modelgen.backends.text import render
from modelgen.errors import InputError

SERIALISED = "casadi"  # folder below the arm's
PLANT = "plant"


def serialised_files(arm: str, module: str) -> dict[str, str]:
    """Each function of the module's text for `casadi.Function.load`, by path below the arm's folder."""
    files = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, function in _functions(arm, module).items():
            path = Path(folder) / f"{name}.casadi"
            function.save(str(path))
            files[f"{SERIALISED}/{path.name}"] = path.read_text(encoding="ascii")
    return files


def plant_files(arm: str, module: str) -> dict[str, str]:
    """C of `<arm>_plant`, by path below the arm's folder, for `casadi.external` once it is compiled.

    Inputs and output are those of `<arm>_forward_dynamics`, whose C is called and whose status other
    than 0 makes CasADi raise; `jac_<arm>_plant` has the exact first derivatives. Raises InputError for
    an arm without that function.
    """
    dynamics = _functions(arm, module).get(f"{arm}_forward_dynamics")
    if dynamics is None:
        raise InputError(
            f"{arm}: row-wise gains leave no forward_dynamics to make a plant of; "
            "use --gains known or estimated"
        )
    name = f"{arm}_plant"
    inputs = dynamics.sx_in()
    plant = ca.Function(name, inputs, dynamics.call(inputs), dynamics.name_in(), dynamics.name_out())
    sizes = [plant.numel_in(i) for i in range(plant.n_in())]
    generator = ca.CodeGenerator(f"{name}_jacobian", {"with_header": False})
    generator.add(plant.jacobian())
    text = render(
        "casadi/plant.c.j2",
        arm=arm,
        count=len(sizes),
        longest=max(sizes),
        pointers=[f"arg[{i}]" for i in range(len(sizes))],
        names=", ".join(f'"{name}"' for name in plant.name_in()),
        shapes=", ".join(f"{{{size}, 1, 1}}" for size in sizes),
        output=plant.name_out(0),
        size=plant.numel_out(0),
        jacobian=generator.dump().strip(),
    )
    return {f"{PLANT}/{name}.c": text}


def _functions(arm: str, module: str) -> dict[str, ca.Function]:
    """The functions of a generated module that is not on the disk."""
    name = f"{arm}_casadi"
    loader = _Loader(module)
    made = importlib.util.module_from_spec(ModuleSpec(name, loader))
    loader.exec_module(made)
    functions: dict[str, ca.Function] = made.functions()
    return functions


class _Loader(importlib.abc.InspectLoader):
    """Imports a module from its text."""

    def __init__(self, source: str) -> None:
        self.source = source

    def get_source(self, fullname: str) -> str:
        return self.source
