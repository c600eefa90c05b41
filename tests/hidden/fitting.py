"""The plant's own least squares: what a complete and an incomplete model leave of a record."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr, solve_triangular, toeplitz
from scipy.ndimage import gaussian_filter1d, maximum_filter1d
from scipy.signal import butter, lfilter, sosfiltfilt

from hidden import native
from hidden.logs import COLOUR, COLOURED, WHITE, Log, joints_of
from hidden.native import Array, Plant

POSITION_BAND, BAND = 60.0, 15.0  # Hz
THIN = 250.0  # Hz, at which columns are evaluated
EDGE = 0.6  # s left out at either end
REST, SPREAD = 0.01, 0.02  # of the top speed; s about it


@dataclass(frozen=True)
class Rows:
    """Decimated equations. columns: (N, n, p), effort: (N, n) [A], or N m of a free motion.

    moving: (N, n), 1 where the joint is neither at rest nor about to reverse, else 0. step: [s].
    """

    columns: Array
    effort: Array
    moving: Array
    step: float


def low_pass(values: Array, band: float, rate: float) -> Array:
    """By a Gaussian kernel, 3 dB down at `band` [Hz] whatever the rate."""
    return np.asarray(gaussian_filter1d(values, math.sqrt(math.log(2)) / (2 * math.pi * band) * rate, axis=0))


def equations(log: Log, described: Plant, pulled: bool = False) -> Rows:
    """Regressor of links and standard friction, and effort, low-passed alike.

    pulled: with a spring and a constant current at each joint besides.
    """
    n = int(described["n"])
    flat = butter(4, POSITION_BAND, fs=log.rate, output="sos")  # a bell would round off the motion itself
    q = sosfiltfilt(flat, joints_of(log, described), axis=0)
    dq = np.gradient(q, 1.0 / log.rate, axis=0)
    ddq = np.gradient(dq, 1.0 / log.rate, axis=0)
    # At rest dry friction takes any value within its bounds: no equation. The filters spread that in time.
    slow = np.abs(dq) < REST * np.abs(dq).max(axis=0)
    moving = maximum_filter1d(slow.astype(float), 2 * int(SPREAD * log.rate) + 1, axis=0) < 0.5
    thin = max(1, round(log.rate / THIN))
    columns = native.regressor(described, q[::thin], dq[::thin], ddq[::thin])
    if log.current is None:
        effort = -(columns[:, :, : 10 * n] @ standard_links(described))
        columns = columns[:, :, 10 * n :].reshape(-1, n, n, 3)[..., 1:].reshape(-1, n, 2 * n)
        effort = low_pass(effort, BAND, log.rate / thin)
    else:
        # Held from its stamp on: centred on the stamp by the mean with the one before.
        effort = log.current.copy()
        effort[1:] = 0.5 * (log.current[1:] + log.current[:-1])
        effort = low_pass(effort, BAND, log.rate)[::thin]
        columns = columns[:, :, independent(described)]
        if pulled:
            columns = np.concatenate([columns, pulls(described, q[::thin])], axis=2)
    rate = log.rate / thin
    step, edge = max(1, int(rate / (2.4 * BAND))), int(EDGE * rate)
    kept = slice(edge, len(columns) - edge, step)
    kept_columns = low_pass(columns.reshape(len(columns), -1), BAND, rate)[kept].reshape(
        -1, n, columns.shape[2]
    )
    return Rows(kept_columns, effort[kept], moving[::thin][kept].astype(float), step / rate)


def pulls(described: Plant, q: Array) -> Array:
    """(N, n, 3 n) [A]: at each joint a constant current, a constant torque and one in proportion to q."""
    n = int(described["n"])
    unit = native.regressor(described, q, np.ones_like(q), np.zeros_like(q))  # viscous: slope over constant
    out = np.zeros((len(q), n, n, 3))
    for j in range(n):
        torque = 1.0 / (unit[:, j, 10 * n + 3 * j + 1] * described["torque_constant"][j] ** 2)
        out[:, j, j] = np.column_stack([np.ones(len(q)), torque, torque * q[:, j]])
    return out.reshape(len(q), n, 3 * n)


def standard_links(plant: Plant) -> Array:
    """(10 n,): mass, first moments, inertia about the origin (xx xy xz yy yz zz), link after link."""
    out = []
    for j in range(int(plant["n"])):
        mass, com = float(plant["mass"][j]), plant["com"][j]
        at_origin = mass * (com @ com * np.eye(3) - np.outer(com, com))
        out += [[mass], mass * com, plant["inertia"][j] + at_origin[np.triu_indices(3)]]
    return np.concatenate(out)


def independent(described: Plant) -> Array:
    """Indices of standard parameters whose columns span all of them, in motions of any kind."""
    n = int(described["n"])
    draw = np.random.default_rng(0)
    q, dq, ddq = (draw.uniform(-1, 1, size=(200, n)) for _ in range(3))
    for j in range(n):
        if described["kind"][j] > 1.5:  # within the stroke
            inner = np.pi / 2 + 0.6 * q[:, j]
            q[:, j] = described["offset"][j] + described["rev"][j] * inner
    stacked = native.regressor(described, q, dq, ddq).reshape(200 * n, -1)
    size = np.linalg.norm(stacked, axis=0)
    used = np.flatnonzero(size > 1e-12 * size.max())
    _, upper, order = qr(stacked[:, used] / size[used], mode="economic", pivoting=True)
    values = np.abs(np.diag(upper))
    return np.asarray(np.sort(used[order[: int((values > 1e-8 * values[0]).sum())]]))


def solve(rows: list[Rows]) -> Array:
    """Weighted least squares over records, each joint by its own residual."""
    n = rows[0].effort.shape[1]
    weight = np.ones(n)
    estimate = np.zeros(rows[0].columns.shape[2])
    for _ in range(3):
        scale = [item.moving * weight for item in rows]
        left = np.concatenate(
            [
                (item.columns * by[..., None]).reshape(-1, len(estimate))
                for item, by in zip(rows, scale, strict=True)
            ]
        )
        right = np.concatenate([(item.effort * by).ravel() for item, by in zip(rows, scale, strict=True)])
        estimate = np.linalg.lstsq(left, right, rcond=None)[0]
        weight = 1.0 / rms([residual(item, estimate) for item in rows], rows)
    return estimate


def residual(rows: Rows, estimate: Array) -> Array:
    """Effort less prediction (N, n), zero where the joint does not move."""
    return np.asarray((rows.effort - rows.columns @ estimate) * rows.moving)


def rms(residuals: list[Array], rows: list[Rows]) -> Array:
    """Over the moving samples, by joint (n,)."""
    total = sum((item**2).sum(axis=0) for item in residuals)
    return np.asarray(np.sqrt(total / sum(item.moving.sum(axis=0) for item in rows)))


def rotated(records: list[Log], described: Plant, held_out: tuple[int, ...], pulled: bool = False) -> Array:
    """RMSE (n,) over the records of these numbers, each predicted by a fit to the others."""
    rows = [equations(log, described, pulled) for log in records]
    left_over = []
    for k in held_out:
        estimate = solve([item for number, item in enumerate(rows) if number != k])
        left_over.append(residual(rows[k], estimate))
    return rms(left_over, [rows[k] for k in held_out])


def shown(records: list[Log], clean: list[Log], sizes: list[Array], described: Plant) -> float:
    """Twice the log likelihood that one fit to the records is expected to lose by the effects.

    records, clean: without noise, with and without the effects. sizes: (n,) of each record, the RMS [A] in
    whose proportion noise of the colour that is drawn comes on top; its level is estimated.
    """
    left, counts = [], []
    for logs in (records, clean):
        rows = [equations(log, described) for log in logs]
        counts.append(np.sum([item.moving.sum(axis=0) for item in rows], axis=0))
        left.append(_whitened_squares(rows, sizes, clean[0].rate) / np.maximum(counts[-1], 1.0))
    return float((counts[1] * np.log((1.0 + left[0]) / (1.0 + left[1]))).sum())


def _whitened_squares(rows: list[Rows], sizes: list[Array], rate: float) -> Array:
    """What generalised least squares leaves by joint (n,), in units of the noise's variance.

    The joints are weighted by what they leave, and the noise.
    """
    n = rows[0].effort.shape[1]
    parts: list[list[Array]] = [[] for _ in range(n)]
    for item, size in zip(rows, sizes, strict=True):
        covariance = noise_covariance(len(item.effort), round(item.step * rate), rate)
        for j in range(n):
            used = item.moving[:, j] > 0.5
            factor = size[j] * np.linalg.cholesky(covariance[np.ix_(used, used)])
            table = np.column_stack([item.columns[used, j], item.effort[used, j]])
            parts[j].append(solve_triangular(factor, table, lower=True))
    tables, weight = [np.concatenate(part) for part in parts], np.ones(n)
    left = weight
    for _ in range(3):
        stacked = np.concatenate([table * by for table, by in zip(tables, weight, strict=True)])
        estimate = np.linalg.lstsq(stacked[:, :-1], stacked[:, -1], rcond=None)[0]
        left = np.array([((table[:, -1] - table[:, :-1] @ estimate) ** 2).sum() for table in tables])
        weight = 1.0 / np.sqrt(1.0 + left / np.array([max(1, len(table)) for table in tables]))
    return left


def noise_covariance(count: int, step: int, rate: float) -> Array:
    """(count, count) of the noise of every `step`-th sample, low-passed as efforts are [A^2, of a current of
    1 A RMS], and a hundredth of it for what the encoders' counts leave.
    """
    length = int(rate)
    white = np.zeros(2 * length)
    white[length : length + 2] = 0.5  # the mean with the one before
    pole = math.exp(-2 * math.pi * COLOUR / rate)
    coloured = lfilter([math.sqrt(1 - pole**2)], [1, -pole], white)
    total = np.zeros(length)
    for size, response in ((WHITE, white), (COLOURED, coloured)):
        passed = low_pass(response, BAND, rate)
        total += size**2 * np.correlate(passed, passed, mode="full")[2 * length - 1 : 3 * length - 1]
    lags = np.zeros(count)
    kept = total[::step][:count]
    lags[: len(kept)] = kept
    lags[0] *= 1.01
    return np.asarray(toeplitz(lags))
