"""Text of a Python module with the arm's functions in CasADi. CasADi itself is not imported here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from modelgen.backends.body import body
from modelgen.backends.documentation import (
    argument_row,
    function_operations,
    function_sections,
    model_sections,
    output_text,
    remarks,
    unit,
)
from modelgen.backends.elements import Element, base_parameters, local_names
from modelgen.backends.provenance import Provenance
from modelgen.backends.text import plain, render, table, with_remark, wrapped, wrapped_code
from modelgen.functions.objects import Function, Model

_SPELLING = {"abs": "fabs", "min": "fmin", "max": "fmax", "pow": "power"}
_INDENT = "    "
_PLAIN = "ca.SX.sym, function"  # of symbols and functions of an AcadosModel
_BY_CHOICE = f"(ca.MX.sym, with_jacobian) if custom_jacobian else ({_PLAIN})"


def casadi_files(model: Model, provenance: Provenance) -> dict[str, str]:
    """Text of `<arm>_casadi.py`, by its path below the arm's folder."""
    arm = model.arm.name
    names = {f.name for f in model.functions}
    jacobian = any("_dynamics_derivatives" in name for name in names)
    text = render(
        "casadi/module.py.j2",
        arm=arm,
        remarks=remarks(model),
        provenance=provenance.head(arm),
        sections=model_sections(model),
        custom_jacobian=jacobian,
        argument="custom_jacobian: bool = False" if jacobian else "",
        made=_BY_CHOICE if jacobian else _PLAIN,
        acados={"forward_dynamics", "inverse_dynamics"} <= names,
        nominal=[
            (f"{value!r},", f"# {p.name} {unit(p.unit)}")
            for value, p in zip(model.nominal, base_parameters(model), strict=bool(model.nominal))
        ],
        functions=[_values(model, function) for function in model.functions],
    )
    return {f"{arm}_casadi.py": text}


class CasadiDialect:
    """Statements of one function on lists of SX scalars."""

    def __init__(self, function: Function, named: Mapping[str, Sequence[Element | None]]) -> None:
        self.named = named
        self.lists = {o.name: _variable(function, o.name) for o in function.outputs}

    def constant(self, value: float) -> str:
        """The fewest digits that give back the same number."""
        return repr(float(value))

    def element(self, vector: str, index: int) -> str:
        """The element's own name where it has one."""
        elements = self.named.get(vector)
        element = elements[index] if elements else None
        return element.name if element else f"{vector}[{index}]"

    def temporary(self, number: int) -> str:
        """t0, t1, ..."""
        return f"t{number}"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A function of the casadi module."""
        if function == "select":
            return f"ca.if_else({arguments[0]} > 0, {arguments[1]}, {arguments[2]})"
        return f"ca.{_SPELLING.get(function, function)}({', '.join(arguments)})"

    def load(self, element: Element, source: str) -> str:
        """A parameter with its unit."""
        return f"{_INDENT}{element.name} = {source}  # {element.unit}"

    def let(self, number: int, text: str) -> str:
        """An intermediate value."""
        return _assignment(f"t{number}", text)

    def store(self, output: str, index: int, text: str) -> str:
        """An element of an output."""
        return _assignment(f"{self.lists[output]}[{index}]", text)

    def remarked(self, statement: str, text: str) -> str:
        """Behind the statement where there is room, else before it."""
        return with_remark(statement, f"# {text}", _INDENT)

    def guard(self, status: int, text: str) -> str:
        """Nothing: a CasADi function has no status."""
        return ""


def _assignment(target: str, text: str) -> str:
    line = f"{_INDENT}{target} = {text}"
    return line if len(line) <= 110 else wrapped_code(f"{target} = ({text})", _INDENT, _INDENT * 2)


def _variable(function: Function, output: str) -> str:
    """The list that collects an output: `out` where there is one, as in C."""
    return "out" if len(function.outputs) == 1 else f"out_{output}"


def _list(items: Sequence[str]) -> str:
    """A Python list in print, for an assignment to a name."""
    return wrapped(f"[{', '.join(items)}]", "", _INDENT * 2, 95)


def _values(model: Model, function: Function) -> dict[str, object]:
    named = local_names(model, function)
    inputs = ", ".join(a.name for a in function.arguments)
    outputs = ", ".join(o.name for o in function.outputs)
    rows = [("in", *argument_row(model, function, a)) for a in function.arguments]
    rows += [("out", o.name, f"[{o.size}]", unit(o.unit), output_text(o)) for o in function.outputs]
    sections = [s for s in function_sections(model, function) if s.title.startswith("Columns of")]
    names = {o.name for o in function.outputs}
    return {
        "name": function.name,
        "head": wrapped(f"{function.name}({inputs}) -> {outputs}", "", "    ").split("\n"),
        "summary": wrapped(plain(function.text), width=100).split("\n"),
        "table": table(rows),
        "sections": sections,
        "operations": function_operations(function),
        "inputs": _list([f'ca.SX.sym("{a.name}", {a.size})' for a in function.arguments]),
        "unpacked": ", ".join(a.name for a in function.arguments),
        "lists": [(_variable(function, o.name), str(o.size)) for o in function.outputs],
        "statements": list(body(function, named, CasadiDialect(function, named))),
        "results": _list(
            [
                f"_vector({_variable(function, o.name)})"
                if o.columns == 1
                else f"_matrix({_variable(function, o.name)}, {o.rows}, {o.columns})"
                for o in function.outputs
            ]
        ),
        "input_names": _list([f'"{a.name}"' for a in function.arguments]),
        "output_names": _list([f'"{o.name}"' for o in function.outputs]),
        # A state goes in and comes out under one name, which CasADi allows on demand alone.
        "options": '{"allow_duplicate_io_names": True}'
        if names & {a.name for a in function.arguments}
        else "{}",
    }
