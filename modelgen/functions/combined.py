"""Functions that do the work of several at once: their programs merged in one graph, what they share once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from modelgen.description.objects import Arm, Combined
from modelgen.errors import InputError, suggest
from modelgen.functions.objects import Argument, Function, Output
from modelgen.functions.parametric import SUFFIXES, WITH
from modelgen.graph import Expr, Graph, count_operations, lower
from modelgen.graph.restored import restored

# Order of the inputs; what is not listed stands behind.
ORDER = ("q", "sin_q", "cos_q", "dq", "ddq", "dq_r", "ddq_r", "input", "q_m", "dq_m", "ddq_m", "dt")
# Names that the arm's code has besides its functions.
TAKEN = frozenset(
    (
        "bounded",
        "check_parameters",
        "held",
        "lanes",
        "levels",
        "max",
        "min",
        "motors_onto_strokes",
        "model",
        "monitor_alarms",
        "observer_alarms",
        "observer_gain",
        "observer_threshold",
        "onto_strokes",
        "pair_t",
        "plant",
        "private",
        "real_t",
        "select",
        "sign",
        "sincos",
        "sine_cosine",
        "status_t",
        "within",
        "within_joints",
        "zero",
    )
)
# What the names of functions made of others end in.
ENDS = (*SUFFIXES, "_batch", "_float", "_lanes", "_nearest", "_one")


def combined_functions(arm: Arm, functions: Sequence[Function]) -> list[Function]:
    """What `arm.combined` asks for, for every way of giving parameters that there is.

    Raises InputError for functions that do not exist, and for a name that is in use.
    """
    known = {f.name: f for f in functions}
    found: list[Function] = []
    for one in arm.combined:
        _check(one, known)
        for suffix in [s for s in WITH if f"inverse_dynamics{s}" in known]:
            parts = [_part(known, name, suffix) for name in one.functions]
            present = [part for part in parts if part is not None]
            if len(present) == len(parts):
                found.append(_combined(f"{one.name}{suffix}", present, WITH[suffix]))
    return found


def _check(one: Combined, known: Mapping[str, Function]) -> None:
    plain = [name for name in known if not name.endswith(SUFFIXES)]
    if one.name in TAKEN or one.name in known or one.name.startswith("lanes_") or one.name.endswith(ENDS):
        listed = ", ".join(ENDS)
        raise InputError(
            f"'{one.name}' is in use or ends in one of {listed}; choose another name",
            one.at,
        )
    for k, name in enumerate(one.functions):
        where = one.where[k] if one.where else one.at
        if _plain(name, known) is None:
            raise InputError(
                f"combined '{one.name}': found '{name}', expected functions of the arm"
                f"{suggest(name, plain, listed=True)}",
                where,
            )
        if name in one.functions[:k]:
            raise InputError(f"combined '{one.name}': found '{name}' twice, expected each once", where)


def _plain(name: str, known: Mapping[str, Function]) -> Function | None:
    """The function of a name without a suffix, for whichever parameters there is one."""
    if name.endswith(SUFFIXES):
        return None
    return next((known[f"{name}{s}"] for s in WITH if f"{name}{s}" in known), None)


def _part(known: Mapping[str, Function], name: str, suffix: str) -> Function | None:
    """The function for one way of giving parameters; one that takes none serves every way."""
    own = known.get(f"{name}{suffix}")
    if own is not None:
        return own
    without = known.get(name)
    takes = without is not None and any(a.name == "parameters" for a in without.arguments)
    return None if takes else without


def _combined(name: str, parts: Sequence[Function], with_what: str) -> Function:
    graph = Graph()
    taken = [o.name for part in parts if not part.stacked for o in part.outputs]
    arguments: dict[str, Argument] = {a.name: a for part in parts for a in part.arguments}
    outputs: list[Output] = []
    values: dict[str, list[Expr]] = {}
    guards: list[tuple[Expr, int]] = []
    orders: list[list[tuple[str, int]]] = []  # of every part its own
    for part in parts:
        of_part, demands = restored(graph, part.program)
        guards += demands
        places: dict[str, tuple[str, int]] = {}
        own = [[of_part.get((o.name, i), graph.zero) for i in range(o.size)] for o in part.outputs]
        if part.stacked:
            first = part.outputs[0]
            rows = sum(o.rows for o in part.outputs)
            outputs.append(Output(part.name, rows, first.columns, first.unit, "one below the other"))
            values[part.name] = [x for block in own for x in block]
            offset = 0
            for output in part.outputs:
                places[output.name] = part.name, offset
                offset += output.size
            orders.append([(places[o][0], places[o][1] + i) for o, i in of_part])
            continue
        for output, block in zip(part.outputs, own, strict=True):
            clear = taken.count(output.name) == 1 and output.name not in arguments
            alone = len(part.outputs) == 1
            called = output.name if clear else part.name if alone else f"{part.name}_{output.name}"
            outputs.append(replace(output, name=called))
            values[called] = block
            places[output.name] = called, 0
        orders.append([(places[o][0], i) for o, i in of_part])
    # The part with the most elements first: the others read what it leaves.
    ordered = [place for order in sorted(orders, key=len, reverse=True) for place in order]
    program = lower(values, guards, ordered)
    known = {k: place for place, k in enumerate(ORDER)}
    listed = sorted(arguments.values(), key=lambda a: known.get(a.name, len(known)))
    names = [part.name for part in parts]
    return Function(
        name,
        f"{', '.join(names[:-1])}{' and ' if names[:-1] else ''}{names[-1]} in one call; {with_what}.",
        tuple(listed),
        tuple(outputs),
        program,
        count_operations(program),
        tuple(dict.fromkeys(r for part in parts for r in part.ranges)),
        parts=tuple(names),
    )
