"""Everything that a user can choose about a diagnosis, its thresholds included."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds import USUAL, Thresholds
from modelgen.jobs import HERE, Where

__all__ = ["Options", "Thresholds"]


@dataclass(frozen=True)
class Options:
    """Options of a diagnosis.

    Parameters
    ----------
    cutoff : float, optional
        Cut-off of effort and regressor [Hz]; None: as wide as the encoders allow.
    period : float, optional
        Period of the excitation [s]; None: found in the records.
    effects : tuple of (str, int or None)
        Effects to ask for alone, each with a joint from 1 or None for any place; all where there are none.
    experiment : bool
        Whether to look for what would separate causes that stand for each other.
    thresholds : Thresholds
        They decide what is named, refused, counted and weighed.
    where : Where
        Processes among which the candidates are shared; the answer is the same.
    """

    cutoff: float | None = None
    period: float | None = None
    effects: tuple[tuple[str, int | None], ...] = ()
    experiment: bool = True
    thresholds: Thresholds = USUAL
    where: Where = HERE
