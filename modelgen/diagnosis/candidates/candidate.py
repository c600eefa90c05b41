"""Effects that the arm may have besides: where, with which values to search for, and their columns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from modelgen.dataset import drives_of, parse
from modelgen.diagnosis.equations import Equations, Rows, turning
from modelgen.effects import CATALOGUE, Definition, Family, Parameter, Presence
from modelgen.effects.traits import joint_of
from modelgen.evaluation import places

Values = Mapping[str, float]
Place = tuple[str, int | None]  # effect and joint
NEAR = 0.02  # of its logarithm, to which a section finds the end of a search


@dataclass(frozen=True)
class Candidate:
    """An effect at a place. fixed: values that are not searched for; searched: nonlinear parameters that are;
    part: of the parameters that are estimated, those that are asked for, empty for all; forms: how many
    candidates there are for the effect at the place; places: how many places the effect is asked for at;
    absent: records (from 0) without it.

    joint counts coordinates from 1, None for the whole arm.
    """

    effect: str
    joint: int | None
    fixed: Values = field(default_factory=dict)
    searched: tuple[Parameter, ...] = ()
    part: tuple[str, ...] = ()
    forms: int = 1
    places: int = 1
    absent: frozenset[int] = frozenset()

    @property
    def place(self) -> Place:
        """Effect and joint."""
        return self.effect, self.joint

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters that the columns belong to."""
        return self.part or self.every

    @property
    def definition(self) -> type[Definition]:
        """The effect itself: everything that the diagnosis asks of it is one of its traits."""
        return CATALOGUE[self.effect]

    @property
    def every(self) -> tuple[str, ...]:
        """Parameters that are estimated where all are asked for."""
        return self.definition.estimated()

    @property
    def positive(self) -> tuple[bool, ...]:
        """Flags of columns whose parameter may not be negative."""
        bounds = {p.name: p.bounds for p in self.definition.accepted()}
        return tuple(name in bounds and bounds[name][0] >= 0.0 for name in self.names)

    @property
    def passing(self) -> bool:
        """Whether what it does does not repeat with the periods."""
        return self.definition.presence is Presence.FADING

    @property
    def elastic(self) -> bool:
        """Whether a link swings behind its drive, which is simulated whole."""
        return self.definition.family is Family.ELASTIC

    @property
    def curved(self) -> bool:
        """Whether its columns are slopes, which belong to values."""
        return not self.definition.linear and not self.elastic

    @property
    def coming(self) -> bool:
        """Whether it may be in some of the records and not in others."""
        return self.definition.presence is Presence.SOME

    def joints(self, n: int) -> list[int]:
        """Coordinates (from 0) that it is judged by."""
        return self.definition.judged_at(self.joint, self.fixed, n)


def candidates(equations: Equations) -> list[Candidate]:
    """Everything of the catalogue that can stand somewhere on the arm and is not there yet."""
    found: list[Candidate] = []
    arm, rows = equations.arm, equations.rows
    free = all(r.prepared.input is None for r in rows)
    for name, effect in CATALOGUE.items():
        if effect.presence is Presence.SOME and len(rows) < 2:
            continue
        if free and effect.needs_effort:
            continue
        if effect.presence is Presence.FADING and not cold(equations):
            continue
        there = [joint for joint in places(arm, name) if _seen(effect, joint, rows)]
        if free and effect.needs_drive:
            there = [joint for joint in there if joint is None or joint_of(arm, joint).drive.driven]
        for joint in there:
            forms = [
                (fixed, part, absent)
                for fixed in _fixed(effect, joint, equations)
                for part in effect.subsets(arm, joint)
                for absent in without(effect, len(rows))
            ]
            for fixed, part, absent in forms:
                searched = tuple(p for p in effect.searched() if p.name not in fixed)
                found.append(Candidate(name, joint, fixed, searched, part, len(forms), len(there), absent))
    return found


def without(effect: type[Definition], count: int) -> list[frozenset[int]]:
    """Records (from 0) of `count` that are without an effect, by form; none where it is in all.

    It comes once, between two of them. Where it goes instead, what the first ones have is what the others
    have less of.
    """
    if effect.presence is not Presence.SOME:
        return [frozenset()]
    return [frozenset(range(k)) for k in range(1, count)]


def _seen(effect: type[Definition], joint: int | None, rows: Sequence[Rows]) -> bool:
    """Whether it is known which was measured, link or drive, where the effect lies between the two."""
    if effect.family is not Family.ELASTIC:
        return True
    if at_motor(joint, rows):
        return bool(effect.sought(behind_link=False))
    return at_links(joint, rows) and bool(effect.sought(behind_link=True))


def cold(equations: Equations) -> bool:
    """Whether all records begin where their logs do, or where another record ends: not with a part of a log
    that was warmed before.
    """
    latest = equations.thresholds.candidates.max_log_begin
    every = [r.prepared for r in equations.rows]
    return all(p.before is not None or parse(p.record.name).begin < latest for p in every)


def at_motor(joint: int | None, rows: Sequence[Rows]) -> bool:
    """Whether the joint's position was measured at its motor in all records."""
    return joint is not None and all(r.motion.motor_side[joint - 1] for r in rows)


def at_links(joint: int | None, rows: Sequence[Rows]) -> bool:
    """Whether the joint has a drive, and its position was measured at the link in all records."""
    if joint is None or any(r.motion.motor_side[joint - 1] for r in rows):
        return False
    arm = rows[0].prepared.record.arm
    return arm is None or drives_of(arm)[joint - 1].driven


def search_of(candidate: Candidate, rows: Sequence[Rows]) -> tuple[Parameter, ...]:
    """All that is searched for, with the values to begin at."""
    return candidate.definition.sought(at_links(candidate.joint, rows))


def first_values(candidate: Candidate, equations: Equations) -> Values | None:
    """A value of everything that is searched for, in the middle of its grid; None where it has no size."""
    known = candidate.fixed
    found = {
        p.name: grid_unit(p.scale, candidate.effect, candidate.joint, equations) * p.grid[len(p.grid) // 2]
        for p in search_of(candidate, equations.rows)
        if p.name not in known
    }
    return found if all(value > 0 for value in found.values()) else None


def richer_instead(candidate: Candidate, equations: Equations) -> list[Candidate]:
    """Laws that come to that of an elastic joint at a limit, play for one, behind a link's own position."""
    if not candidate.elastic or not at_links(candidate.joint, equations.rows):
        return []
    return [
        Candidate(name, candidate.joint, fixed, places=candidate.places)
        for name, effect in CATALOGUE.items()
        if effect.simpler is candidate.definition and effect.sought(behind_link=True)
        for fixed in _fixed(effect, candidate.joint, equations)
    ]


def _fixed(effect: type[Definition], joint: int | None, equations: Equations) -> list[dict[str, float]]:
    """Values that are not searched for, by form: what a grid of one value says, and the effect's own."""
    alone = [p for p in effect.nonlinear if len(p.grid) == 1]
    if effect.family is Family.ELASTIC and at_links(joint, equations.rows):
        kept = {p.name for p in effect.sought(behind_link=True)}
        alone += [p for p in effect.sought(behind_link=False) if p.name not in kept]
    taken = {p.name: p.grid[0] * grid_unit(p.scale, effect.name, joint, equations) for p in alone}
    return [{**taken, **form} for form in effect.variants(equations.arm, joint)]


def grid_unit(kind: str, name: str, joint: int | None, equations: Equations) -> float:
    """Unit of a grid, over all records."""
    rows = equations.rows
    if kind == "1":
        return 1.0
    if kind == "time":
        return max(float(r.prepared.time[-1] - r.prepared.time[0]) for r in rows)
    assert joint is not None
    j = joint - 1
    side = CATALOGUE[name].side
    position = [(r.prepared.motor if side == "motor" else r.prepared.q)[:, j] for r in rows]
    speed = [(r.prepared.dmotor if side == "motor" else r.prepared.dq)[:, j] for r in rows]
    span = max(float(np.ptp(x)) for x in position)
    if kind == "span":
        return span
    if kind == "speed":
        return float(np.quantile(np.abs(np.concatenate(speed)), 0.95))
    drive = drives_of(equations.arm)[j]
    efforts = [
        np.abs(drive.gain(r.prepared.q[:, j]) * (0 if r.prepared.input is None else r.prepared.input[:, j]))
        for r in rows
    ]
    return float(np.quantile(np.concatenate(efforts), 0.95)) / max(span, 1e-12)


def at_ends(candidate: Candidate, values: Values, equations: Equations) -> set[str]:
    """Names of the values that are at an end of their search: beyond it they were not looked for."""
    found = set()
    for p in candidate.searched:
        if p.name not in values or len(p.grid) < 2 or p.turns:
            continue
        unit = grid_unit(p.scale, candidate.effect, candidate.joint, equations)
        ends = (min(map(abs, p.grid)), max(map(abs, p.grid)))
        if any(abs(math.log(abs(values[p.name]) / (unit * end))) < NEAR for end in ends):
            found.add(p.name)
    return found


def without_rests(equations: Equations, candidate: Candidate, values: Values) -> Equations:
    """Equations of the rows at which a chosen cause moves; of all where it has no rest of its own.

    values: of all its parameters.
    """
    pair = candidate.definition.coupled(values)
    if pair is None or candidate.joint is None:
        return equations
    rows = equations.rows
    where = [turning(r.prepared, candidate.joint, *pair) for r in rows]
    return equations.with_rows(
        [replace(r, moving=r.moving & flags) for r, flags in zip(rows, where, strict=True)]
    )
