"""Functions without parameters: poses, Jacobian, motor coordinates, drive gains, ideal inputs."""

from __future__ import annotations

from modelgen.errors import InputError
from modelgen.functions.arguments import effort_units, input_units, joint_units, motor_units
from modelgen.functions.assembly import Assembly, vector
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.objects import Function, Output
from modelgen.graph import Expr
from modelgen.graph.from_sympy import from_sympy
from modelgen.model.effect_forces import EffectForces
from modelgen.model.kinematics import jacobian, link_poses, transform
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
    poses = link_poses(frames)
    results = [
        (Output(f"T_{joint.name}", 4, 4, "m", f"base <- link {joint.name}"), transform(pose))
        for joint, pose in zip(frames.arm.joints, poses, strict=True)
    ]
    text = "Homogeneous transforms from every link's frame to the base, link after link."
    return a.function("forward_kinematics", text, ["q"], results, drives=False, stacked=True)


def _jacobian(a: Assembly) -> Function:
    joints = a.real.arm.joints
    names = [joint.name for joint in joints]
    name = a.options.jacobian_link or names[-1]
    if name not in names:
        raise InputError(f"no link {name} for the Jacobian; links: {', '.join(names)}")
    rows = jacobian(a.real.frames, names.index(name))
    unit = "m, 1 over 1, 1/m" if any(j.type == "prismatic" for j in joints) else "m over 1"
    output = Output("jacobian", 6, a.n, unit, "linear over angular, base axes")
    text = f"Velocity of the origin of link {name} over its angular velocity, per joint velocity."
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
    unit = f"({effort_units(e.arm)}) per ({input_units(e)})"
    gains = Dynamics(e, []).gains()
    return a.function(
        "drive_gain", "Joint effort per input.", ["q"], [(vector("gain", a.n, unit, "drive gains K"), gains)]
    )


def _effective_input(a: Assembly) -> list[Function]:
    """Only where an effect stands between input and effort."""
    e = a.real
    if not any(part.place == "input" for effect in e.effects for part in effect.parts):
        return []
    given = e.vector("input")
    ideal = EffectForces(e, Rates(e.zeros(), e.zeros())).effective(given)
    output = vector("ideal", a.n, input_units(e), "inputs of ideal drives")
    text = "Inputs of ideal drives with the efforts that these ones give at `input`."
    return [a.function("effective_input", text, ["input"], [(output, ideal)], drives=False)]
