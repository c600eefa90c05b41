"""Functions without parameters: poses, Jacobian, motor coordinates, drive gains, ideal inputs."""

from __future__ import annotations

from modelgen.errors import InputError
from modelgen.functions.arguments import effort_units, input_units, joint_units, motor_units, per
from modelgen.functions.assembly import Assembly, vector
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.objects import Function, Output
from modelgen.graph import Expr
from modelgen.graph.from_sympy import from_sympy
from modelgen.model.effect_forces import EffectForces
from modelgen.model.kinematics import jacobian, link_poses, tool_poses, transform
from modelgen.model.motion import Rates


def kinematic_functions(a: Assembly) -> list[Function]:
    """Everything that needs neither parameters nor a regressor."""
    return [
        _forward_kinematics(a),
        _jacobian(a),
        _motor_from_joint(a),
        _joint_from_motor(a),
        _drive_gain(a),
        *_effective_input(a),
    ]


def _forward_kinematics(a: Assembly) -> Function:
    frames = a.real.frames
    arm = frames.arm
    ground = "base" if arm.base is None else "world"
    named = [
        *((joint.name, f"link {joint.name}") for joint in arm.joints),
        *((tool.name, f"tool {tool.name}, on link {arm.joints[tool.link].name}") for tool in arm.tools),
    ]
    poses = [*link_poses(frames), *tool_poses(frames)]
    results = [
        (Output(f"T_{name}", 4, 4, "m", f"{ground} <- {what}"), transform(pose))
        for (name, what), pose in zip(named, poses, strict=True)
    ]
    text = f"Homogeneous transforms from every link's frame to the {ground}, link after link"
    text += ", then tool after tool." if arm.tools else "."
    return a.function("forward_kinematics", text, ["q"], results, drives=False, stacked=True)


def _jacobian(a: Assembly) -> Function:
    arm, frames = a.real.arm, a.real.frames
    joints = arm.joints
    names = [joint.name for joint in joints]
    tools = [tool.name for tool in arm.tools]
    name = a.options.jacobian_link or names[-1]
    if name not in names and name not in tools:
        listed = ", ".join(names) + (f"; tools: {', '.join(tools)}" if tools else "")
        raise InputError(f"no link {name} for the Jacobian; links: {listed}")
    if name in tools:
        k = tools.index(name)
        rows, what = jacobian(frames, arm.tools[k].link, tool_poses(frames)[k][1]), f"tool {name}"
    else:
        rows, what = jacobian(frames, names.index(name)), f"link {name}"
    axes = "base" if arm.base is None else "world"
    sliding = any(j.type == "prismatic" for j in joints)
    unit = "m and rad per rad or m" if sliding else "m and rad per rad"
    output = Output("jacobian", 6, a.n, unit, f"linear over angular, {axes} axes")
    text = f"Velocity of the origin of {what} over its angular velocity, per joint velocity."
    return a.function("jacobian", text, ["q"], [(output, [x for row in rows for x in row])], drives=False)


def _motor_from_joint(a: Assembly) -> Function:
    e = a.real
    rates = Rates(e.vector("dq"), e.vector("ddq"))
    speeds = [e.motor_rates(n, rates) for n in range(a.n)]
    results = [
        (vector("q_m", a.n, motor_units(e), "motor coordinates"), [d.motor for d in e.drives]),
        (vector("dq_m", a.n, motor_units(e, "/s"), "motor velocities"), [s[0] for s in speeds]),
        (vector("ddq_m", a.n, motor_units(e, "/s^2"), "motor accelerations"), [s[1] for s in speeds]),
    ]
    return a.function(
        "motor_from_joint", "Motor coordinates from joint coordinates.", ["q", "dq", "ddq"], results
    )


def _joint_from_motor(a: Assembly) -> Function:
    e = a.real
    graph = e.graph
    joint: list[list[Expr]] = [[], [], []]
    for n, drive in enumerate(e.drives):
        t = drive.transmission
        symbols = {**e.scalars.symbols, t.q_m: graph.input("q_m", n)}
        inverse = t.joint()
        value, slope, bend = (from_sympy(graph, x, symbols) for x in (inverse, *t.inverse_rates()))
        speed, acceleration = graph.input("dq_m", n), graph.input("ddq_m", n)
        joint[0].append(value)
        joint[1].append(slope * speed)
        joint[2].append(slope * acceleration + bend * (speed * speed))
    results = [
        (vector("q", a.n, joint_units(e.arm), "joint coordinates"), joint[0]),
        (vector("dq", a.n, joint_units(e.arm, "/s"), "joint velocities"), joint[1]),
        (vector("ddq", a.n, joint_units(e.arm, "/s^2"), "joint accelerations"), joint[2]),
    ]
    inputs = ["q_m", "dq_m", "ddq_m"]
    return a.function("joint_from_motor", "Joint coordinates from motor coordinates.", inputs, results)


def _drive_gain(a: Assembly) -> Function:
    e = a.real
    unit = per(effort_units(e.arm), input_units(e))
    gains = Dynamics(e, []).gains()
    return a.function(
        "drive_gain", "Joint effort per input.", ["q"], [(vector("gain", a.n, unit, "drive gains K"), gains)]
    )


def _effective_input(a: Assembly) -> list[Function]:
    """Only where an effect stands between input and effort."""
    e = a.real
    if e.ideal_inputs:
        return []
    given = e.vector("input")
    ideal = EffectForces(e, Rates(e.zeros(), e.zeros())).effective(given)
    output = vector("ideal", a.n, input_units(e), "inputs of ideal drives")
    text = "Inputs of ideal drives with the efforts that these ones give at `input`."
    return [a.function("effective_input", text, ["input"], [(output, ideal)], drives=False)]
