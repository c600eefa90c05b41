"""What records must hold to be asked: a motion that excites the model and what is asked for, of one arm."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

import numpy as np

from modelgen.dataset import Prepared, drives_of
from modelgen.description import Arm
from modelgen.diagnosis.candidates import LATER, PERIODIC, Candidate, Place, candidate_columns, grid_unit
from modelgen.diagnosis.rows import Rows
from modelgen.diagnosis.stack import orthonormal
from modelgen.diagnosis.system import moving_share, rmse, stacked, weighted_fit
from modelgen.diagnosis.whitening import ORDER
from modelgen.effects import CATALOGUE
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.probing import Prober

WORST = 1e3  # condition number, columns of unit norm, up to which the motion counts as an excitation
APART = 3.0  # errors of one model for all records over those of one model each
LARGE = 0.05  # of the effort: an error that no small cause explains
NONE = 0.95  # of the effort, left where nothing is explained
GIVEN = 0.2  # of the power at a joint: what friction that is not there may seem to give
OWN = 1e-4  # part of a column that the model's own columns must leave over
INERTIAL = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
LEAST = 0.02  # share of rows in which a joint must move


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


def check_one_arm(arm: Arm, model: Model, rows: Sequence[Rows], prober: Prober, base: Array) -> None:
    """Raises InputError where no one model of this arm comes near to all records.

    One fit to two leaves several times what a fit to each leaves, and much of the effort, though the second
    may have frictions of its own and a payload.
    """
    if len(rows) < 2 or any(r.prepared.input is None for r in rows):
        return
    n = rows[0].effort.shape[1]
    of_effects = _of_effects(model)
    for r in rows[1:]:
        pair = [rows[0], r]
        payload = candidate_columns(Candidate(LATER, None), {}, pair, prober, base)
        own = [np.zeros((len(rows[0].effort), n, len(of_effects))), r.columns[:, :, of_effects]]
        parts = [[x.columns for x in pair], own, *([] if payload is None else [payload])]
        table = [np.concatenate([part[k] for part in parts], axis=2) for k in range(2)]
        both = rmse(pair, table, weighted_fit(pair, table))
        each = [rmse([x], [x.columns], weighted_fit([x], [x.columns])) for x in pair]
        apart = np.sqrt((each[0] ** 2 + each[1] ** 2) / 2)
        size = 1.0 / _weights(pair)
        wrong = (both > APART * apart) & (both > LARGE * size)
        if wrong.any():
            joints = ", ".join(str(j + 1) for j in np.flatnonzero(wrong))
            ratio = float((both / np.maximum(apart, 1e-300))[wrong].max())
            names = " and ".join(x.prepared.record.name for x in pair)
            raise InputError(
                f"{names}: no one model of {arm.name} fits both, at joint {joints} it leaves {ratio:.1f} "
                "times what a model of each leaves; expected records of one arm, their columns in one order"
            )


def _of_effects(model: Model) -> list[int]:
    """Places of the base parameters in which no link has a part."""
    return [k for k, b in enumerate(model.grouping.base) if not any(_link(model, i) for i, _ in b.terms)]


def _link(model: Model, standard: int) -> bool:
    return model.standard[standard].name.rstrip("0123456789") in INERTIAL


def _weights(rows: Sequence[Rows]) -> Array:
    size = rmse(rows, [np.zeros_like(r.columns) for r in rows], np.zeros(rows[0].columns.shape[2]))
    return np.asarray(1.0 / np.maximum(size, 1e-300))


def asked(
    pool: Sequence[Candidate],
    wanted: Sequence[Place],
    rows: Sequence[Rows],
    prober: Prober,
    base: Array,
) -> list[Candidate]:
    """The candidates that are asked for; all where nothing is. wanted: effects, with a joint from 1 or None.

    Raises InputError for unknown effects, effects that the model has, places where an effect cannot stand,
    and where the motion of the training records cannot show it.
    """
    if not wanted:
        return list(pool)
    arm, found = prober.arm, list[Candidate]()
    for effect, joint in wanted:
        if effect not in CATALOGUE:
            near = get_close_matches(effect, CATALOGUE, n=1)
            hint = f", did you mean '{near[0]}'?" if near else ", expected one of `modelgen effects`"
            raise InputError(f"--effect: found '{effect}'{hint}")
        if joint is not None and not 1 <= joint <= len(arm.coordinates):
            raise InputError(
                f"--effect {effect}:{joint}: found joint {joint}, expected 1 to {len(arm.coordinates)}"
            )
        there = [c for c in pool if c.effect == effect and joint in (None, c.joint)]
        if not there:
            raise InputError(f"--effect {_text((effect, joint))}: {_absent(arm, effect, joint)}")
        shown = [c for c in there if _shows(c, rows, prober, base)]
        if not shown:
            raise InputError(
                f"--effect {_text((effect, joint))}: {_hidden(there, rows)}; see modelgen excite"
            )
        found += [c for c in shown if c not in found]
    return found


def _text(place: Place) -> str:
    return place[0] if place[1] is None else f"{place[0]}:{place[1]}"


def _absent(arm: Arm, effect: str, joint: int | None) -> str:
    places = [joint] if joint is not None else list(range(1, len(arm.coordinates) + 1))
    uses = [*arm.effects, *(u for n in places for u in arm.joints[arm.coordinates[n - 1]].effects)]
    where = "the arm" if joint is None else f"joint {joint}"
    if any(u.name == effect for u in uses):
        return f"the model of {where} has it already; its parameters are estimated, see modelgen identify"
    return f"it cannot stand at {where} of {arm.name}, or not with these records"


def _hidden(there: Sequence[Candidate], rows: Sequence[Rows]) -> str:
    share = moving_share(rows)
    still = sorted({c.joint for c in there if c.joint is not None and share[c.joint - 1] <= LEAST})
    if still:
        return f"joint {', '.join(map(str, still))} rests in the training records, which cannot show it"
    return "the motion of the training records cannot show it: the model's own parameters absorb all of it"


def _shows(c: Candidate, rows: Sequence[Rows], prober: Prober, base: Array) -> bool:
    """Whether the candidate has a part of its own in the equations."""
    share = moving_share(rows)
    if c.joint is not None and share[c.joint - 1] <= LEAST:
        return False
    if c.effect == PERIODIC:
        return True
    values = {}
    for p in c.searched[:1]:
        values[p.name] = grid_unit(p.scale, c.effect, c.joint, rows, prober) * p.grid[len(p.grid) // 2]
    made = candidate_columns(c, values, rows, prober, base)
    if made is None:
        return False
    weights = _weights(rows)
    own, _ = stacked(rows, [r.columns for r in rows], weights)
    added, _ = stacked(rows, made, weights)
    basis = orthonormal(own)
    left = np.linalg.norm(added - basis @ (basis.T @ added), axis=0)
    return bool((left > OWN * np.linalg.norm(added, axis=0)).any())
