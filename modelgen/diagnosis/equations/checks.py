"""What records must hold to be asked: a motion that excites the model and what is asked for, of one arm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset import Prepared, drives_of
from modelgen.description import Arm
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.thresholds import LEAST, ORDER
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_share, rmse, stacked, weighted_fit

WORST = 1e3  # condition number, columns of unit norm, up to which the motion counts as an excitation
NONE = 0.95  # of the effort, left where nothing is explained
GIVEN = 0.2  # of the power at a joint: what friction that is not there may seem to give
INERTIAL = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")


def check_motion(arm: Arm, rows: Sequence[Rows]) -> None:
    """Raises InputError where the records are too short, or rest."""
    short = [r.prepared for r in rows if len(r.effort) < 3 * ORDER]
    if short:
        raise InputError(
            f"{short[0].record.name}: too short a record: {len(short[0].rows)} rows are left, expected at "
            f"least {3 * ORDER} ({3 * ORDER / short[0].rate:.2g} s and what the filters trim)"
        )
    if not (moving_share(rows) > LEAST).any():
        raise InputError(
            f"{arm.name}: all joints rest in the training records; expected a motion, see modelgen excite"
        )
    unknowns, equations = rows[0].columns.shape[2], sum(int(r.moving.sum()) for r in rows)
    if equations < 3 * unknowns:
        raise InputError(
            f"{arm.name}: {equations} equations for {unknowns} parameters: the records are too short or move "
            "too little, expected at least three times as many; see modelgen excite"
        )


def check_test(test: Prepared) -> None:
    """Raises InputError where no joint moves in the test record."""
    if not test.moving.any():
        raise InputError(
            f"{test.record.name}: all joints rest in the test record; expected a motion like those of the "
            "training records, on which the gain can be measured"
        )


def check_excitation(arm: Arm, model: Model, rows: Sequence[Rows]) -> None:
    """Raises InputError where the motion does not tell the model's own parameters apart.

    Where a joint rests there is no such demand: the others can be asked all the same.
    """
    if not (moving_share(rows) > LEAST).all():
        return
    table, _ = stacked(rows, [r.columns for r in rows], _weights(rows))
    norms = np.linalg.norm(table, axis=0)
    used = np.flatnonzero(norms > 0)
    if not len(used):
        return
    _, s, vt = np.linalg.svd(table[:, used] / norms[used], full_matrices=False)
    if s[0] <= WORST * s[-1]:
        return
    several = np.argsort(-np.abs(vt[-1]))[:3]
    names = [b.name for b in model.grouping.base] if len(norms) == len(model.grouping.base) else []
    said = f" ({', '.join(names[used[k]] for k in several)})" if names else ""
    raise InputError(
        f"{arm.name}: the motion of the training records does not tell the model's parameters apart{said}, "
        f"condition number {s[0] / max(s[-1], 1e-300):.2g}, expected {WORST:.0f} at most; see modelgen excite"
    )


def check_efforts(arm: Arm, model: Model, rows: Sequence[Rows]) -> None:
    """Raises InputError where the efforts of a record cannot belong to its motion.

    A model of that record alone must explain some of them, and what it has at the drives takes work from the
    motion: friction does, and inertia gives back what it took. Efforts of the wrong sign would pass for a
    payload that the other records have.
    """
    effects = _of_effects(model)
    for r in rows:
        if r.prepared.input is None:
            continue
        theta = weighted_fit([r], [r.columns])
        size = rmse([r], [np.zeros_like(r.columns)], np.zeros(len(theta)))
        moving = [j for j in range(r.effort.shape[1]) if r.moving[:, j].any()]
        name = r.prepared.record.name
        if moving and (rmse([r], [r.columns], theta)[moving] > NONE * size[moving]).all():
            raise InputError(
                f"{name}: the model explains next to nothing of the efforts, fitted to this record alone; "
                "expected efforts and positions of the same joints at the same time"
            )
        q, dq = r.prepared.picked(r.prepared.q), r.prepared.picked(r.prepared.dq)
        speed = dq * np.column_stack([drive.gain(q[:, j]) for j, drive in enumerate(drives_of(arm))])
        taken, power = r.columns[:, :, effects] @ theta[effects] * speed, np.abs(r.effort * speed)
        given = [
            j + 1 for j in moving if taken[r.moving[:, j], j].sum() < -GIVEN * power[r.moving[:, j], j].sum()
        ]
        if given:
            raise InputError(
                f"{name}: friction at joint {', '.join(map(str, given))} would drive the motion there; "
                "expected efforts that act in the direction of the positions: is their sign the other way "
                "round, or that of torque_constant?"
            )


def _of_effects(model: Model) -> list[int]:
    """Places of the base parameters in which no link has a part."""
    return [k for k, b in enumerate(model.grouping.base) if not any(_link(model, i) for i, _ in b.terms)]


def _link(model: Model, standard: int) -> bool:
    return model.standard[standard].name.rstrip("0123456789") in INERTIAL


def _weights(rows: Sequence[Rows]) -> Array:
    size = rmse(rows, [np.zeros_like(r.columns) for r in rows], np.zeros(rows[0].columns.shape[2]))
    return np.asarray(1.0 / np.maximum(size, 1e-300))
