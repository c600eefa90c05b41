"""Records must excite the model and what is asked for, and be of one arm, to be asked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.dataset.drives import gains
from modelgen.diagnosis.equations.equations import Equations
from modelgen.diagnosis.equations.rows import Rows
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_share, rmse, stacked, weighted_fit

INERTIAL = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")


def check_motion(equations: Equations) -> None:
    """Raises InputError where the records are too short, or rest."""
    limits, arm, rows = equations.thresholds.equations, equations.arm, equations.rows
    least = equations.thresholds.evidence.min_rows
    short = [r.prepared for r in rows if len(r.effort) < least]
    if short:
        raise InputError(
            f"{short[0].record.name}: too short a record: {len(short[0].rows)} rows are left, expected at "
            f"least {least} ({least / short[0].rate:.2g} s and what the filters trim)"
        )
    if not (moving_share(rows) > limits.min_moving_share).any():
        raise InputError(
            f"{arm.name}: all joints rest in the training records; expected a motion, see modelgen excite"
        )
    count, times = sum(int(r.moving.sum()) for r in rows), limits.min_equations_per_unknown
    if count < times * equations.unknowns:
        raise InputError(
            f"{arm.name}: {count} equations for {equations.unknowns} parameters: the records are too short "
            f"or move too little, expected at least {times:g} times as many; see modelgen excite"
        )


def check_test(test: Prepared) -> None:
    """Raises InputError where no joint moves in the test record."""
    if not test.moving.any():
        raise InputError(
            f"{test.record.name}: all joints rest in the test record; expected a motion like those of the "
            "training records, on which the gain can be measured"
        )


def check_excitation(equations: Equations) -> None:
    """Raises InputError where the motion does not tell the model's own parameters apart.

    Where a joint rests there is no such demand: the others can be asked all the same. Nor is there where few
    combinations look alike, as weight and buoyancy of a slow arm do: causes are looked for beside these.
    """
    limits, rows, model = equations.thresholds.equations, equations.rows, equations.model
    if not (moving_share(rows) > limits.min_moving_share).all():
        return
    table, _ = stacked(rows, [r.columns for r in rows], weights_of_efforts(rows))
    norms = np.linalg.norm(table, axis=0)
    used = np.flatnonzero(norms > 0)
    if not len(used):
        return
    _, s, vt = np.linalg.svd(table[:, used] / norms[used], full_matrices=False)
    worst = limits.max_condition_number
    unknown = int((s[0] > worst * s).sum())
    if unknown <= limits.max_unseparated_share * len(s):
        return
    several = np.argsort(-np.abs(vt[-1]))[:3]
    names = [b.name for b in model.grouping.base] if len(norms) == len(model.grouping.base) else []
    said = f" ({', '.join(names[used[k]] for k in several)})" if names else ""
    raise InputError(
        f"{equations.arm.name}: the motion of the training records does not tell the model's parameters "
        f"apart{said}: {unknown} combinations of {len(s)} do not show (condition number "
        f"{s[0] / max(s[-1], 1e-300):.2g}, {worst:.0f} is usual); see modelgen excite"
    )


def check_efforts(equations: Equations) -> None:
    """Raises InputError where the efforts of a record cannot belong to its motion.

    A model of that record alone must explain some of them. What the model of all records has at the drives
    takes work from the motion: friction does, and inertia gives back what it took. The efforts of a record
    have the sign of the others': turned round they would pass for a payload that the others lack.
    """
    limits, rows = equations.thresholds.equations, equations.rows
    if equations.free:
        return
    for r in rows:
        theta = weighted_fit([r], [r.columns])
        size, left, moving = _rms(r, 0.0 * theta), _rms(r, theta), r.moving.any(axis=0)
        if moving.any() and (left[moving] > limits.max_unexplained_effort * size[moving]).all():
            raise InputError(
                f"{r.prepared.record.name}: the model explains next to nothing of the efforts, fitted to "
                "this record alone; expected efforts and positions of the same joints at the same time"
            )
    for k, r in enumerate(rows if len(rows) > 1 else ()):
        others = [other for i, other in enumerate(rows) if i != k]
        theta = weighted_fit(others, [other.columns for other in others])
        known = np.any([other.moving.any(axis=0) for other in others], axis=0) & r.moving.any(axis=0)
        turned = np.flatnonzero(known & (_rms(r, -theta) < limits.max_turned_share * _rms(r, theta)))
        if len(turned):
            raise InputError(
                f"{r.prepared.record.name}: the efforts of {_names(equations, turned)} fit those of the "
                "other records with the other sign; expected one sign in all of them"
            )
    driving = np.flatnonzero(_work_of_effects(equations) < -limits.max_driving_friction)
    if len(driving):
        raise InputError(
            f"{rows[0].prepared.record.name}: friction at {_names(equations, driving)} would drive the "
            "motion there; expected efforts that act in the direction of the positions: is their sign the "
            "other way round, or that of torque_constant?"
        )


def _rms(r: Rows, theta: Array) -> Array:
    """RMS of what parameters (k,) leave of a record's efforts, by joint (n,)."""
    return rmse([r], [r.columns], theta)


def _names(equations: Equations, joints: Sequence[int] | NDArray[np.intp]) -> str:
    return ", ".join(equations.arm.coordinate_names[j] for j in joints)


def _work_of_effects(equations: Equations) -> Array:
    """Work that drives and friction take from the motion of all records, over that of the efforts, both in
    size, by joint (n,).
    """
    rows = equations.rows
    theta, effects = weighted_fit(rows, equations.columns), columns_of_effects(equations.model)
    taken, power = np.zeros(equations.n), np.zeros(equations.n)
    for r in rows:
        q, dq = r.prepared.picked(r.prepared.q), r.prepared.picked(r.prepared.dq)
        speed = dq * gains(equations.arm, q)
        taken += (r.columns[:, :, effects] @ theta[effects] * speed * r.moving).sum(axis=0)
        power += (np.abs(r.effort * speed) * r.moving).sum(axis=0)
    return np.asarray(taken / np.maximum(power, 1e-300))


def columns_of_effects(model: Model) -> list[int]:
    """Places of the base parameters in which no link has a part."""
    return [k for k, b in enumerate(model.grouping.base) if not any(_link(model, i) for i, _ in b.terms)]


def _link(model: Model, standard: int) -> bool:
    return model.standard[standard].name.rstrip("0123456789") in INERTIAL


def weights_of_efforts(rows: Sequence[Rows]) -> Array:
    """One over the RMS effort by joint (n,)."""
    size = rmse(rows, [np.zeros_like(r.columns) for r in rows], np.zeros(rows[0].columns.shape[2]))
    return np.asarray(1.0 / np.maximum(size, 1e-300))
