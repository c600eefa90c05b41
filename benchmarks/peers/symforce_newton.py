"""Newton and Euler's recursion on SymForce's symbols, its elimination of common subexpressions, its C++.

SymForce has no dynamics of its own: these are the recursions that a user of it would write (Luh, Walker and
Paul 1980; Walker and Orin 1982), parameters folded in, results laid out as the others'.

    python -m peers.symforce_newton ARM FOLDER
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import symforce

symforce.set_epsilon_to_number()

import symforce.symbolic as sf  # noqa: E402 - the epsilon must be set before
from symforce import codegen  # noqa: E402
from symforce.values import Values  # noqa: E402

from peers.arms import Subject, subject  # noqa: E402
from peers.bodies import Body  # noqa: E402
from peers.cost import generation  # noqa: E402


@dataclass
class Moving:
    """A body's frame in its parent's: x_parent = turn x + origin; axis z."""

    body: Body
    turn: Any
    origin: Any

    @property
    def inertials(self) -> tuple[Any, Any, Any]:
        """Mass, first moment, tensor about the frame's origin."""
        return _exact(self.body.mass), _matrix(self.body.first), _matrix(self.body.tensor)


def _exact(x: float) -> Any:
    """0 and +-1 as integers, so that they vanish."""
    return sf.Integer(round(x)) if x in (0.0, 1.0, -1.0) else sf.Float(float(x))


def _matrix(array: Any) -> Any:
    rows = np.atleast_2d(np.asarray(array, float).T).T
    return sf.Matrix([[_exact(x) for x in row] for row in rows.tolist()])


def _skew(v: Any) -> Any:
    return sf.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _cross(a: Any, b: Any) -> Any:
    return _skew(a) * b


def frames(case: Subject, q: Any) -> list[Moving]:
    """The bodies' frames for the coordinates q."""
    found = []
    for k, body in enumerate(case.bodies):
        turn, origin = _matrix(body.place[:3, :3]), _matrix(body.place[:3, 3])
        if body.prismatic:
            origin = origin + turn[:, 2] * q[k]
        else:
            c, s = sf.cos(q[k]), sf.sin(q[k])
            turn = turn * sf.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        found.append(Moving(body, turn, origin))
    return found


def motions(case: Subject, chain: Sequence[Moving], dq: Any, ddq: Any) -> list[tuple[Any, Any, Any]]:
    """Angular velocity, angular acceleration, acceleration less gravity of the frames' origins."""
    z = sf.Matrix([0, 0, 1])
    found: list[tuple[Any, Any, Any]] = []
    rest = (_matrix([0, 0, 0]), _matrix([0, 0, 0]), _matrix([-g for g in case.arm.gravity]))
    for k, moving in enumerate(chain):
        body, p = moving.body, moving.origin
        w, dw, a = rest if body.parent is None else found[body.parent]
        a = moving.turn.T * (a + _cross(dw, p) + _cross(w, _cross(w, p)))
        w, dw = moving.turn.T * w, moving.turn.T * dw
        if body.prismatic:
            a = a + z * ddq[k] + 2 * _cross(w, z * dq[k])
        else:
            dw = dw + z * ddq[k] + _cross(w, z * dq[k])
            w = w + z * dq[k]
        found.append((w, dw, a))
    return found


def efforts(
    chain: Sequence[Moving], moving: Sequence[tuple[Any, Any, Any]], inertials: Sequence[Any]
) -> list[Any]:
    """Joint efforts for the inertials (None: a body without mass)."""
    zero = _matrix([0, 0, 0])
    forces, moments = [zero] * len(chain), [zero] * len(chain)
    for k, ((w, dw, a), given) in enumerate(zip(moving, inertials, strict=True)):
        if given is None:
            continue
        m, h, t = given
        forces[k] = a * m + _cross(dw, h) + _cross(w, _cross(w, h))
        moments[k] = t * dw + _cross(w, t * w) + _cross(h, a)
    result = [sf.Integer(0)] * len(chain)
    for k in reversed(range(len(chain))):
        one = chain[k]
        result[k] = forces[k][2] if one.body.prismatic else moments[k][2]
        if one.body.parent is not None:
            f = one.turn * forces[k]
            forces[one.body.parent] += f
            moments[one.body.parent] += one.turn * moments[k] + _cross(one.origin, f)
    return result


def mass_matrix(chain: Sequence[Moving]) -> Any:
    """By composite bodies."""
    n = len(chain)
    result = sf.Matrix.zeros(n, n)
    made = [one.inertials for one in chain]
    for k in reversed(range(n)):
        one, (m, h, t) = chain[k], made[k]
        force = sf.Matrix([0, 0, m]) if one.body.prismatic else sf.Matrix([-h[1], h[0], 0])
        moment = sf.Matrix([h[1], -h[0], 0]) if one.body.prismatic else t[:, 2]
        j: int | None = k
        while j is not None:
            here = chain[j]
            result[k, j] = result[j, k] = force[2] if here.body.prismatic else moment[2]
            force, moment = here.turn * force, here.turn * moment
            moment = moment + _cross(here.origin, force)
            j = here.body.parent
        if one.body.parent is not None:
            turned, p = one.turn * h, _skew(one.origin)
            s = _skew(turned)
            tensor = one.turn * t * one.turn.T - (p * s + s * p) - p * p * m
            mass, first, other = made[one.body.parent]
            made[one.body.parent] = (mass + m, first + turned + one.origin * m, other + tensor)
    return result


def solved(matrix: Any, right: Sequence[Any]) -> list[Any]:
    """Solution for a symmetric matrix, L D L' unrolled."""
    n = len(right)
    low = [[matrix[i, j] for j in range(i + 1)] for i in range(n)]
    x = list(right)
    for k in reversed(range(n)):
        for i in range(k):
            factor = low[k][i] / low[k][k]
            for j in range(i + 1):
                low[i][j] = low[i][j] - factor * low[k][j]
            x[i] = x[i] - factor * x[k]
        x[k] = x[k] / low[k][k]
    for k in range(n):
        for i in range(k):
            x[k] = x[k] - low[k][i] / low[k][k] * x[i]
    return x


def regressor(chain: Sequence[Moving], moving: Sequence[tuple[Any, Any, Any]]) -> Any:
    """n x 10 n, parameters in Pinocchio's order: a column is the efforts for one parameter of 1."""
    n = len(chain)
    result = sf.Matrix.zeros(n, 10 * n)
    for k in range(n):
        for column, (m, h, t) in enumerate(_units()):
            given: list[Any] = [None] * n
            given[k] = (m, _matrix(h), _matrix(t))
            for row, effort in enumerate(efforts(chain, moving, given)):
                result[row, 10 * k + column] = effort
    return result


def _units() -> list[tuple[int, list[float], list[list[float]]]]:
    """m; mx, my, mz; xx, xy, yy, xz, yz, zz, each 1 and the rest 0."""
    nothing = np.zeros((3, 3)).tolist()
    units = [(1, [0.0, 0.0, 0.0], nothing)]
    units += [(0, row, nothing) for row in np.eye(3).tolist()]
    for j, k in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)):
        tensor = np.zeros((3, 3))
        tensor[j, k] = tensor[k, j] = 1.0
        units.append((0, [0.0, 0.0, 0.0], tensor.tolist()))
    return units


def write(case: Subject, folder: Path) -> None:
    """C++ of the four functions, one header each."""
    n = case.joints
    q, dq, third = (sf.Matrix(n, 1).symbolic(name) for name in ("q", "dq", "third"))
    chain = frames(case, q)
    zero = sf.Matrix.zeros(n, 1)
    inertials = [one.inertials for one in chain]
    moving = motions(case, chain, dq, third)
    mass = mass_matrix(chain)
    bias = efforts(chain, motions(case, chain, dq, zero), inertials)
    right = [effort - part for effort, part in zip(third, bias, strict=True)]
    results = {
        "inverse_dynamics": (("q", "dq", "third"), sf.Matrix(efforts(chain, moving, inertials))),
        "mass_matrix": (("q",), mass),
        "forward_dynamics": (("q", "dq", "third"), sf.Matrix(solved(mass, right))),
        "regressor": (("q", "dq", "third"), regressor(chain, moving)),
    }
    given = {"q": q, "dq": dq, "third": third}
    for name, (inputs, result) in results.items():
        made = codegen.Codegen(
            inputs=Values(**{key: given[key] for key in inputs}),
            outputs=Values(out=result),
            config=codegen.CppConfig(),
            name=name,
        )
        made.generate_function(output_dir=folder, skip_directory_nesting=True)


if __name__ == "__main__":
    generation(lambda: write(subject(sys.argv[1]), Path(sys.argv[2])))
