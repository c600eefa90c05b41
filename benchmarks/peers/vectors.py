"""Four states at once: the generated programs in vectors of four doubles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.functions import build_model, nominal_base
from modelgen.graph import Program, Term
from peers.arms import LINKS_ALONE, Subject
from peers.build import object_file, program
from peers.harness_source import harness_source
from peers.measure import Call, instructions, values
from peers.ours import FUNCTIONS

Array = NDArray[np.float64]
_LANES = 4
_AGREEMENT = 1e-9
_INPUTS = ("q", "dq", "third", "sin_q", "cos_q")
_HEAD = """\
typedef double V __attribute__((vector_size(32)));
"""
_OPERATORS = {"add": "+", "sub": "-", "mul": "*", "div": "/"}


def _text(term: Term) -> str:
    """C of a term."""
    tag = term[0]
    if tag == "const":
        return f"({term[1]!r})"
    if tag == "let":
        return f"t{term[1]}"
    if tag == "in":
        name = "third" if term[1] in ("ddq", "input") else term[1]
        return f"{name}[{term[2]}]"
    if tag == "neg":
        return f"(-{_text(term[1])})"
    return f"({_text(term[1])} {_OPERATORS[tag]} {_text(term[2])})"


def _function(name: str, made: Program, kind: str) -> str:
    """C of a program whose values are of the type `kind`; tests of pivots left out."""
    arguments = ", ".join(f"const {kind} *{x}" for x in _INPUTS)
    lines = [f"static __attribute__((noinline)) void {name}({arguments}, {kind} *out)", "{"]
    lines += [f"    (void){x};" for x in _INPUTS]
    for statement in made.statements:
        if isinstance(statement.target, int):
            lines.append(f"    const {kind} t{statement.target} = {_text(statement.term)};")
        elif statement.target[0] != "guard":
            zero = "" if kind == "double" else " + (V){0, 0, 0, 0}"
            lines.append(f"    out[{statement.target[1]}] = {_text(statement.term)}{zero};")
    return "\n".join([*lines, "}", ""])


def _filled(kind: str, joints: int) -> str:
    """Statements that copy the state, and some sines and cosines, into vectors."""
    sources = dict(zip(_INPUTS, ("q", "dq", "third", "dq", "third"), strict=True))
    lines = [f"static {kind} {', '.join(f'v_{x}[{joints}]' for x in _INPUTS)};"]
    lines += [f"for (int i = 0; i < {joints}; i++) {{"]
    lines += [f"    v_{x}[i] = {source}[i] + ({kind}){{0}};" for x, source in sources.items()]
    return "\n    ".join([*lines, "}"])


def packed(case: Subject, folder: Path) -> dict[str, dict[str, float]]:
    """Instructions per state of each function, for one state and for four at once.

    Sine and cosine are given, inputs and pivots not tested. Raises RuntimeError where the results differ.
    """
    options = replace(LINKS_ALONE, sincos=True)
    model = build_model(case.arm, options)
    model = build_model(case.arm, replace(options, identified=nominal_base(model)))
    functions = {f.name: f for f in model.functions}
    made = {key: functions[f"{key}_identified" if both else key] for key, (_, both) in FUNCTIONS.items()}
    counts: dict[str, dict[str, float]] = {}
    results: dict[str, dict[str, Array]] = {}
    for kind, lanes in (("double", 1), ("V", _LANES)):
        copied = _filled(kind, case.joints)
        given = ", ".join(f"v_{x}" for x in _INPUTS)
        calls = {"nothing": (f"{copied}\n    (void)out", 1)}
        text = [_HEAD]
        for key, function in made.items():
            text.append(_function(key, function.program, kind))
            calls[key] = (f"{copied}\n    {key}({given}, ({kind} *)out)", function.outputs[0].size * lanes)
        unit = folder / f"lanes_{kind}.c"
        source = harness_source("\n".join(text), calls)
        unit.write_text(
            source.replace("static double out", "static _Alignas(32) double out"), encoding="utf-8"
        )
        call = Call(
            program(folder / f"lanes_{kind}", [object_file(unit, unit.with_suffix(".o"))]), folder, case
        )
        results[kind] = values(call)
        found = instructions(call)
        counts[kind] = {key: round((found[key] - found["nothing"]) / lanes, 1) for key in made}
    for key in made:
        one = results["double"][key]
        four = results["V"][key].reshape(*one.shape, _LANES)
        if not np.abs(four - one[..., None]).max() < _AGREEMENT * np.abs(one).max():
            raise RuntimeError(f"{case.arm.name}: {key} in vectors differs")
    return {"one": counts["double"], "four": counts["V"]}
