"""Rivals in the place of causes: which of them explain the most once all values are found anew.

A step compares candidates with what was found until then. Columns that follow no line have since moved, and
the arm's parameters with them; beside the causes of later steps another one of those that were alike may be
ahead.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from modelgen.diagnosis.candidates import place_penalty
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.selection.cause import Cause, together
from modelgen.diagnosis.selection.compliance import alternatives
from modelgen.diagnosis.selection.refit import refit


def exchanged(causes: Sequence[Cause], equations: Equations) -> list[Cause] | None:
    """The causes, each replaced by the rival with which all of them together have the best odds; None where
    nothing is replaced.

    Who is replaced becomes the rival.
    """
    if not any(cause.rivals for cause in causes):
        return None
    bare = System(equations)
    better: list[Cause] | None = None
    most = worth_of(causes, bare)
    for place, cause in enumerate(causes):
        best = better or causes
        held = best[place].trial
        for trial, _ in cause.rivals:
            best = better or causes
            others = [c.trial.candidate.place for c in best if c is not best[place]]
            if trial.candidate.place in others:
                continue
            if alternatives(trial.candidate, held.candidate):  # chosen by what they carry as well
                continue
            tried = [replace(c) for c in best]
            tried[place].trial = trial
            refit(tried, equations)
            found = worth_of(tried, bare)
            if found > most:
                rivals = [(t, behind) for t, behind in cause.rivals if t is not trial]
                less = found - most + place_penalty(trial.candidate) - place_penalty(held.candidate)
                tried[place].rivals, tried[place].lesser = [(held, max(0.0, less)), *rivals], []
                better, most = tried, found
    return better


def worth_of(causes: Sequence[Cause], bare: System) -> float:
    """Evidence of the causes together, less what speaks against their values and places beforehand."""
    charged = sum(c.trial.prior_penalty + place_penalty(c.trial.candidate) for c in causes)
    return together([c.trial for c in causes], bare) - charged
