"""An arm as a ROS 2 package: its C as a library, a C++ class over it, a node for the feed-forward."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from modelgen.backends.c.dialect import arrays
from modelgen.backends.elements import coordinates
from modelgen.backends.provenance import Provenance
from modelgen.backends.text import UNBROKEN, WIDTH, plain, render, table, wrapped
from modelgen.functions.objects import Function, Model
from modelgen.functions.parametric import SUFFIXES
from modelgen.packaging.files import version

ROS2 = "ros2"  # folder below the arm's
_WIDTH = WIDTH - 4  # of what is indented in a class
_OF_A_STATE = {"q", "dq", "ddq", "parameters"}  # what the node knows of a desired state


@dataclass(frozen=True)
class _Values:
    """Base parameters that the package knows: their name in C++, what they are, and the numbers."""

    name: str
    text: str
    numbers: tuple[float, ...]
    lines: tuple[str, ...]


def package_name(arm: str) -> str:
    """Name of an arm's package after REP 144: lower case, no two underscores beside each other."""
    return re.sub("_+", "_", f"{arm.lower()}_model")


def ros2_files(
    model: Model, provenance: Provenance, files: Mapping[str, str], identified: Mapping[str, float]
) -> dict[str, str]:
    """Text of the package's files by path below the arm's folder, whose files are `files`.

    identified: values of the base parameters by name, which the class and the node begin with; where it is
    empty, the model's nominal ones; where there are none either, they are to be given at run time.
    """
    arm = model.arm.name
    package = package_name(arm)
    known = _known(model, identified)
    missing = _missing(model)
    node = "" if missing else f"{arm}_feed_forward"
    common = {
        "arm": arm,
        "macro": arm.upper(),
        "package": package,
        "node": node,
        "provenance": provenance.head(arm),
        "version": version(model.arm.version),
    }
    own = {path: text for path, text in files.items() if path.startswith("src/") and path != f"src/{arm}.h"}
    made = {f"include/{package}/{arm}.h": files[f"include/{arm}.h"], **own}
    made["package.xml"] = render("ros2/package.xml.j2", **common)
    made["CMakeLists.txt"] = render(
        "ros2/CMakeLists.txt.j2",
        **common,
        default=provenance.real,
        real=f"${{{arm.upper()}_REAL}}",
        sources=sorted(path for path in own if path.endswith(".c")),
    )
    made[f"include/{package}/{arm}.hpp"] = render(
        "ros2/model.hpp.j2",
        **common,
        joints=[f'"{plain(c.name)}",' for c in coordinates(model)],
        units=[f'"{unit}",' for unit in _units(model)],
        arrays=known,
        known=known[0].name if known else "",
        methods=[_method(arm, f) for f in model.functions if _wrapped(f)],
    )
    made["README.md"] = _readme(model, known, missing, common)
    if node:
        made[f"include/{package}/{node}.hpp"] = render("ros2/feed_forward.hpp.j2", **common)
        made[f"src/{node}.cpp"] = render("ros2/feed_forward.cpp.j2", **common, defaults=_defaults(known))
    return {f"{ROS2}/{package}/{path}": text for path, text in made.items()}


def _known(model: Model, identified: Mapping[str, float]) -> list[_Values]:
    """Values of the base parameters that are at hand, those that serve best first."""
    found = []
    if identified:
        numbers = tuple(float(identified[p.name]) for p in model.grouping.base)
        text = "Base parameters that were identified."
        found.append(_Values("IDENTIFIED_PARAMETERS", text, numbers, _rows(model, numbers)))
    if model.nominal:
        text = "Base parameters that the description's links and effects give."
        found.append(_Values("NOMINAL_PARAMETERS", text, model.nominal, _rows(model, model.nominal)))
    return found


def _rows(model: Model, numbers: tuple[float, ...]) -> tuple[str, ...]:
    rows = zip(numbers, model.grouping.base, strict=True)
    return tuple(table((f"{value!r},", f"/* {p.name} [{p.unit}] */") for value, p in rows))


def _defaults(known: list[_Values]) -> str:
    """Arguments of the vector that the node's parameter begins with."""
    return f"(arm::{known[0].name}.begin(), arm::{known[0].name}.end())" if known else "{}"


def _units(model: Model) -> list[str]:
    """Unit of each joint's input."""
    output = _inverse_dynamics(model).outputs[0]
    units = output.unit.split(", ")
    return units * output.size if len(units) == 1 else units


def _inverse_dynamics(model: Model) -> Function:
    return model.function("inverse_dynamics")


def _missing(model: Model) -> list[str]:
    """Inputs of the inverse dynamics that a desired state does not hold."""
    return [a.name for a in _inverse_dynamics(model).arguments if a.name not in _OF_A_STATE]


def _wrapped(function: Function) -> bool:
    """Whether the class has it: no twin with other parameters, none that the user has named."""
    return not function.parts and not function.name.endswith(SUFFIXES)


def _method(arm: str, function: Function) -> list[str]:
    """Lines of the class's method that calls a function with the class's parameters."""
    takes, passes = [], []
    for a in function.arguments:
        if a.name == "parameters":
            passes.append("parameters_.data()")
        else:
            takes.append(f"const{UNBROKEN}Vector<{a.size}>&{UNBROKEN}{a.name}")
            passes.append(f"{a.name}.data()")
    for name, size in arrays(function).items():
        takes.append(f"Vector<{size}>&{UNBROKEN}{name}")
        passes.append(f"{name}.data()")
    name = f"Status{UNBROKEN}{function.name}"
    head = wrapped(f"{name}({', '.join(takes)}){UNBROKEN}const{UNBROKEN}noexcept", "", "    ", _WIDTH)
    call = wrapped(f"return{UNBROKEN}{arm}_{function.name}({', '.join(passes)});", "    ", "        ", _WIDTH)
    text = wrapped(f"/** {plain(function.text)} */", "", " *  ", _WIDTH)
    return [*text.split("\n"), *head.split("\n"), "{", *call.split("\n"), "}"]


def _readme(model: Model, known: list[_Values], missing: list[str], common: Mapping[str, object]) -> str:
    count = len(model.grouping.base)
    if known:
        default = f"base parameters; `{known[0].name}` where none are given"
        given = f"`Model{{}}` holds `{known[0].name}`, `Model{{values}}` others, in the order of the header."
    else:
        default = "base parameters; without them the node does not start"
        given = f"the {count} base parameters, identified ones mostly, in the order of the header."
    joints = [f"{i}. `{plain(c.name)}`" for i, c in enumerate(coordinates(model), 1)]
    units = _units(model)
    reason = ""
    if missing:
        read = " and ".join(f"`{name}`" for name in missing)
        reason = (
            f"the inverse dynamics of this arm read {read} too, which no message holds; the class has it."
        )
    return render(
        "ros2/readme.md.j2",
        **common,
        braces="{}" if known else "{parameters}",
        parameters=given,
        listed=", ".join(p.name for p in model.grouping.base),
        count=str(count),
        default=default,
        joints=[f"{joint} [{unit}]" for joint, unit in zip(joints, units, strict=True)],
        reason=reason,
    )
