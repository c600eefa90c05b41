"""Candidates that the user asks for by name, and whether the records can show them."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import Candidate, Place, first_values
from modelgen.diagnosis.candidates.columns import candidate_columns
from modelgen.diagnosis.equations.checks import _of_effects, _weights
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.thresholds import APART, LARGE, LEAST, OWN
from modelgen.effects import CATALOGUE, Presence
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_share, orthonormal, rmse, stacked, weighted_fit


def check_one_arm(arm: Arm, model: Model, rows: Sequence[Rows], evaluator: Evaluator, base: Array) -> None:
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
        later = [candidate_columns(c, {}, pair, evaluator, base) for c in coming_later(arm)]
        own = [np.zeros((len(rows[0].effort), n, len(of_effects))), r.columns[:, :, of_effects]]
        parts = [[x.columns for x in pair], own, *(made for made in later if made is not None)]
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


def coming_later(arm: Arm) -> list[Candidate]:
    """What may come between two records, with all its parameters."""
    return [
        Candidate(name, place)
        for name, effect in CATALOGUE.items()
        if effect.presence is Presence.LATER
        for place in ([None] if effect.scope != "joint" else range(1, len(arm.coordinates) + 1))
    ]


def asked(
    pool: Sequence[Candidate],
    wanted: Sequence[Place],
    rows: Sequence[Rows],
    evaluator: Evaluator,
    base: Array,
) -> list[Candidate]:
    """The candidates that are asked for; all where nothing is. wanted: effects, with a joint from 1 or None.

    Raises InputError for unknown effects, effects that the model has, places where an effect cannot stand,
    and where the motion of the training records cannot show it.
    """
    if not wanted:
        return list(pool)
    arm, found = evaluator.arm, list[Candidate]()
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
        shown = [c for c in there if _shows(c, rows, evaluator, base)]
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


def _shows(c: Candidate, rows: Sequence[Rows], evaluator: Evaluator, base: Array) -> bool:
    """Whether the candidate has a part of its own in the equations."""
    share = moving_share(rows)
    if c.joint is not None and share[c.joint - 1] <= LEAST:
        return False
    if c.definition.periodic:
        return True
    values = first_values(c, rows, evaluator)
    made = None if values is None else candidate_columns(c, values, rows, evaluator, base)
    if made is None:
        return False
    weights = _weights(rows)
    own, _ = stacked(rows, [r.columns for r in rows], weights)
    added, _ = stacked(rows, made, weights)
    basis = orthonormal(own)
    left = np.linalg.norm(added - basis @ (basis.T @ added), axis=0)
    return bool((left > OWN * np.linalg.norm(added, axis=0)).any())
