"""A small least squares of the user's model, by which the size of a hidden effect is measured."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import csr_array

from blind.case import Array
from blind.family_b.equations import motor, regressor
from blind.family_b.logger import Record, as_believed
from blind.family_b.plan import Plan
from blind.family_b.world import World

ORDER = 4  # of the low-pass
WIDER = 4.5  # band of the positions, by that of the equations
STICKS = 0.02  # share of its highest speed below which a joint may stick
SLOW, LONG = 0.01, 0.15  # a joint rests below this share of its highest speed for this time [s]


def cutoff(plan: Plan) -> float:
    """Band of the equations [Hz]."""
    return min(8.0, plan.rate / 12.5)


def errors(world: World, plan: Plan, records: list[Record]) -> Array:
    """RMSE (3) of the currents of one fit to all records, in the band of `cutoff`; 0 where no joint is.

    world: as the user believes it to be; its links and frictions are fitted, the same to all records.
    """
    parts = [_equations(world, plan, r) for r in records]
    sides = {a: [np.concatenate([p[a][k] for p in parts]) for k in (0, 1)] for a in world.axes}
    weight = {a: 1 / float(np.std(y)) for a, (_, y) in sides.items()}
    left = np.zeros(3)
    for _ in range(2):
        phi = np.concatenate([x * weight[a] for a, (x, _) in sides.items()])
        norm = np.linalg.norm(phi, axis=0)
        norm[norm == 0] = 1
        goal = np.concatenate([y * weight[a] for a, (_, y) in sides.items()])
        theta = np.linalg.lstsq(phi / norm, goal, rcond=1e-9)[0] / norm
        for a, (x, y) in sides.items():
            left[a] = np.sqrt(np.mean((y - x @ theta) ** 2))
            weight[a] = 1 / left[a]
    return left


def _equations(world: World, plan: Plan, taken: Record) -> dict[int, tuple[Array, Array]]:
    """By axis: columns (M, k) and currents (M), filtered and decimated, of rows in which the joint moves."""
    band, rate = cutoff(plan), plan.rate
    read = as_believed(world, plan, taken)
    line = np.linspace(0, 1, len(read))[:, None] * (read[-1] - read[0]) + read[0]
    spline = CubicSpline(taken.t, _smooth(read - line, rate, WIDER * band) + line, axis=0)
    at = taken.t + plan.shift
    q, v, a = spline(at), spline(at, 1), spline(at, 2)
    shared = regressor(world.arm, q, v, a)
    low = low_pass(len(q), rate, band)
    count = [len(laws) for laws in world.effects]
    out = {}
    for number, axis in enumerate(world.axes, start=1):
        joint = world.joints[axis]
        _, g, gg = motor(joint, q[:, axis])
        speed = g * v[:, axis]
        own = {
            "viscous_friction": speed,
            "coulomb_friction": np.sign(speed),
            "drive_inertia": g * a[:, axis] + gg * v[:, axis] ** 2,
        }
        if joint.get("sped"):
            own["stribeck_friction"] = np.exp(-(np.abs(speed / joint["sped"]) ** joint["shape"])) * np.sign(
                speed
            )
        moves = np.abs(v[:, axis]) > STICKS * np.abs(v[:, axis]).max()  # dry friction is unknown elsewhere
        x = np.zeros((len(shared) + sum(count), len(q)))
        x[: len(shared)] = shared[:, :, axis] / (g * joint["kt"])
        first = len(shared) + sum(count[: number - 1])
        for k, law in enumerate(world.effects[number - 1]):
            x[first + k] = own[law]
        keep = ~(abs(low) @ _rests(v[:, axis], rate, band) > 0)
        out[axis] = (low @ (x * moves).T)[keep], (low @ (taken.i[:, axis] * moves))[keep]
    return out


def _smooth(x: Array, rate: int, band: float) -> Array:
    """Zero-phase low-pass along the first axis, periodic."""
    f = np.fft.rfftfreq(len(x), 1 / rate)
    gain = 1 / (1 + (f / band) ** (2 * ORDER))
    y: Array = np.fft.irfft(np.fft.rfft(x, axis=0) * gain[:, None], len(x), axis=0)
    return y


def low_pass(count: int, rate: int, band: float) -> csr_array:
    """Low-pass and decimation as a matrix (M, count): a windowed sinc, the same map for every column."""
    half = int(1.5 / band * rate)
    t = np.arange(-half, half + 1) / rate
    weight = np.sinc(2 * band * t) * np.hamming(len(t))
    centres = np.arange(half, count - half, max(1, int(rate / (2.5 * band))))
    columns = centres[:, None] + np.arange(-half, half + 1)
    rows = np.repeat(np.arange(len(centres)), len(t))
    data = np.tile(weight / weight.sum(), len(centres))
    return csr_array((data, (rows, columns.ravel())), shape=(len(centres), count))


def _rests(v: Array, rate: int, band: float) -> Array:
    """1 at samples at which a joint rests, and around them, 0 elsewhere."""
    slow = np.abs(v) < SLOW * np.abs(v).max()
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow.astype(int), [0]])))
    out = np.zeros(len(v))
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        if end - begin > LONG * rate:
            out[begin:end] = 1
    return out
