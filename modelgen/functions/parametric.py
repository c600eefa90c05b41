"""Functions of the state and of parameters: efforts, mass matrix, accelerations, energy."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from modelgen.base_parameters import Grouping
from modelgen.errors import InputError
from modelgen.functions.arguments import effort_units, input_units, joint_units
from modelgen.functions.assembly import Assembly, from_the_tips, vector
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.nominal import factor_value
from modelgen.functions.objects import STATUS_PIVOT, Function, Output
from modelgen.graph import Expr
from modelgen.model.equations import Equations

# Suffix of the functions of each way of giving parameters, and what their texts say of it.
WITH = {
    "": "base parameters",
    "_standard": "standard parameters",
    "_identified": "identified parameters, folded in",
    "_nominal": "nominal parameters of the description, folded in",
}
SUFFIXES = tuple(suffix for suffix in WITH if suffix)


def standard_values(equations: Equations) -> list[Expr]:
    """All standard parameters as inputs."""
    return [equations.graph.input("parameters", k) for k in range(len(equations.standard))]


def base_values(
    equations: Equations, grouping: Grouping, first: int = 0, apart: Collection[int] | None = None
) -> list[Expr]:
    """Base parameters as inputs from element `first` on, each in its representative's place.

    apart: as in `drives_apart`.
    """
    values = [equations.graph.zero] * len(equations.standard)
    for k, base in enumerate(grouping.base):
        values[base.representative] = equations.graph.input("parameters", first + k)
    return drives_apart(equations, grouping, values, apart)


def folded_values(equations: Equations, grouping: Grouping, given: Mapping[str, float]) -> list[Expr]:
    """Base parameters as constants."""
    values = [equations.graph.zero] * len(equations.standard)
    for base in grouping.base:
        values[base.representative] = equations.graph.const(given[base.name])
    return drives_apart(equations, grouping, values)


def drives_apart(
    equations: Equations, grouping: Grouping, values: Sequence[Expr], joints: Collection[int] | None = None
) -> list[Expr]:
    """The standard vector with the nominal inertia of drives in its own place, of the elastic joints or of
    `joints` (indices into `arm.joints`).

    values: with base parameters in their representatives' places, those of the links contain it.
    """
    result, graph = list(values), equations.graph
    index = {parameter.name: k for k, parameter in enumerate(equations.standard)}
    if joints is None:
        joints = {effect.joint for effect in equations.effects if effect.elastic and effect.joint is not None}
    for drive in grouping.drives:
        if drive.joint not in joints or drive.nominal is None:
            continue
        if drive.name in index:  # not in equations of another effect alone
            own = index[drive.name]
            result[own] = result[own] + graph.const(drive.nominal)
        of = grouping.base[drive.base].representative
        amount = drive.nominal * factor_value(drive.factor, equations.arm.symbols)
        result[of] = result[of] - graph.const(amount)
    return result


def parametric_functions(
    a: Assembly, dynamics: Dynamics, suffix: str, parameters: Sequence[str]
) -> list[Function]:
    """The functions for one way of giving parameters.

    suffix: "", "_standard", "_identified" or "_nominal"; parameters: names of the parameter inputs, if any.
    """
    e, n = dynamics.equations, a.n
    dq, ddq = e.vector("dq"), e.vector("ddq")
    zeros = e.zeros()
    with_what = WITH[suffix]
    effort = vector("input", n, input_units(e), "inputs: motor currents, efforts where undriven")
    matrix = dynamics.mass_matrix()
    accelerations, positive = dynamics.forward_dynamics(dq, e.vector("input"))
    kinetic, potential = dynamics.energy(dq)
    functions = [
        a.function(
            f"inverse_dynamics{suffix}",
            f"Inputs that give the accelerations ddq in the state q, dq; {with_what}.",
            ["q", "dq", "ddq", *parameters],
            [(effort, dynamics.inverse_dynamics(dq, ddq))],
        ),
        a.function(
            f"gravity{suffix}",
            f"Inputs that hold the arm at rest at q, dry friction apart; {with_what}.",
            ["q", *parameters],
            [(effort, dynamics.inverse_dynamics(zeros, zeros))],
        ),
        a.function(
            f"bias{suffix}",
            f"Inputs without acceleration in the state q, dq; {with_what}.",
            ["q", "dq", *parameters],
            [(effort, dynamics.inverse_dynamics(dq, zeros))],
        ),
        a.function(
            f"mass_matrix{suffix}",
            f"Mass matrix in joint space, drives included; {with_what}.",
            ["q", *parameters],
            [(Output("mass", n, n, "kg m^2, kg m, kg", "mass matrix"), [x for row in matrix for x in row])],
            order=from_the_tips(["mass"], n),
        ),
        a.function(
            f"forward_dynamics{suffix}",
            f"Accelerations that the inputs give in the state q, dq; {with_what}.",
            ["q", "dq", "input", *parameters],
            [(vector("ddq", n, joint_units(e.arm, "/s^2"), "joint accelerations"), accelerations)],
            guards=[(value, STATUS_PIVOT) for value in positive],
        ),
        a.function(
            f"energy{suffix}",
            f"Kinetic and potential energy, drives and springs included; {with_what}.",
            ["q", "dq", *parameters],
            [
                (vector("kinetic", 1, "J", "kinetic energy"), [kinetic]),
                (vector("potential", 1, "J", "potential energy, up to a constant"), [potential]),
            ],
        ),
    ]
    if any(drive.transmission.driven for drive in e.drives):
        efforts = vector("effort", n, effort_units(e.arm), "efforts at the joints")
        functions.append(
            a.function(
                f"joint_effort{suffix}",
                "Efforts of the drives at the joints that give the accelerations ddq in the state q, dq; "
                f"{with_what}.",
                ["q", "dq", "ddq", *parameters],
                [(efforts, dynamics.joint_efforts(dq, ddq))],
            )
        )
    return functions + _of_effects(a, dynamics, suffix, parameters, with_what)


def _of_effects(
    a: Assembly, dynamics: Dynamics, suffix: str, parameters: Sequence[str], with_what: str
) -> list[Function]:
    """States and loads, where an effect has or needs them."""
    e = dynamics.equations
    functions = []
    if any(effect.depends_on("load") for effect in e.effects):
        text = f"Forces at the motor coordinates that the links' weight takes; {with_what}."
        output = vector("load", a.n, "force at the motor coordinate", "loads of the drives")
        functions.append(a.function(f"load{suffix}", text, ["q", *parameters], [(output, dynamics.loads())]))
    if e.state_names():
        states = dynamics.effects_step(e.vector("dq"), e.vector("ddq"), e.graph.input("dt", 0))
        output = vector("state_next", len(states), "see the list of states", "states after dt")
        text = f"States of the effects after dt at constant velocity; {with_what}."
        inputs = ["q", "dq", "dt", *parameters, "state"]
        functions.append(a.function(f"effects_step{suffix}", text, inputs, [(output, states)]))
    return functions


def row_wise_dynamics(a: Assembly, rows: Sequence[Grouping]) -> list[Dynamics]:
    """The dynamics whose row counts, for every row with base parameters of its own scale."""
    firsts = [sum(len(g.base) for g in rows[:k]) for k in range(len(rows))]
    values = [base_values(a.base, g, first) for g, first in zip(rows, firsts, strict=True)]
    return [Dynamics(a.base, v) for v in values]


def row_wise_functions(a: Assembly, rows: Sequence[Grouping]) -> list[Function]:
    """Inverse dynamics and its parts where every row has base parameters of its own scale.

    Mass matrix, forward dynamics and energy need one scale for all rows and do not exist here.
    """
    e = a.base
    for effect in e.effects:
        if effect.elastic:
            raise InputError(
                f"{effect.effect.name} needs the mass matrix, which row-wise gains do not have",
                e.arm.where,
            )
    effort = vector("input", a.n, input_units(e), "inputs: motor currents, efforts where undriven")
    by_row = row_wise_dynamics(a, rows)

    def inputs(dq: Sequence[Expr], ddq: Sequence[Expr]) -> list[Expr]:
        return [dynamics.inverse_dynamics(dq, ddq)[k] for k, dynamics in enumerate(by_row)]

    dq, ddq, zeros = e.vector("dq"), e.vector("ddq"), e.zeros()
    text = "row-wise base parameters"
    return [
        a.function(
            "inverse_dynamics",
            f"Inputs that give the accelerations ddq in the state q, dq; {text}.",
            ["q", "dq", "ddq", "parameters"],
            [(effort, inputs(dq, ddq))],
        ),
        a.function(
            "gravity",
            f"Inputs that hold the arm at rest at q; {text}.",
            ["q", "parameters"],
            [(effort, inputs(zeros, zeros))],
        ),
        a.function(
            "bias",
            f"Inputs without acceleration; {text}.",
            ["q", "dq", "parameters"],
            [(effort, inputs(dq, zeros))],
        ),
    ]
