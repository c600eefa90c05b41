"""Operations in straight-line C that other tools wrote."""

from __future__ import annotations

import re

_TOKEN = re.compile(
    r"(?P<number>\d[\d.]*(?:[eE][-+]?\d+)?|\.\d+)|(?P<name>[A-Za-z_][\w:]*)|(?P<other>[^\s\w])"
)
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_KINDS = {"*": "mul", "+": "add", "-": "add", "/": "div"}
_CALLS = {"sin": "trig", "cos": "trig", "sqrt": "sqrt", "casadi_sq": "mul", "pow": "mul"}


def operations(text: str) -> dict[str, int]:
    """Operations by kind in the statements of C: a subtraction is an addition, a square a multiplication.

    The sign of a number is part of it. Declarations must be without pointers: pass a function's body.
    """
    found = dict.fromkeys(("mul", "add", "neg", "div", "sqrt", "trig"), 0)
    before = ""
    tokens = list(_TOKEN.finditer(_COMMENT.sub("", text)))
    for k, token in enumerate(tokens):
        word = token[0]
        if token["name"]:
            kind = _CALLS.get(word.rpartition(":")[2])
            if kind and tokens[k + 1][0] == "(":
                found[kind] += 1
        elif word in _KINDS:
            operand = before[-1:].isalnum() or before[-1:] in ("_", ")", "]")
            if operand and before != "return":
                found[_KINDS[word]] += 1
            elif word == "-" and not tokens[k + 1]["number"]:
                found["neg"] += 1
        before = word
    return found


def traced(text: str) -> dict[str, dict[str, int]]:
    """Operations of the functions in C that CasADi wrote."""
    bodies = re.findall(
        r"^/\* traced_(\w+):.*?^\s*static int [^{]*\{(.*?)^\}", text, re.DOTALL | re.MULTILINE
    )
    return {name: operations(body) for name, body in bodies}


def kane(text: str) -> dict[str, dict[str, int]]:
    """Operations of the functions in C that sympy_kane wrote."""
    return {
        name: operations(body)
        for name, body in re.findall(r"^void kane_(\w+)\([^{]*\{(.*?)^\}", text, re.DOTALL | re.MULTILINE)
    }


def symforce(text: str) -> dict[str, int]:
    """Operations of one header that SymForce wrote."""
    body = text[text.index("// Input arrays") :]
    return operations(re.sub(r"^.*(?:\(\*|& _).*$", "", body, flags=re.MULTILINE))
