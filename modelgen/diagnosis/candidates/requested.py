"""Candidates that the user asks for by name, and records that one model of the arm must fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import Candidate, Place, first_values
from modelgen.diagnosis.candidates.columns import candidate_columns
from modelgen.diagnosis.equations import Band, Equations, columns_of_effects, weights_of_efforts
from modelgen.effects import CATALOGUE, Presence
from modelgen.errors import InputError, nearest
from modelgen.regression.weighted import moving_share, orthonormal, rmse, stacked, weighted_fit


def check_one_arm(band: Band) -> None:
    """Raises InputError where no one model of this arm comes near to all records.

    One fit to two leaves several times what a fit to each leaves, and much of the effort, though the second
    may have frictions of its own and a payload.
    """
    equations, limits = band.equations, band.equations.thresholds.candidates
    arm, rows = equations.arm, equations.rows
    if len(rows) < 2 or any(r.prepared.input is None for r in rows):
        return
    of_effects = columns_of_effects(equations.model)
    for r in rows[1:]:
        pair = [rows[0], r]
        later = [candidate_columns(c, {}, equations.with_rows(pair), band.base) for c in coming_later(arm)]
        own = [np.zeros((*rows[0].effort.shape, len(of_effects))), r.columns[:, :, of_effects]]
        parts = [[x.columns for x in pair], own, *(made for made in later if made is not None)]
        table = [np.concatenate([part[k] for part in parts], axis=2) for k in range(2)]
        both = rmse(pair, table, weighted_fit(pair, table))
        each = [rmse([x], [x.columns], weighted_fit([x], [x.columns])) for x in pair]
        apart = np.sqrt((each[0] ** 2 + each[1] ** 2) / 2)
        size = 1.0 / weights_of_efforts(pair)
        wrong = both > limits.max_record_disagreement * apart
        wrong &= both > limits.min_record_disagreement * size
        if wrong.any():
            joints = ", ".join(arm.coordinate_names[j] for j in np.flatnonzero(wrong))
            ratio = float((both / np.maximum(apart, 1e-300))[wrong].max())
            names = " and ".join(x.prepared.record.name for x in pair)
            raise InputError(
                f"{names}: no one model of {arm.name} fits both, at {joints} it leaves {ratio:.1f} "
                "times what a model of each leaves; expected records of one arm, their columns in one order"
            )


def coming_later(arm: Arm) -> list[Candidate]:
    """What may be in the second of two records and not in the first, with all its parameters."""
    return [
        Candidate(name, place, absent=frozenset({0}))
        for name, effect in CATALOGUE.items()
        if effect.presence is Presence.SOME
        for place in ([None] if effect.scope != "joint" else range(1, len(arm.coordinates) + 1))
    ]


def asked(pool: Sequence[Candidate], wanted: Sequence[Place], band: Band) -> list[Candidate]:
    """The candidates that are asked for; all where nothing is. wanted: effects, with a joint from 1 or None.

    Raises InputError for unknown effects, effects that the model has, places where an effect cannot stand,
    and where the motion of the training records cannot show it.
    """
    if not wanted:
        return list(pool)
    arm, found = band.equations.arm, list[Candidate]()
    for effect, joint in wanted:
        if effect not in CATALOGUE:
            near = nearest(effect, CATALOGUE)
            hint = f", did you mean '{near}'?" if near else ", expected one of `modelgen effects`"
            raise InputError(f"--effect: found '{effect}'{hint}")
        if joint is not None and not 1 <= joint <= len(arm.coordinates):
            raise InputError(
                f"--effect {effect}:{joint}: found joint {joint}, expected 1 to {len(arm.coordinates)}"
            )
        there = [c for c in pool if c.effect == effect and joint in (None, c.joint)]
        if not there:
            raise InputError(f"--effect {_text((effect, joint))}: {_absent(arm, effect, joint)}")
        shown = [c for c in there if _shows(c, band)]
        if not shown:
            raise InputError(
                f"--effect {_text((effect, joint))}: {_hidden(there, band.equations)}; see modelgen excite"
            )
        found += [c for c in shown if c not in found]
    return found


def _text(place: Place) -> str:
    return place[0] if place[1] is None else f"{place[0]}:{place[1]}"


def _absent(arm: Arm, effect: str, joint: int | None) -> str:
    places = [joint] if joint is not None else list(range(1, len(arm.coordinates) + 1))
    uses = [*arm.effects, *(u for n in places for u in arm.joints[arm.coordinates[n - 1]].effects)]
    where = "the arm" if joint is None else arm.coordinate_names[joint - 1]
    if any(u.name == effect for u in uses):
        return f"the model of {where} has it already; its parameters are estimated, see modelgen identify"
    return f"it cannot stand at {where} of {arm.name}, or not with these records"


def _resting(c: Candidate, equations: Equations) -> bool:
    share = moving_share(equations.rows)
    return c.joint is not None and bool(share[c.joint - 1] <= equations.thresholds.equations.min_moving_share)


def _hidden(there: Sequence[Candidate], equations: Equations) -> str:
    still = sorted({c.joint for c in there if c.joint is not None and _resting(c, equations)})
    if still:
        names = ", ".join(equations.arm.coordinate_names[joint - 1] for joint in still)
        rests = "rests" if len(still) == 1 else "rest"
        return f"{names} {rests} in the training records, which cannot show it"
    return "the motion of the training records cannot show it: the model's own parameters absorb all of it"


def _shows(c: Candidate, band: Band) -> bool:
    """Whether the candidate has a part of its own in the equations."""
    equations, rows = band.equations, band.equations.rows
    if _resting(c, equations):
        return False
    if c.definition.periodic:
        return True
    values = first_values(c, equations)
    made = None if values is None else candidate_columns(c, values, equations, band.base)
    if made is None:
        return False
    weights = weights_of_efforts(rows)
    own, _ = stacked(rows, equations.columns, weights)
    added, _ = stacked(rows, made, weights)
    basis = orthonormal(own)
    left = np.linalg.norm(added - basis @ (basis.T @ added), axis=0)
    least = equations.thresholds.candidates.min_own_share
    return bool((left > least * np.linalg.norm(added, axis=0)).any())
