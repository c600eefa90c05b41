"""Kane's equations by sympy.physics.mechanics, common subexpressions, C.

python -m peers.sympy_kane ARM OUT.c
"""

from __future__ import annotations

import sys
from pathlib import Path

import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from peers.arms import Subject, subject
from peers.cost import generation


def equations(case: Subject) -> tuple[sp.Matrix, sp.Matrix, list[sp.Symbol], list[sp.Symbol]]:
    """Mass matrix and the right-hand side without efforts, M(q) ddq = f(q, dq) + effort; symbols q, dq.

    Raises ValueError for an arm with prismatic joints.
    """
    count = case.joints
    angles, speeds = dynamicsymbols(f"q:{count}"), dynamicsymbols(f"u:{count}")
    base = ReferenceFrame("base")
    ground = Point("base")
    ground.set_vel(base, 0)
    made: list[tuple[ReferenceFrame, Point]] = []
    bodies, loads = [], []
    for i, body in enumerate(case.bodies):
        if body.prismatic:
            raise ValueError(f"{case.arm.name}: revolute joints only")
        frame, point = (base, ground) if body.parent is None else made[body.parent]
        place = body.place
        turn = sp.Matrix(3, 3, [_exact(x) for x in place[:3, :3].ravel()])
        turned = ReferenceFrame(f"link{i}")
        c, s = sp.cos(angles[i]), sp.sin(angles[i])
        turned.orient_explicit(frame, turn * sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
        turned.set_ang_vel(frame, speeds[i] * turned.z)
        axes = (frame.x, frame.y, frame.z)
        origin = point.locatenew(
            f"origin{i}", sum((_exact(x) * a for x, a in zip(place[:3, 3], axes, strict=True)), 0 * frame.x)
        )
        origin.v2pt_theory(point, base, frame)
        axes = (turned.x, turned.y, turned.z)
        centre = origin.locatenew(
            f"centre{i}", sum((x * a for x, a in zip(body.com, axes, strict=True)), 0 * turned.x)
        )
        centre.v2pt_theory(origin, base, turned)
        xx, xy, xz, yy, yz, zz = body.inertia
        tensor = inertia(turned, xx, yy, zz, xy, yz, xz)
        bodies.append(RigidBody(f"body{i}", centre, turned, body.mass, (tensor, centre)))
        weight = [body.mass * g for g in case.arm.gravity]
        loads.append((centre, weight[0] * base.x + weight[1] * base.y + weight[2] * base.z))
        made.append((turned, origin))
    rates = [angle.diff() - speed for angle, speed in zip(angles, speeds, strict=True)]
    kane = KanesMethod(base, angles, speeds, rates)
    kane.kanes_equations(bodies, loads)
    plain_q = list(sp.symbols(f"q0:{count}"))
    plain_u = list(sp.symbols(f"u0:{count}"))
    plain = dict(zip([*angles, *speeds], [*plain_q, *plain_u], strict=True))
    return kane.mass_matrix.subs(plain), kane.forcing.subs(plain), plain_q, plain_u


def _exact(x: float) -> sp.Expr:
    """0 and +-1 as integers, so that they vanish."""
    return sp.Integer(round(x)) if abs(x - round(x)) < 1e-12 else sp.Float(x)


def c_function(name: str, results: list[sp.Expr], inputs: dict[str, list[sp.Symbol]]) -> str:
    """C text of one function with common subexpressions taken out."""
    shared, left = sp.cse(results)
    text = [f"void {name}(const double *q, const double *dq, const double *third, double *out)", "{"]
    for array, symbols in inputs.items():
        text += [f"    const double {s} = {array}[{i}];" for i, s in enumerate(symbols)]
        text += [f"    (void){s};" for s in symbols]
    text += [f"    const double {sp.ccode(s)} = {sp.ccode(e)};" for s, e in shared]
    text += [f"    out[{i}] = {sp.ccode(e)};" for i, e in enumerate(left)]
    return "\n".join([*text, "}", ""])


def main(name: str, out: Path) -> None:
    """Write inverse dynamics and mass matrix of an arm as C."""
    mass, forcing, q, dq = equations(subject(name))
    third = list(sp.symbols(f"a0:{len(q)}"))
    inputs = {"q": q, "dq": dq, "third": third}
    effort = list(mass * sp.Matrix(third) - forcing)
    text = "#include <math.h>\n\n" + c_function("kane_inverse_dynamics", effort, inputs)
    out.write_text(text + c_function("kane_mass_matrix", list(mass), inputs), encoding="utf-8")


if __name__ == "__main__":
    generation(lambda: main(sys.argv[1], Path(sys.argv[2])))
