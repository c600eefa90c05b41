"""Recursive least squares of a few parameters beside a controller."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import frexp

import numpy as np

from modelgen.errors import InputError, suggest
from modelgen.functions.assembly import Assembly
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.objects import STATUS_INPUT, Argument, Function, InputRange
from modelgen.functions.parametric import WITH
from modelgen.functions.steps import stepping
from modelgen.graph import Expr, Graph
from modelgen.graph.differentiate import tangents
from modelgen.graph.evaluate import evaluate
from modelgen.graph.graph import CALL
from modelgen.graph.lowering import reachable
from modelgen.graph.substitute import substituted
from modelgen.graph.vectors import dot

SHORTEST_MEMORY = 0.5  # least forgetting factor: a memory of two steps
SINGULAR = 1e-4  # share of its information that a parameter must have for itself to be estimated
LARGEST_STATE = 1e16  # its square is within single precision
LEAST_INFORMATION = 1e-20  # what single precision can divide by


@dataclass(frozen=True)
class Monitored:
    """What is monitored: base parameters by their number, or a standard one that changes several of them.

    base: (number of a base parameter, its change by unit). standard: index of the standard parameter.
    own: whether it is a base parameter.
    """

    name: str
    unit: str
    base: tuple[tuple[int, Expr], ...]
    standard: int
    own: bool


def monitored_parameters(a: Assembly) -> list[Monitored]:
    """What the arm's `monitor` names, of an arm that parts were left out of those that are still there.

    Raises InputError for a name that does not exist, stands twice, or shows nowhere.
    """
    e, grouping = a.base, a.grouping
    numbers = {b.name: k for k, b in enumerate(grouping.base)}
    standard = {p.name: k for k, p in enumerate(e.standard)}
    found: list[Monitored] = []
    for use in e.arm.monitor:
        if use.name in [m.name for m in found]:
            raise InputError(f"monitor: found '{use.name}' twice, expected each once", use.where)
        if use.name in numbers:
            k = numbers[use.name]
            b = grouping.base[k]
            found.append(Monitored(b.name, b.unit, ((k, e.graph.one),), b.representative, own=True))
            continue
        if use.name not in standard:
            if a.options.without or a.options.gains == "row_wise":
                continue
            known = [*numbers, *(name for name in standard if name not in numbers)]
            raise InputError(
                f"monitor: found '{use.name}', expected base or standard parameters of the arm"
                f"{suggest(use.name, known, listed=True)}",
                use.where,
            )
        i = standard[use.name]
        terms = [(k, factor) for k, b in enumerate(grouping.base) for j, factor in b.terms if j == i]
        if not terms:
            raise InputError(f"monitor: {use.name} has no effect on the inputs of this arm", use.where)
        changes = tuple((k, e.scalars(factor)) for k, factor in terms)
        found.append(Monitored(use.name, e.standard[i].unit, changes, i, own=False))
    return found


def monitor(
    a: Assembly,
    dynamics: Dynamics,
    general: Dynamics,
    names: Sequence[Monitored],
    suffix: str,
    folded: Mapping[str, float] | None,
) -> Function:
    """`monitor_step` for one way of giving parameters.

    general: the same dynamics with parameters as inputs. folded: values of the base parameters by name where
    they are no inputs.

    Exponentially weighted least squares (Astrom and Wittenmark 1995, section 2.2) in the form of information
    L and its vector h, for changes x of the monitored parameters against those that are given:

        L = forgetting L + W'W / noise^2, h = forgetting h + W'(input - inverse dynamics) / noise^2, L x = h

    What there is no information of counts as unchanged, so that an arm at rest spoils nothing. Rows of
    joints that rest are left out where dry friction acts.
    """
    a = replace(a, more={"monitor_state": state_argument(names)})
    e = dynamics.equations
    graph, m = e.graph, len(names)
    forgetting, state = graph.input("forgetting", 0), _State(graph, m)
    dq = e.vector("dq")
    model = dynamics.inverse_dynamics(dq, e.vector("ddq"))
    if folded is None:
        given = {("parameters", k): graph.input("parameters", k) for k in range(len(e.standard))}
    else:
        given = {("parameters", k): graph.const(folded[b.name]) for k, b in enumerate(a.grouping.base)}
    columns, scales = _columns(a, general, names, suffix, given)
    errors = [x - y for x, y in zip(e.vector("input"), model, strict=True)]
    weights = _weights(a, model, dq)
    weighted = [[w * x for w, x in zip(weights, column, strict=True)] for column in columns]
    information = {
        (i, j): forgetting * state.information(i, j) + dot(weighted[i], columns[j])
        for i in range(m)
        for j in range(i + 1)
    }
    vector = [forgetting * state.vector(i) + dot(weighted[i], errors) for i in range(m)]
    changes, variances = _solved(graph, information, vector)
    estimates = [_value(graph, one, suffix, given) for one in names]
    estimates = [x + d * scale for x, d, scale in zip(estimates, changes, scales, strict=True)]
    deviations = [graph.sqrt(v) * scale for v, scale in zip(variances, scales, strict=True)]
    after = [*estimates, *deviations, *vector, *(information[key] for key in sorted(information))]
    standard = suffix == "_standard"
    parameters = ["standard_parameters" if standard else "parameters"] if folded is None else []
    function = a.function(
        f"monitor_step{suffix}",
        f"Recursive least squares of {', '.join(one.name for one in names)}, the others as given; state: "
        f"zero at first, then what the step before gave; {WITH[suffix]}.",
        ["q", "dq", "ddq", "input", "forgetting", *parameters, "monitor_state"],
        [(a.of_state("monitor_state", checked=True), after)],
        ranges=[InputRange("forgetting", 0, SHORTEST_MEMORY, 1.0, STATUS_INPUT)],
    )
    return stepping(function, "monitor_state")


def state_argument(names: Sequence[Monitored]) -> Argument:
    """The state that a caller keeps: estimates, deviations, and what is accumulated."""
    m = len(names)
    listed = [f"{one.name} [{one.unit}], {'estimate' if one.own else 'change'}" for one in names]
    listed += [f"{one.name} [{one.unit}], its standard deviation for independent steps" for one in names]
    listed += ["accumulated"] * (m + m * (m + 1) // 2)
    return Argument(
        "monitor_state",
        len(listed),
        "see the list",
        "state of the monitor: estimates, deviations, what is accumulated",
        LARGEST_STATE,
        tuple(listed),
        "N_MONITOR_STATES",
        tuple(3 * m + i * (i + 3) // 2 for i in range(m)),
    )


class _State:
    """Elements of the state of m parameters, in the graph."""

    def __init__(self, graph: Graph, m: int) -> None:
        self.graph, self.m = graph, m

    def vector(self, i: int) -> Expr:
        return self.graph.input("monitor_state", 2 * self.m + i)

    def information(self, i: int, j: int) -> Expr:
        return self.graph.input("monitor_state", 3 * self.m + i * (i + 1) // 2 + j)


def _value(graph: Graph, one: Monitored, suffix: str, given: Mapping[tuple[str, int], Expr]) -> Expr:
    """What is given of it; nothing of a standard parameter among base ones, which are known together."""
    if suffix == "_standard":
        return given["parameters", one.standard]
    return given["parameters", one.base[0][0]] if one.own else graph.zero


def _columns(
    a: Assembly,
    general: Dynamics,
    names: Sequence[Monitored],
    suffix: str,
    given: Mapping[tuple[str, int], Expr],
) -> tuple[list[list[Expr]], list[float]]:
    """Inputs by unit of each, and the units [of the parameter]: powers of two near which a usual motion gives
    an input of 1, so that single precision holds what is accumulated.
    """
    e = general.equations
    graph = e.graph
    model = general.inverse_dynamics(e.vector("dq"), e.vector("ddq"))
    directions = []
    for one in names:
        standard = ((one.standard, graph.one),)
        changed = standard if suffix == "_standard" else one.base
        directions.append({("parameters", k): x for k, x in changed})
    found, scales = [], []
    for column in tangents(model, directions):
        size = _size(a, substituted(column, given))
        scale = 2.0 ** -frexp(size)[1] if size else 1.0
        scales.append(scale)
        found.append([x * scale for x in substituted(column, given)])
    return found, scales


def _size(a: Assembly, column: Sequence[Expr]) -> float:
    """The largest input in a few usual motions: half a radian a second, a radian by second squared."""
    rng = np.random.default_rng(0)
    samples = 16
    drawn = {name: rng.uniform(-1, 1, (samples, max(argument.size, 1))) for name, argument in a.known.items()}
    drawn["parameters"] = rng.uniform(-1, 1, (samples, len(a.real.standard)))
    drawn["dq"] = 0.5 * drawn["dq"]
    for n, drive in enumerate(a.base.drives):
        span = drive.transmission.joint_range()
        low, high = span or (-np.pi, np.pi)
        drawn["q"][:, n] = low + (high - low) * rng.uniform(0.1, 0.9, samples)
    if a.options.sincos:
        drawn["sin_q"], drawn["cos_q"] = np.sin(drawn["q"]), np.cos(drawn["q"])
    if a.real.arm.symbols:
        drawn["geometry"] = np.tile(list(a.real.arm.symbols.values()), (samples, 1))
    with np.errstate(all="ignore"):
        values = np.abs(evaluate(column, drawn, samples))
    return float(np.max(values[np.isfinite(values)], initial=0.0))


def _weights(a: Assembly, model: Sequence[Expr], dq: Sequence[Expr]) -> list[Expr]:
    """1 / noise^2 by row, 0 where the joint rests and dry friction acts."""
    graph, noise = dq[0].graph, a.options.noise
    weights = []
    for k, (x, speed) in enumerate(zip(model, dq, strict=True)):
        weight = graph.const(1.0 if noise is None else noise.input[k] ** -2)
        if any(graph.op[i] == CALL and graph.name[i] == "sign" for i in reachable(graph, [x.key])):
            rest = 0.0 if noise is None else noise.rest_speed[k]
            weight = graph.call("select", graph.call("abs", speed) - rest, weight, graph.zero)
        weights.append(weight)
    return weights


def _solved(
    graph: Graph, information: Mapping[tuple[int, int], Expr], vector: Sequence[Expr]
) -> tuple[list[Expr], list[Expr]]:
    """x with L x = h, and the diagonal of L^-1, by L D L'; zeros where a pivot is too small to divide by."""
    m = len(vector)
    lower: dict[tuple[int, int], Expr] = {}
    scaled: dict[tuple[int, int], Expr] = {}  # L D
    inverses: list[Expr] = []
    for j in range(m):
        whole = information[j, j]
        pivot = whole
        for k in range(j):
            pivot = pivot - lower[j, k] * scaled[j, k]
        usable = pivot - (whole * SINGULAR + LEAST_INFORMATION)
        inverse = 1.0 / graph.call("select", usable, pivot, graph.one)
        inverses.append(graph.call("select", usable, inverse, graph.zero))
        for i in range(j + 1, m):
            rest = information[i, j]
            for k in range(j):
                rest = rest - lower[i, k] * scaled[j, k]
            scaled[i, j] = rest
            lower[i, j] = rest * inverses[j]
    x = list(vector)
    for i in range(m):
        for k in range(i):
            x[i] = x[i] - lower[i, k] * x[k]
    x = [value * inverse for value, inverse in zip(x, inverses, strict=True)]
    for i in reversed(range(m)):
        for k in range(i + 1, m):
            x[i] = x[i] - lower[k, i] * x[k]
    variances = []
    for i in range(m):
        column = {i: graph.one}  # of the inverse of the lower factor
        for k in range(i + 1, m):
            column[k] = -dot([lower[k, j] for j in column], list(column.values()))
        variances.append(dot([c * c for c in column.values()], inverses[i:]))
    return x, variances
