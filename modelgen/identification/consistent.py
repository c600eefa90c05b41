"""Physically consistent parameters: links that could exist, as close to the data and to a prior as can be.

The pseudo-inertia of every link is U U' with U upper triangular and positive on its diagonal, in logarithms
(Rucker and Wensing 2022, log-Cholesky), so that mass is positive, the inertia about the centre of mass
positive definite and its principal moments satisfy the triangle inequality (Traversaro et al. 2016).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from modelgen.effects import applied_effects
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.functions.nominal import about_origin, base_matrix
from modelgen.numeric import Array

TEN = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
PRIOR = 1e-3  # weight of the prior beside the data's chi square, per link
_BALL = (1.0, 0.1)  # kg, m: a link of which the description says nothing


@dataclass(frozen=True)
class Consistent:
    """Standard parameters (s,) that could exist, and the base parameters (p,) that they give.

    distance: chi square per parameter by which the data would rather have others. violated: links to which
    the plain solution closest to the prior gives a negative mass or an impossible inertia, in words.
    """

    standard: Array
    base: Array
    distance: float
    violated: tuple[str, ...]


def consistent(model: Model, theta: Array, precision: Array) -> Consistent:
    """The consistent standard parameters closest to theta (p,) in the metric `precision` (p, p).

    Minimises (K x - theta)' precision (K x - theta) / 2 plus PRIOR times the entropic divergence of each link
    from the description's (Lee, Wensing and Park 2020), K x the base parameters of the standard vector x;
    parameters of effects keep within their bounds. Raises InputError for an arm in a fluid, and where IPOPT
    fails.
    """
    arm = model.arm
    if arm.fluid_density:
        raise InputError(f"{arm.name}: --consistent knows no buoyancy; expected fluid_density 0")
    grouping = base_matrix(model)
    priors = [prior_inertia(model, i) for i in range(len(arm.links))]
    links, others = len(priors), len(model.standard) - 10 * len(priors)
    logs, rest = ca.SX.sym("logs", 10, links), ca.SX.sym("rest", others)
    pseudo = [_log_cholesky(logs[:, i]) for i in range(links)]
    standard = ca.vertcat(*(_ten(j) for j in pseudo), rest)
    error = ca.DM(_root(precision)) @ (ca.DM(grouping) @ standard - ca.DM(theta))
    cost = ca.sumsqr(error) / 2
    for i, (j, prior) in enumerate(zip(pseudo, priors, strict=True)):
        # log det of U U' is twice the sum of the logarithms on its diagonal.
        cost += PRIOR * (ca.trace(ca.DM(np.linalg.inv(prior)) @ j) - 2 * ca.sum1(logs[:4, i]))
    low, high, begin = _effects(model, theta)
    x = ca.vertcat(ca.reshape(logs, 10 * links, 1), rest)
    start = np.concatenate([*(_logs(p) for p in priors), begin])
    wide = np.full(10 * links, np.inf)
    options: dict[str, Any] = {
        "print_time": False,
        "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 1000, "tol": 1e-9},
    }
    solver = ca.nlpsol("consistent", "ipopt", {"x": x, "f": cost}, options)
    found = solver(x0=start, lbx=np.concatenate([-wide, low]), ubx=np.concatenate([wide, high]))
    if not solver.stats()["success"]:
        raise InputError(
            f"{arm.name}: no physically consistent parameters found ({solver.stats()['return_status']})"
        )
    value = ca.Function("standard", [x], [standard])(found["x"])
    values = np.asarray(value, dtype=float).ravel()
    base = grouping @ values
    left = base - theta
    return Consistent(
        values,
        base,
        float(left @ precision @ left) / len(theta),
        violations(model, plain(model, theta)),
    )


def plain(model: Model, theta: Array) -> Array:
    """Standard parameters (s,) that give theta exactly, closest to the prior in the least squares sense."""
    grouping = base_matrix(model)
    prior = np.concatenate([*(_values(prior_inertia(model, i)) for i in range(len(model.arm.links)))])
    start = np.concatenate([prior, np.zeros(len(model.standard) - len(prior))])
    change, *_ = np.linalg.lstsq(grouping, theta - grouping @ start, rcond=None)
    return np.asarray(start + change)


def violations(model: Model, standard: Array) -> tuple[str, ...]:
    """Links whose mass is negative or whose pseudo-inertia is not positive definite, in words."""
    found = []
    for i, joint in enumerate(model.arm.joints):
        ten = standard[10 * i : 10 * i + 10]
        if ten[9] <= 0:
            found.append(f"{joint.name}: mass {ten[9]:.3g} kg")
        elif np.linalg.eigvalsh(pseudo_inertia(ten))[0] <= 0:
            found.append(f"{joint.name}: impossible inertia")
    return tuple(found)


def _effects(model: Model, theta: Array) -> tuple[Array, Array, Array]:
    """Bounds and first values of the effects' standard parameters, in their order."""
    bounds = [p.bounds for e in applied_effects(model.arm) for p, _ in e.parameters]
    low, high = (np.array([b[k] for b in bounds], dtype=float) for k in (0, 1))
    begin = plain(model, theta)[10 * len(model.arm.links) :]
    return low, high, np.clip(begin, low, high)


def prior_inertia(model: Model, link: int) -> Array:
    """Pseudo-inertia of the described link, else of a ball."""
    nominal = model.arm.links[link]
    if nominal is not None:
        values = about_origin(nominal)
        found = pseudo_inertia(np.array([values[name] for name in TEN]))
        least = 1e-6 * np.trace(found)
        # A point or a rod has no volume: a millionth of its size keeps logarithms finite.
        return found + least * np.eye(4) if np.linalg.eigvalsh(found)[0] < least else found
    mass, radius = _BALL
    return np.diag([mass * radius**2 / 5] * 3 + [mass])


def pseudo_inertia(ten: Sequence[float] | Array) -> Array:
    """4 x 4: second moments of the mass, first moments, mass (Wensing, Kim and Slotine 2018)."""
    xx, xy, xz, yy, yz, zz, mx, my, mz, m = (float(v) for v in ten)
    half = (xx + yy + zz) / 2
    return np.array(
        [
            [half - xx, -xy, -xz, mx],
            [-xy, half - yy, -yz, my],
            [-xz, -yz, half - zz, mz],
            [mx, my, mz, m],
        ]
    )


def _values(pseudo: Array) -> Array:
    """The ten parameters of a pseudo-inertia."""
    return np.asarray(ca.DM(_ten(ca.DM(pseudo)))).ravel()


def _ten(j: Any) -> Any:
    xx, yy, zz = j[1, 1] + j[2, 2], j[0, 0] + j[2, 2], j[0, 0] + j[1, 1]
    return ca.vertcat(xx, -j[0, 1], -j[0, 2], yy, -j[1, 2], zz, j[0, 3], j[1, 3], j[2, 3], j[3, 3])


def _log_cholesky(v: ca.SX) -> ca.SX:
    """U U' with the logarithms v[0:4] on U's diagonal and v[4:10] above it, row by row."""
    u = ca.SX.zeros(4, 4)
    places = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    for k in range(4):
        u[k, k] = ca.exp(v[k])
    for k, (row, column) in enumerate(places):
        u[row, column] = v[4 + k]
    return u @ u.T


def _logs(pseudo: Array) -> Array:
    """v of `_log_cholesky` for a pseudo-inertia."""
    flipped = np.linalg.cholesky(pseudo[::-1, ::-1])[::-1, ::-1]  # upper triangular
    places = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    return np.concatenate([np.log(np.diag(flipped)), [flipped[p] for p in places]])


def _root(precision: Array) -> Array:
    """R (p, p) with R' R = precision."""
    values, vectors = np.linalg.eigh((precision + precision.T) / 2)
    return np.asarray(np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T)
