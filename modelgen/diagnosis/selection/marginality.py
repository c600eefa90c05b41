"""What varies is asked for once what it lets vary is in the model (marginality, Nelder 1977).

A friction that fades, or that grows with the load, holds a constant part. Where the description lacks the
constant law, that part alone can give the varying one its evidence; with the constant law in the model the
next turn asks for the variation by itself, and what it has made superfluous leaves in the end.
"""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.diagnosis.candidates import Candidate
from modelgen.diagnosis.selection.compliance import Judged
from modelgen.effects import CATALOGUE


def constant_first(chosen: Judged, eligible: Sequence[Judged]) -> Judged:
    """The chosen one, or the law that it lets vary at its joint. eligible: most evidence first."""
    return next((pair for pair in eligible if varied(chosen[0].candidate, pair[0].candidate)), chosen)


def varied(one: Candidate, other: Candidate) -> bool:
    """Whether the first lets vary what the other is, at the same joint."""
    return lets_vary(one.effect, one.joint, other)


def lets_vary(effect: str, joint: int | None, constant: Candidate) -> bool:
    """Whether an effect of the catalogue at a joint lets vary what this candidate is."""
    return joint == constant.joint and constant.definition in CATALOGUE[effect].varies
