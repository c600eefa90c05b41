"""Drive gains and parameters together, from records with and without a known payload.

With g the true torque constant over the described one, row j says g_j i_j = w_j (theta + payload), w_j the
regressor in the described constants. Everything but the payload scales: its known mass fixes the scale
(Gautier and Briot 2014, who solve by total least squares). Here the currents alone count as noisy, so
that i_j = b_j w_j (theta + payload), b = 1/g, is fitted by Gauss and Newton's method, with weights and
standard deviations as in every other fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution, Triangle

TURNS = 30
SETTLED = 1e-8  # relative change of the gains at which the iteration ends
LOOSEST = 0.3  # relative standard deviation from which a gain counts as not determined


@dataclass(frozen=True)
class Gain:
    """A drive's torque constant: as described, as found, standard deviation of that [described unit]."""

    joint: int
    described: float
    value: float
    std: float


def driven(arm: Arm) -> NDArray[np.bool_]:
    """Flags (n,) of the coordinates that have a drive."""
    return np.array([arm.joints[i].drive.driven for i in arm.coordinates])


def estimated(
    arm: Arm, regression: Regression, carried: Sequence[Array], method: str
) -> tuple[Solution, tuple[Gain, ...]]:
    """Base parameters in the scale of the gains that were found, and those. method: "ols", "wls", "robust".

    regression: in the described constants, payloads not subtracted. carried: what each record's payload adds
    to the inputs (M, n), in the described constants too. Raises InputError without a drive, without a
    payload, and for a gain that these records do not determine.
    """
    flags = driven(arm)
    if not flags.any():
        raise InputError("--gains estimated: no joint has a drive, so that there is no gain to be found")
    if not any(m.any() for m in carried):
        raise InputError(
            "--gains estimated: without a known payload the gains and all parameters share a scale that no "
            "record shows; expected --payload LOG=KG for one of the training records"
        )
    where, p = np.flatnonzero(flags), regression.columns[0].shape[2]
    x = _start(regression, carried, where)
    solution = None
    for _ in range(TURNS):
        solution = _linearised(regression, carried, where, x).solve(method)
        change = np.abs(solution.theta[p:] - x[p:]).max()
        x = solution.theta
        if change <= SETTLED:
            break
    assert solution is not None
    spread = np.sqrt(np.maximum(np.diag(solution.covariance)[p:], 0.0))
    for k, j in enumerate(where):
        if not solution.determined[p + k] or not spread[k] < LOOSEST * x[p + k]:
            name = arm.joints[arm.coordinates[j]].name
            raise InputError(
                f"--gains estimated: these records do not determine the gain of joint {name}; expected a "
                "heavier payload, motions in which it loads that joint, or it in another of the records"
            )
    found = []
    for k, j in enumerate(where):
        described = arm.joints[arm.coordinates[j]].drive.torque_constant
        value = described / x[p + k]
        found.append(Gain(int(j) + 1, described, float(value), float(value * spread[k] / x[p + k])))
    return _of_parameters(solution, p), tuple(found)


def with_gains(arm: Arm, gains: Sequence[Gain]) -> Arm:
    """The arm with the torque constants that were found."""
    joints = list(arm.joints)
    for gain in gains:
        index = arm.coordinates[gain.joint - 1]
        drive = joints[index].drive.with_torque_constant(gain.value)
        joints[index] = replace(joints[index], drive=drive)
    return replace(arm, joints=tuple(joints))


def _start(regression: Regression, carried: Sequence[Array], where: NDArray[np.intp]) -> Array:
    """Parameters and b of g_j i_j - w_j theta = w_j payload, linear in theta and g."""
    n, p = regression.columns[0].shape[1:]
    triangle = Triangle(p + len(where))
    place = {int(j): p + k for k, j in enumerate(where)}
    for y, table, moving, more in zip(
        regression.effort, regression.columns, regression.moving, carried, strict=True
    ):
        for j in range(n):
            rows = moving[:, j]
            block = np.zeros((int(rows.sum()), p + len(where)))
            block[:, :p] = -table[rows, j]
            right = more[rows, j].copy()
            if j in place:
                block[:, place[j]] = y[rows, j]
            else:
                right = right - y[rows, j]
            if len(block):
                triangle.add(block, right)
    x = triangle.solve()[0]
    x[p:] = 1.0 / np.where(x[p:] > 0.05, x[p:], 1.0)
    return np.asarray(x)


def _linearised(
    regression: Regression, carried: Sequence[Array], where: NDArray[np.intp], x: Array
) -> Regression:
    """i = b w (theta + payload) around x, with the parameters themselves as unknowns."""
    n, p = regression.columns[0].shape[1:]
    b = np.ones(n)
    b[where] = x[p:]
    effort, columns = [], []
    for y, table, more in zip(regression.effort, regression.columns, carried, strict=True):
        ideal = table @ x[:p] + more
        whole = np.zeros((*table.shape[:2], p + len(where)))
        whole[:, :, :p] = table * b[:, None]
        whole[:, where, p + np.arange(len(where))] = ideal[:, where]
        columns.append(whole)
        effort.append(y - ideal * b + whole @ x)
    return Regression(effort, columns, regression.moving)


def _of_parameters(solution: Solution, p: int) -> Solution:
    """The solution without the gains; its precision is the one with the gains free."""
    a, c, g = solution.precision[:p, :p], solution.precision[:p, p:], solution.precision[p:, p:]
    return replace(
        solution,
        theta=solution.theta[:p],
        covariance=solution.covariance[:p, :p],
        determined=solution.determined[:p],
        precision=a - c @ np.linalg.solve(g, c.T),
    )
