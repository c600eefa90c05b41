"""Records must excite the model and what is asked for, and be of one arm, to be asked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset import Prepared, drives_of
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

    Where a joint rests there is no such demand: the others can be asked all the same.
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
    if s[0] <= worst * s[-1]:
        return
    several = np.argsort(-np.abs(vt[-1]))[:3]
    names = [b.name for b in model.grouping.base] if len(norms) == len(model.grouping.base) else []
    said = f" ({', '.join(names[used[k]] for k in several)})" if names else ""
    raise InputError(
        f"{equations.arm.name}: the motion of the training records does not tell the model's parameters "
        f"apart{said}, condition number {s[0] / max(s[-1], 1e-300):.2g}, expected {worst:.0f} at most; "
        "see modelgen excite"
    )


def check_efforts(equations: Equations) -> None:
    """Raises InputError where the efforts of a record cannot belong to its motion.

    A model of that record alone must explain some of them, and what it has at the drives takes work from the
    motion: friction does, and inertia gives back what it took. Efforts of the wrong sign would pass for a
    payload that the other records have.
    """
    limits, drives = equations.thresholds.equations, drives_of(equations.arm)
    effects = columns_of_effects(equations.model)
    for r in equations.rows:
        if r.prepared.input is None:
            continue
        theta = weighted_fit([r], [r.columns])
        size = rmse([r], [np.zeros_like(r.columns)], np.zeros(len(theta)))
        moving = [j for j in range(r.effort.shape[1]) if r.moving[:, j].any()]
        name = r.prepared.record.name
        if (
            moving
            and (rmse([r], [r.columns], theta)[moving] > limits.max_unexplained_effort * size[moving]).all()
        ):
            raise InputError(
                f"{name}: the model explains next to nothing of the efforts, fitted to this record alone; "
                "expected efforts and positions of the same joints at the same time"
            )
        q, dq = r.prepared.picked(r.prepared.q), r.prepared.picked(r.prepared.dq)
        speed = dq * np.column_stack([drive.gain(q[:, j]) for j, drive in enumerate(drives)])
        taken, power = r.columns[:, :, effects] @ theta[effects] * speed, np.abs(r.effort * speed)
        most = limits.max_driving_friction
        given = [
            j + 1 for j in moving if taken[r.moving[:, j], j].sum() < -most * power[r.moving[:, j], j].sum()
        ]
        if given:
            raise InputError(
                f"{name}: friction at joint {', '.join(map(str, given))} would drive the motion there; "
                "expected efforts that act in the direction of the positions: is their sign the other way "
                "round, or that of torque_constant?"
            )


def columns_of_effects(model: Model) -> list[int]:
    """Places of the base parameters in which no link has a part."""
    return [k for k, b in enumerate(model.grouping.base) if not any(_link(model, i) for i, _ in b.terms)]


def _link(model: Model, standard: int) -> bool:
    return model.standard[standard].name.rstrip("0123456789") in INERTIAL


def weights_of_efforts(rows: Sequence[Rows]) -> Array:
    """One over the RMS effort by joint (n,)."""
    size = rmse(rows, [np.zeros_like(r.columns) for r in rows], np.zeros(rows[0].columns.shape[2]))
    return np.asarray(1.0 / np.maximum(size, 1e-300))
