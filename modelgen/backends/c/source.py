"""The body of one C function: checks of the inputs, and the program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from modelgen.backends.body import body, unset
from modelgen.backends.c.dialect import INDENT, STATUS, CDialect, arrays, literal
from modelgen.backends.c.pairs import pairs
from modelgen.backends.elements import Element
from modelgen.backends.text import UNBROKEN, wrapped
from modelgen.functions.objects import STATUS_INPUT, STATUS_PIVOT, Function

# Functions that make large numbers of small ones; what divides is guarded by the model.
_UNBOUNDED = frozenset({"exp", "pow", "tan", "log"})
_UNROLLED = 8  # elements up to which a sum without a loop is shorter than the time it saves is worth


def unrolled(joints: int) -> bool:
    """Whether vectors with an element for each joint are checked without a loop."""
    return 0 < joints <= _UNROLLED


def statements(
    arm: str, function: Function, named: Mapping[str, Sequence[Element | None]], joints: int
) -> list[str]:
    """The body of the function, line by line. `joints`: size of q. Raises ValueError as `literal` does."""
    status = checked_output(function)
    dialect = CDialect(arm, function, named, checked=bool(status))
    macro = arm.upper()
    lines = [*dialect.indices(), f"{INDENT}{arm}_status_t status = {macro}_STATUS_OK;", ""]
    lines += _checks(arm, function, joints)
    lines += [dialect.leave(f"status != {macro}_STATUS_OK", "status"), ""]
    together, rest = pairs(function.program)
    lines += [dialect.pair(pair) for pair in together]
    lines += body(replace(function, program=rest), {}, dialect)  # names are enumerators, see `indices`
    lines += _zeros(arm, function, dialect)
    if status:
        tests = [f"!{arm}_bounded({array}, {size})" for array, size in arrays(function).items()]
        outside = f"\n{INDENT * 2}|| ".join(tests)
        lines.append(dialect.leave(outside, f"{macro}_STATUS_{STATUS[status]}"))
    lines.append(f"{INDENT}return {macro}_STATUS_OK;")
    return lines


def _checks(arm: str, function: Function, joints: int) -> list[str]:
    """Every test of an input, those that report the same bit in one condition."""
    tests: dict[int, list[str]] = {}
    for a in function.arguments:
        if a.size:
            limit = literal(arm, a.bound * a.bound)
            inside = f"{arm}_within({a.name}, {a.size}, {limit})"
            if a.size == joints and unrolled(joints):
                inside = f"{arm}_within_joints({a.name}, {limit})"
            if a.name == "parameters":
                inside = f"{arm.upper()}_PARAMETERS_USABLE({inside})"
            outside = f"!{inside}"
            tests.setdefault(STATUS_INPUT, []).append(outside)
    for r in function.ranges:
        element = f"{r.argument}[{r.index}]"
        outside = f"{element} < {literal(arm, r.low)} || {element} > {literal(arm, r.high)}"
        tests.setdefault(r.status, []).append(outside)
    lines = []
    for bit, conditions in tests.items():
        listed = f"\n{INDENT * 2}|| ".join(conditions)
        lines += [
            f"{INDENT}if ({listed}) {{",
            f"{INDENT * 2}status |= {arm.upper()}_STATUS_{STATUS[bit]};",
            f"{INDENT}}}",
        ]
    return lines


def _zeros(arm: str, function: Function, dialect: CDialect) -> list[str]:
    """Elements that are zero whatever the inputs: one statement for each row of a matrix."""
    missing = unset(function)
    lines = [f"{INDENT}/* always zero */"] if any(missing.values()) else []
    for output in function.outputs:
        array, offset = dialect.places[output.name]
        for row in range(output.rows):
            columns = [i for i in missing[output.name] if i // output.columns == row]
            if columns:
                chain = "".join(f"{array}[{offset + i}]{UNBROKEN}= " for i in columns)
                lines.append(wrapped(f"{chain}{literal(arm, 0.0)};", INDENT, INDENT * 2))
    return lines


def checked_output(function: Function) -> int:
    """The status to report where an output is not finite, 0 where that cannot happen."""
    if any(s.target == ("guard", STATUS_PIVOT) for s in function.program.statements):
        return STATUS_PIVOT
    if any(output.checked for output in function.outputs):
        return STATUS_INPUT
    calls = {s.term[1] for s in function.program.statements if s.term[0] == "call"}
    return STATUS_INPUT if calls & _UNBOUNDED else 0
