"""Hand-made functions for the tests of the backends: a planar arm with two links, and every operation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from modelgen.base_parameters import BaseParameter, Grouping
from modelgen.description.objects import Arm, Joint
from modelgen.functions.objects import (
    STATUS_PIVOT,
    STATUS_STROKE,
    Argument,
    Function,
    InputRange,
    Model,
    Output,
    SparsityTable,
)
from modelgen.graph import Expr, Graph, count_operations, lower
from modelgen.model.parameters import link_parameters

LENGTH = 0.443  # m, from the first axis to the second

Q = Argument("q", 2, "rad", "joint coordinates", 1e6)
DQ = Argument("dq", 2, "rad/s", "joint velocities", 1e6)
DDQ = Argument("ddq", 2, "rad/s^2", "joint accelerations", 1e6)
TORQUE = Argument("input", 2, "N m", "joint torques", 1e6)
# ZZ1R = ZZ1 + L^2 M2, ZZ2, MX1R = MX1 + L M2, MY1, MX2, MY2
PARAMETERS = Argument("parameters", 6, "", "base parameters", 1e6)


def function(
    name: str,
    arguments: Sequence[Argument],
    outputs: Sequence[Output],
    values: Mapping[str, Sequence[Expr]],
    *,
    guards: Sequence[tuple[Expr, int]] = (),
    ranges: tuple[InputRange, ...] = (),
    stacked: bool = False,
) -> Function:
    program = lower(values, guards)
    return Function(
        name=name,
        text=f"Hand-made {name.replace('_', ' ')}.",
        arguments=tuple(arguments),
        outputs=tuple(outputs),
        program=program,
        operations=count_operations(program),
        ranges=ranges,
        stacked=stacked,
    )


class Planar:
    """Two links in a vertical plane, gravity along -y; torques by hand from Lagrange's equations."""

    def __init__(self) -> None:
        g = self.graph = Graph()
        self.q, self.dq, self.ddq, self.tau = (
            [g.input(n, i) for i in range(2)] for n in ("q", "dq", "ddq", "input")
        )
        self.zz1, self.zz2, self.mx1, self.my1, self.mx2, self.my2 = (
            g.input("parameters", i) for i in range(6)
        )
        self.s1, self.c1 = g.call("sin", self.q[0]), g.call("cos", self.q[0])
        self.s2, self.c2 = g.call("sin", self.q[1]), g.call("cos", self.q[1])
        self.s12 = self.s1 * self.c2 + self.c1 * self.s2
        self.c12 = self.c1 * self.c2 - self.s1 * self.s2

    def mass(self) -> list[list[Expr]]:
        a = LENGTH * (self.mx2 * self.c2 - self.my2 * self.s2)
        return [[self.zz1 + self.zz2 + 2 * a, self.zz2 + a], [self.zz2 + a, self.zz2]]

    def gravity(self) -> list[Expr]:
        second = 9.81 * (self.mx2 * self.c12 - self.my2 * self.s12)
        return [9.81 * (self.mx1 * self.c1 - self.my1 * self.s1) + second, second]

    def bias(self) -> list[Expr]:
        h = LENGTH * (self.mx2 * self.s2 + self.my2 * self.c2)
        d1, d2 = self.dq
        g = self.gravity()
        return [g[0] - h * (d2 * d2 + 2 * d1 * d2), g[1] + h * d1 * d1]

    def inverse_dynamics(self) -> list[Expr]:
        m, b = self.mass(), self.bias()
        return [m[i][0] * self.ddq[0] + m[i][1] * self.ddq[1] + b[i] for i in range(2)]

    def regressor(self) -> list[Expr]:
        """2 x 6, row-major: derivative of the torques by the parameters."""
        zero = self.graph.zero
        d1, d2 = self.dq
        a1, a2 = self.ddq
        twice = d2 * d2 + 2 * d1 * d2
        s2, c2 = self.s2, self.c2
        first = [
            a1,
            a1 + a2,
            9.81 * self.c1,
            -9.81 * self.s1,
            LENGTH * (c2 * (2 * a1 + a2) - s2 * twice) + 9.81 * self.c12,
            -LENGTH * (s2 * (2 * a1 + a2) + c2 * twice) - 9.81 * self.s12,
        ]
        second = [
            zero,
            a1 + a2,
            zero,
            zero,
            LENGTH * (c2 * a1 + s2 * d1 * d1) + 9.81 * self.c12,
            LENGTH * (c2 * d1 * d1 - s2 * a1) - 9.81 * self.s12,
        ]
        return [*first, *second]


def planar_functions() -> tuple[Function, ...]:
    """Functions with every shape of output: vector, matrix with zeros, several, stacked, guarded."""
    arm = Planar()
    g = arm.graph
    effort = Output("input", 2, 1, "N m", "joint torques")
    stroke = (InputRange("q", 1, -2.5, 2.5, STATUS_STROKE),)

    m, b = arm.mass(), arm.bias()
    r = [arm.tau[i] - b[i] for i in range(2)]
    factor = m[0][1] / m[1][1]
    pivot = m[0][0] - factor * m[0][1]
    first = (r[0] - factor * r[1]) / pivot
    acceleration = [first, (r[1] - m[0][1] * first) / m[1][1]]

    half = 0.5 * (
        arm.dq[0] * (m[0][0] * arm.dq[0] + 2 * m[0][1] * arm.dq[1]) + m[1][1] * arm.dq[1] * arm.dq[1]
    )
    height = 9.81 * (arm.mx1 * arm.s1 + arm.my1 * arm.c1 + arm.mx2 * arm.s12 + arm.my2 * arm.c12)

    def pose(s: Expr, c: Expr, x: Expr, y: Expr) -> list[Expr]:
        o, i = g.zero, g.one
        return [c, -s, o, x, s, c, o, y, o, o, i, o, o, o, o, i]

    regressor = arm.regressor()
    return (
        function(
            "inverse_dynamics",
            (Q, DQ, DDQ, PARAMETERS),
            (effort,),
            {"input": arm.inverse_dynamics()},
            ranges=stroke,
        ),
        function("gravity", (Q, PARAMETERS), (effort,), {"input": arm.gravity()}),
        function(
            "regressor",
            (Q, DQ, DDQ),
            (Output("matrix", 2, 6, "", "regressor of the base parameters"),),
            {"matrix": regressor},
        ),
        function(
            "regressor_packed",
            (Q, DQ, DDQ),
            (Output("values", 9, 1, "", "structural non-zeros of the regressor"),),
            {"values": [e for e in regressor if not e.is_zero]},
        ),
        function(
            "mass_matrix",
            (Q, PARAMETERS),
            (Output("matrix", 2, 2, "kg m^2", "mass matrix"),),
            {"matrix": [*m[0], *m[1]]},
        ),
        function(
            "forward_dynamics",
            (Q, DQ, TORQUE, PARAMETERS),
            (Output("ddq", 2, 1, "rad/s^2", "joint accelerations"),),
            {"ddq": acceleration},
            guards=[(m[1][1], STATUS_PIVOT), (pivot, STATUS_PIVOT)],
        ),
        function(
            "energy",
            (Q, DQ, PARAMETERS),
            (
                Output("kinetic", 1, 1, "J", "kinetic energy"),
                Output("potential", 1, 1, "J", "potential energy"),
            ),
            {"kinetic": [half], "potential": [height]},
        ),
        function(
            "forward_kinematics",
            (Q,),
            (Output("T1", 4, 4, "", "base from link 1"), Output("T2", 4, 4, "", "base from link 2")),
            {
                "T1": pose(arm.s1, arm.c1, g.zero, g.zero),
                "T2": pose(arm.s12, arm.c12, LENGTH * arm.c1, LENGTH * arm.s1),
            },
            stacked=True,
        ),
    )


UNARY = ("sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "log", "tanh", "abs", "sign")


def calls_function() -> Function:
    """Every function of the graph, at x in (-1, 1) and y in (0, 1)."""
    g = Graph()
    x, y = g.input("x", 0), g.input("x", 1)
    positive = {"sqrt", "log"}
    values = [g.call(name, y if name in positive else x) for name in UNARY]
    values += [
        g.call("atan2", x, y),
        g.call("pow", y, x),
        g.call("min", x, y),
        g.call("max", x, y),
        g.call("select", x, y, x * y),
        g.call("select", -x, y + 1.0, -(x * y)),
        g.call("sign", x - x * y * 0.0),
    ]
    return function(
        "calls",
        (Argument("x", 2, "", "two numbers", 1e3),),
        (Output("values", len(values), 1, "", "results"),),
        {"values": values},
    )


def planar_model(name: str = "planar", extra: Sequence[Function] = ()) -> Model:
    arm = Arm(
        name=name,
        joints=(Joint("shoulder", "revolute"), Joint("elbow", "revolute", d=LENGTH, antecedent=0)),
        links=(None, None),
        gravity=(0.0, -9.81, 0.0),
        source="made up */ for the tests",
    )
    standard = [p for i in range(2) for p in link_parameters(i, arm.joints[i].name, fluid=False)]
    index = {p.name: i for i, p in enumerate(standard)}
    base = (
        BaseParameter("ZZ1R", "kg m^2", ((index["ZZ1"], 1.0), (index["M2"], LENGTH**2)), "ZZ1 + 0.196249 M2"),
        BaseParameter("ZZ2", "kg m^2", ((index["ZZ2"], 1.0),), "ZZ2"),
        BaseParameter("MX1R", "kg m", ((index["MX1"], 1.0), (index["M2"], LENGTH)), "MX1 + 0.443 M2"),
        BaseParameter("MY1", "kg m", ((index["MY1"], 1.0),), "MY1"),
        BaseParameter("MX2", "kg m", ((index["MX2"], 1.0),), "MX2"),
        BaseParameter("MY2", "kg m", ((index["MY2"], 1.0),), "MY2"),
    )
    used = {i for p in base for i, _ in p.terms}
    return Model(
        arm=arm,
        standard=tuple(standard),
        grouping=Grouping(base, tuple(i for i in range(len(standard)) if i not in used)),
        functions=(*planar_functions(), *extra),
        packed=SparsityTable((0, 0, 0, 0, 0, 0, 1, 1, 1), (0, 1, 2, 3, 4, 5, 1, 4, 5)),
    )
