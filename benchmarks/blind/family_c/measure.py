"""How large a hidden effect is: a small least squares of the user's model, by Atkeson's regressor."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfiltfilt

from blind.case import Array
from blind.family_c.arms import World
from blind.family_c.plan import Plan
from blind.family_c.plant import frame
from blind.family_c.records import Record

FITTED = 125  # Hz, about: rate at which columns are evaluated
WIDER = 4.0  # band of the positions, by that of the equations
CRAWLS = 0.02  # share of its highest speed below which a joint's friction is not known
REST = 0.01  # most of a row's weight that may come from there where it lasts
LASTS = 0.15  # s
EDGE = 1.0  # of 1 / band, cut off at the ends


def band(plan: Plan) -> float:
    """Cut-off of the equations [Hz]."""
    return min(8.0, plan.rate / 12.5)


def regressor(world: World, q: Array, v: Array, a: Array) -> Array:
    """Joint efforts (N, n, 10 n) by each link's mass, first moments and moments of inertia about its origin.

    q, v, a: (N, n). Atkeson, An and Hollerbach 1986, (16) to (24), in the base's frame.
    """
    rows, n = q.shape
    turn = np.tile(np.eye(3), (rows, 1, 1))
    p, spin, turning = np.zeros((3, rows, 3))
    pull = np.tile(-np.array(world.gravity), (rows, 1))
    axes, places = np.empty((2, n, rows, 3))
    out = np.zeros((rows, n, 10 * n))
    for k, link in enumerate(world.links):
        offset, rotated = frame(link)
        arm = turn @ offset
        turn = turn @ rotated
        z = turn[:, :, 2]
        if link.slides:
            arm = arm + z * q[:, k : k + 1]
        pull = pull + np.cross(turning, arm) + np.cross(spin, np.cross(spin, arm))
        p = p + arm
        if link.slides:
            rate = v[:, k : k + 1] * z
            pull = pull + a[:, k : k + 1] * z + 2 * np.cross(spin, rate)
        else:
            rate = v[:, k : k + 1] * z
            turning = turning + a[:, k : k + 1] * z + np.cross(spin, rate)
            spin = spin + rate
            turn = turn @ _about_z(q[:, k])
        axes[k], places[k] = z, p
        force, moment = _wrench(turn, spin, turning, pull)
        for j in range(k + 1):
            if world.links[j].slides:
                own = np.einsum("ri,ric->rc", axes[j], force)
            else:
                lever = np.cross(axes[j], p - places[j])
                own = np.einsum("ri,ric->rc", axes[j], moment) + np.einsum("ri,ric->rc", lever, force)
            out[:, j, 10 * k : 10 * (k + 1)] = own
    return out


def _about_z(angle: Array) -> Array:
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros(len(angle))
    return np.stack([c, -s, zero, s, c, zero, zero, zero, zero + 1], axis=1).reshape(-1, 3, 3)


def _wrench(turn: Array, spin: Array, turning: Array, pull: Array) -> tuple[Array, Array]:
    """Force and moment (N, 3, 10) at a link's origin, in the base's frame, by its ten parameters."""
    rows = len(turn)
    force, moment = np.zeros((2, rows, 3, 10))
    w, dw = _cross(spin), _cross(turning)
    force[:, :, 0] = pull
    force[:, :, 1:4] = (dw + w @ w) @ turn
    moment[:, :, 1:4] = -_cross(pull) @ turn
    local, d_local = np.einsum("rij,ri->rj", turn, spin), np.einsum("rij,ri->rj", turn, turning)
    moment[:, :, 4:] = turn @ (_tensor(d_local) + _cross(local) @ _tensor(local))
    return force, moment


def _cross(x: Array) -> Array:
    zero = np.zeros(len(x))
    entries = [zero, -x[:, 2], x[:, 1], x[:, 2], zero, -x[:, 0], -x[:, 1], x[:, 0], zero]
    return np.stack(entries, axis=1).reshape(-1, 3, 3)


def _tensor(x: Array) -> Array:
    """Matrices (N, 3, 6) that give I x from xx, xy, xz, yy, yz, zz."""
    zero, (a, b, c) = np.zeros(len(x)), x.T
    rows = [[a, b, c, zero, zero, zero], [zero, a, zero, b, c, zero], [zero, zero, a, zero, b, c]]
    return np.stack([np.stack(row, axis=1) for row in rows], axis=1)


def errors(world: World, plan: Plan, records: list[Record]) -> Array:
    """RMSE (n) of the currents of one fit to all records, below `band`.

    world: as the user believes it to be; its links and the laws that it knows are fitted.
    """
    parts = [_equations(world, plan, r) for r in records]
    sides = [[np.concatenate([p[j][side] for p in parts]) for side in (0, 1)] for j in range(world.count)]
    weight = [1 / float(np.std(y)) for _, y in sides]
    left = np.zeros(world.count)
    for _ in range(2):
        phi = np.concatenate([x * w for (x, _), w in zip(sides, weight, strict=True)])
        goal = np.concatenate([y * w for (_, y), w in zip(sides, weight, strict=True)])
        norm = np.linalg.norm(phi, axis=0)
        norm[norm == 0] = 1
        theta = np.linalg.lstsq(phi / norm, goal, rcond=1e-8)[0] / norm
        left = np.array([np.sqrt(np.mean((y - x @ theta) ** 2)) for x, y in sides])
        weight = [1 / float(e) for e in left]
    return left


def _equations(world: World, plan: Plan, taken: Record) -> list[tuple[Array, Array]]:
    """For each joint columns (M, c) and currents (M), filtered and decimated, of rows in which it moves."""
    rate, cut = plan.rate, band(plan)
    every = max(1, rate // FITTED)
    q = _low(taken.q, rate, WIDER * cut)
    v, a = _rates(q, rate)
    at = plan.shift  # the motion where the currents are
    jerk, snap = _rates(a, rate)
    q = q + at * v + 0.5 * at**2 * a
    v, a = v + at * a + 0.5 * at**2 * jerk, a + at * jerk + 0.5 * at**2 * snap
    current = _low(taken.i, rate, WIDER * cut)[::every]
    q, v, a = q[::every], v[::every], a[::every]
    shared = regressor(world, q, v, a)
    slow, edge = rate / every, int(EDGE / cut * rate / every)
    rows = slice(edge, len(q) - edge, max(1, int(slow / (2.5 * cut))))
    known = [(j, law) for j in range(world.count) for law in world.effects[j]]
    out = []
    for j in range(world.count):
        gear = world.gear(j, q[:, j])
        turned = gear * v[:, j]
        columns = np.zeros((len(q), shared.shape[2] + len(known)))
        columns[:, : shared.shape[2]] = shared[:, j] / (gear * world.numbers[j]["kt"])[:, None]
        for c, (joint, law) in enumerate(known, start=shared.shape[2]):
            if joint == j:
                columns[:, c] = {
                    "viscous_friction": turned,
                    "coulomb_friction": np.sign(turned),
                    "drive_inertia": _rates(turned[:, None], slow)[0][:, 0],
                }[law]
        crawls = np.abs(v[:, j]) < CRAWLS * np.abs(v[:, j]).max()
        both = _low(np.column_stack([columns, current[:, j]]) * ~crawls[:, None], slow, cut)
        rests = _low(_lasting(crawls, LASTS * slow).astype(float)[:, None], slow, cut)[rows, 0]
        keep = np.abs(rests) < REST
        out.append((both[rows, :-1][keep], both[rows, -1][keep]))
    return out


def _low(x: Array, rate: float, cut: float) -> Array:
    """Low-pass of zero phase along the first axis."""
    if cut >= 0.45 * rate:
        return x
    reach = min(len(x) - 1, int(2 * rate / cut))
    passed: Array = sosfiltfilt(butter(4, cut, fs=rate, output="sos"), x, axis=0, padlen=reach)
    return passed


def _rates(x: Array, rate: float) -> tuple[Array, Array]:
    """First and second derivative along the first axis, by differences of the fourth order."""
    padded = np.pad(x, ((2, 2), (0, 0)), mode="reflect", reflect_type="odd")
    a, b, c, d, e = (padded[k : len(padded) - 4 + k] for k in range(5))
    return (a - 8 * b + 8 * d - e) * rate / 12, (-a + 16 * b - 30 * c + 16 * d - e) * rate**2 / 12


def _lasting(x: Array, least: float) -> Array:
    """True where x is true for as many samples as `least` together."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], x.astype(int), [0]])))
    out = np.zeros(len(x), bool)
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        out[first:last] = last - first >= least
    return out
