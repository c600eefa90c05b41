"""C and C++ that other symbolic tools wrote, behind the harness."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from peers.build import Built, object_file, pinocchio_flags, program
from peers.harness_source import harness_source

_INPUTS = {
    "inverse_dynamics": "q, dq, third",
    "mass_matrix": "q",
    "forward_dynamics": "q, dq, third",
    "regressor": "q, dq, third",
}


TRACED = tuple(_INPUTS)
TRACED_BESIDES = ("mass_matrix_world", "forward_dynamics_world")  # in Pinocchio's default convention
TRACED_DERIVATIVES = ("inverse_dynamics_derivatives", "forward_dynamics_derivatives")


def sizes(joints: int, functions: Iterable[str] = _INPUTS) -> dict[str, int]:
    """Elements of the results."""
    squares = {"mass_matrix": joints**2, "regressor": 10 * joints**2}
    squares |= dict.fromkeys(TRACED_DERIVATIVES, joints + 3 * joints**2)
    return {name: squares.get(name.removesuffix("_world"), joints) for name in functions}


def traced(
    sources: Sequence[Path],
    joints: int,
    names: Sequence[str] = (*TRACED, *TRACED_BESIDES),
    flags: Sequence[str] = (),
) -> Built:
    """C that CasADi wrote of the functions `names`, by default TRACED and TRACED_BESIDES, whose size does not
    count. flags: of the compiler, besides its own."""
    made = sizes(joints, names)
    declared = "int traced_{0}(const double **, double **, long long *, double *, int);"
    head = "\n".join(declared.format(name) for name in made)
    calls = {
        name: (
            f"const double *in[] = {{q, dq, third}};\n    double *res[] = {{out}};\n"
            f"    traced_{name}(in, res, 0, 0, 0)",
            size,
        )
        for name, size in made.items()
    }
    return _linked(head, calls, sources, flags)


def kane(source: Path, joints: int) -> Built:
    """C that sympy_kane wrote."""
    made = sizes(joints, ("inverse_dynamics", "mass_matrix"))
    types = "const double *, const double *, const double *, double *"
    head = "\n".join(f"void kane_{name}({types});" for name in made)
    calls = {name: (f"kane_{name}(q, dq, third, out)", size) for name, size in made.items()}
    return _linked(head, calls, [source])


def symforce(folder: Path, joints: int) -> Built:
    """C++ that symforce_newton wrote into the folder; Eigen unaligned, to take the inputs as they lie."""
    flags = pinocchio_flags()
    assert flags is not None  # Eigen comes with CasADi
    made = sizes(joints)
    text = [f'#include "{name}.h"' for name in made] + ['#include "peer.h"', "", "namespace {"]
    text += [f"using V = Eigen::Matrix<double, {joints}, 1>;"]
    for name, size in made.items():
        title = "".join(word.capitalize() for word in name.split("_"))
        inputs = _INPUTS[name].split(", ")
        given = ", ".join(f"*reinterpret_cast<const V *>({x})" for x in inputs)
        names = (x if x in inputs else "" for x in ("q", "dq", "third"))
        text += [
            f"const double *{name}({', '.join(f'const double *{x}' for x in names)})",
            "{",
            f"    static Eigen::Matrix<double, {joints}, {size // joints}> out;",
            f"    sym::{title}<double>({given}, &out);",
            "    return out.data();",
            "}",
        ]
    text += ["}", "", "const peer_function *peer_open(const char *)", "{"]
    rows = ", ".join(f'{{"{name}", {size}, {name}}}' for name, size in made.items())
    text += [f"    static const peer_function functions[] = {{{rows}, {{nullptr, 0, nullptr}}}};"]
    text += ["    return functions;", "}"]
    source = folder / "functions.cpp"
    source.write_text("\n".join(text) + "\n", encoding="utf-8")
    code = object_file(source, folder / "functions.o", *flags, "-DEIGEN_MAX_ALIGN_BYTES=0", "-fno-math-errno")
    return Built(program(folder / "program", [code]), [code])


def _linked(
    head: str, calls: Mapping[str, tuple[str, int]], sources: Sequence[Path], flags: Sequence[str] = ()
) -> Built:
    """The harness with the sources; the first one's object is what counts."""
    folder = sources[0].parent
    wrapper = folder / "wrapper.c"
    wrapper.write_text(harness_source(head, calls), encoding="utf-8")
    objects = [object_file(path, folder / f"{path.stem}.o", *flags) for path in sources]
    objects.append(object_file(wrapper, folder / "wrapper.o"))
    return Built(program(folder / "program", objects), objects[:1])
