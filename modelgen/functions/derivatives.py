"""Derivatives of inverse and forward dynamics to the state and the input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from modelgen.base_parameters import Grouping
from modelgen.functions.arguments import input_units, joint_units, per
from modelgen.functions.assembly import Assembly, Result, from_the_tips, vector
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.objects import STATUS_PIVOT, Function, Output
from modelgen.functions.parametric import WITH, row_wise_dynamics
from modelgen.graph import Expr
from modelgen.graph.differentiate import Direction, tangents
from modelgen.graph.live import cost
from modelgen.graph.substitute import substituted
from modelgen.model.composite import solve
from modelgen.model.derivatives import effort_derivatives
from modelgen.model.dynamics import joint_efforts
from modelgen.model.effect_forces import EffectForces
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, link_motions

Rows = list[list[Expr]]  # n x n, rows of what is differentiated, columns of what by
STATE = ("q", "dq", "ddq")
FEW = 5  # coordinates up to which tangents on the graph may be cheaper than composite bodies
KINKS = "at a kink of a law, as of dry friction at rest, the mean of both sides"


@dataclass(frozen=True)
class Derived:
    """Values (n) and their derivatives, n x n each, by the inputs that are named elsewhere."""

    values: Sequence[Expr]
    by: Sequence[Rows]


def derivative_functions(
    a: Assembly, dynamics: Dynamics, suffix: str, parameters: Sequence[str]
) -> list[Function]:
    """Derivatives of inverse and forward dynamics for one way of giving parameters."""
    e = dynamics.equations
    ideal = ideal_derivatives(dynamics)
    forward, positive = forward_dynamics_derivatives(dynamics, ideal)
    accelerations = vector("ddq", a.n, joint_units(e.arm, "/s^2"), "joint accelerations")
    units = {"q": joint_units(e.arm), "dq": joint_units(e.arm, "/s"), "input": input_units(e)}
    return [
        _inverse_function(a, inverse_dynamics_derivatives(e, ideal), suffix, parameters, WITH[suffix]),
        a.function(
            f"forward_dynamics_derivatives{suffix}",
            f"Accelerations and their derivatives; {KINKS}; {WITH[suffix]}.",
            ["q", "dq", "input", *parameters],
            _results(accelerations, units, forward),
            guards=[(value, STATUS_PIVOT) for value in positive],
            order=_by_columns("ddq", list(units), a.n),
        ),
    ]


def row_wise_derivatives(a: Assembly, rows: Sequence[Grouping]) -> list[Function]:
    """Derivatives of inverse dynamics where every row has base parameters of its own scale."""
    if not rows:
        return []
    by_row = [ideal_derivatives(dynamics) for dynamics in row_wise_dynamics(a, rows)]
    values = [one.values[k] for k, one in enumerate(by_row)]
    ideal = Derived(values, [[one.by[b][k] for k, one in enumerate(by_row)] for b in range(len(STATE))])
    found = inverse_dynamics_derivatives(a.base, ideal)
    return [_inverse_function(a, found, "", ["parameters"], "row-wise base parameters")]


def _inverse_function(
    a: Assembly, found: Derived, suffix: str, parameters: Sequence[str], with_what: str
) -> Function:
    units = dict(zip(STATE, (joint_units(a.real.arm, per) for per in ("", "/s", "/s^2")), strict=True))
    effort = vector("input", a.n, input_units(a.real), "inputs: motor currents, efforts where undriven")
    return a.function(
        f"inverse_dynamics_derivatives{suffix}",
        f"Inputs that give the accelerations ddq, and their derivatives; {KINKS}; {with_what}.",
        [*STATE, *parameters],
        _results(effort, units, found),
        order=[
            *(("input", k) for k in range(a.n)),
            *from_the_tips([f"input_by_{x}" for x in STATE], a.n),
        ],
    )


def _results(value: Output, units: Mapping[str, str], found: Derived) -> list[Result]:
    """Outputs of a function: its values, then a matrix by each of the inputs in `units`."""
    results: list[Result] = [(value, found.values)]
    for (name, unit), matrix in zip(units.items(), found.by, strict=True):
        text = f"d {value.name} / d {name}"
        output = Output(f"{value.name}_by_{name}", value.rows, value.rows, per(value.unit, unit), text)
        results.append((output, [x for row in matrix for x in row]))
    return results


def _by_columns(name: str, by: Sequence[str], n: int) -> list[tuple[str, int]]:
    """Order of computation: the values, then what belongs to one joint's motion, from the last joint on."""
    columns = [(f"{name}_by_{x}", n * row + j) for j in reversed(range(n)) for x in by for row in range(n)]
    return [*((name, k) for k in range(n)), *columns]


def ideal_derivatives(dynamics: Dynamics) -> Derived:
    """Derivatives of the inputs of ideal drives: the links' by composite bodies, the rest by tangents on the
    graph; all by tangents in a fluid, and where that is cheaper.
    """
    e = dynamics.equations
    rates = Rates(e.vector("dq"), e.vector("ddq"))
    links = e.link_values(dynamics.values)
    added = EffectForces(e, rates, dynamics.values).inputs()
    inverse_gains = [drive.inverse_gain for drive in e.drives]
    found = []
    for frames in (e.frames, e.frames_factored):
        efforts = joint_efforts(frames, link_motions(frames, rates), links)
        values = [x * k + more for x, k, more in zip(efforts, inverse_gains, added, strict=True)]
        found.append((values, efforts, frames))
    values, efforts, frames = min(found, key=lambda one: cost(e.graph, one[0]))
    by_graph = e.arm.fluid_density or e.n <= FEW
    derived = [Derived(values, jacobians(e, values, STATE))] if by_graph else []
    if not e.arm.fluid_density:
        of_links = effort_derivatives(frames, rates, links)
        by = jacobians(e, added, STATE)
        slopes = jacobians(e, inverse_gains, ("q",))[0]
        for block, matrix in zip(by, (of_links.by_q, of_links.by_dq, of_links.by_ddq), strict=True):
            for row, gain, derivative in zip(block, inverse_gains, matrix, strict=True):
                row[:] = [x + y * gain for x, y in zip(row, derivative, strict=True)]
        for k, (row, effort) in enumerate(zip(by[0], efforts, strict=True)):
            row[k] = row[k] + effort * slopes[k][k]
        derived.append(Derived(values, by))
    return min(derived, key=lambda one: _cost(e, one))


def inverse_dynamics_derivatives(e: Equations, ideal: Derived) -> Derived:
    """Inputs that the drives need for those of ideal ones, and their derivatives by q, dq and ddq."""
    if e.ideal_inputs:
        return ideal
    effects = EffectForces(e, Rates(e.zeros(), e.zeros()))
    slopes = jacobians(e, effects.required(e.vector("input")), ("input",))[0]
    given = {("input", k): x for k, x in enumerate(ideal.values)}
    own = substituted([row[k] for k, row in enumerate(slopes)], given)
    by = [[[x * k for x in row] for row, k in zip(block, own, strict=True)] for block in ideal.by]
    return Derived(effects.required(ideal.values), by)


def forward_dynamics_derivatives(dynamics: Dynamics, ideal: Derived) -> tuple[Derived, list[Expr]]:
    """Accelerations, their derivatives by q, dq, input, and what must be positive: see `solve`.

    d ddq = M^-1 K (d input - d inverse dynamics) at the accelerations found (Carpentier and Mansard 2018).
    """
    e = dynamics.equations
    n, dq, given = e.n, e.vector("dq"), e.vector("input")
    accelerations, positive = dynamics.forward_dynamics(dq, given)
    # The graph knows the factors of the mass matrix from the accelerations.
    inverse = _inverse(e, dynamics.mass_matrix(dq))
    by_ideal = [[x * gain for x, gain in zip(row, dynamics.gains(), strict=True)] for row in inverse]
    effective = EffectForces(e, Rates(e.zeros(), e.zeros())).effective(given)
    by_input = jacobians(e, effective, ("input",))[0]
    # The accelerations were inputs while it was differentiated: they are held.
    by_state = [-x for rows in ideal.by[:2] for row in rows for x in row]
    solved = substituted(by_state, {("ddq", k): x for k, x in enumerate(accelerations)})
    rows = [solved[n * k : n * (k + 1)] for k in range(2 * n)]
    return Derived(accelerations, [_times(e, by_ideal, x) for x in (rows[:n], rows[n:], by_input)]), positive


def jacobians(e: Equations, values: Sequence[Expr], by: Sequence[str]) -> list[Rows]:
    """Derivatives of `values` by the elements of the inputs named."""
    directions = [_direction(e, name, k) for name in by for k in range(e.n)]
    columns = tangents(values, directions)
    blocks = [columns[e.n * b : e.n * (b + 1)] for b in range(len(by))]
    return [[[column[i] for column in block] for i in range(len(values))] for block in blocks]


def _direction(e: Equations, name: str, k: int) -> Direction:
    """A unit rate of one element; sines and cosines that are inputs go along with their angle."""
    graph = e.graph
    direction = {(name, k): graph.one}
    if name == "q":
        direction[("sin_q", k)], direction[("cos_q", k)] = graph.input("cos_q", k), -graph.input("sin_q", k)
    return direction


def _inverse(e: Equations, matrix: Rows) -> Rows:
    """Inverse of a symmetric matrix, each pair of elements once."""
    inverse = [e.zeros() for _ in range(e.n)]
    for k in range(e.n):
        unit = e.zeros()
        unit[k] = e.graph.one
        column, _ = solve(matrix, unit)
        for i in range(k + 1):
            inverse[i][k] = inverse[k][i] = column[i]
    return inverse


def _cost(e: Equations, found: Derived) -> int:
    return cost(e.graph, [*found.values, *(x for matrix in found.by for row in matrix for x in row)])


def _times(e: Equations, a: Rows, b: Rows) -> Rows:
    product: Rows = []
    for row in a:
        product.append([])
        for column in zip(*b, strict=True):
            total = e.graph.zero
            for x, y in zip(row, column, strict=True):
                total = total + x * y
            product[-1].append(total)
    return product
