"""An emitted function as a CasADi function in memory, where no text is wanted."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from modelgen.functions.objects import Function
from modelgen.graph import Term

_BINARY = {"add": ca.OP_ADD, "sub": ca.OP_SUB, "mul": ca.OP_MUL, "div": ca.OP_DIV}
_NAMES = {"abs": "fabs", "min": "fmin", "max": "fmax", "pow": "power"}


def casadi_function(function: Function) -> ca.Function:
    """The function with named inputs and outputs, columns in and out; matrices as rows x columns.

    As the text of `<arm>_casadi.py` has it: no ranges, no status.
    """
    inputs = {a.name: ca.SX.sym(a.name, a.size) for a in function.arguments}
    outputs = {o.name: [ca.SX(0)] * o.size for o in function.outputs}
    lets: dict[int, ca.SX] = {}
    for statement in function.program.statements:
        target = statement.target
        if isinstance(target, tuple) and target[0] == "guard":
            continue
        value = _value(statement.term, inputs, lets)
        if isinstance(target, int):
            lets[target] = value
        else:
            outputs[target[0]][target[1]] = value
    results = [ca.vertcat(*outputs[o.name]) for o in function.outputs]
    shaped = [
        ca.reshape(x, o.columns, o.rows).T if o.columns > 1 else x
        for x, o in zip(results, function.outputs, strict=True)
    ]
    names = [o.name for o in function.outputs]
    options = {"allow_duplicate_io_names": True} if set(names) & set(inputs) else {}
    return ca.Function(function.name, list(inputs.values()), shaped, list(inputs), names, options)


def _value(term: Term, inputs: Mapping[str, ca.SX], lets: Mapping[int, ca.SX]) -> ca.SX:
    tag = term[0]
    if tag == "const":
        return ca.SX(term[1])
    if tag == "in":
        return inputs[term[1]][term[2]]
    if tag == "let":
        return lets[term[1]]
    name: str
    name, parts = (term[1], term[2:]) if tag == "call" else (tag, term[1:])
    values = [_value(part, inputs, lets) for part in parts]
    if name == "select":
        return ca.if_else(values[0] > 0, values[1], values[2])
    if name == "neg":
        return -values[0]
    if name in _BINARY:
        return ca.SX.binary(_BINARY[name], *values)
    result: ca.SX = getattr(ca, _NAMES.get(name, name))(*values)
    return result
