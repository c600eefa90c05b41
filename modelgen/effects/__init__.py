"""Effects: each is one definition in SymPy."""

from modelgen.effects.base import Effect, Parameter, Variables
from modelgen.effects.catalogue import (
    CATALOGUE,
    TIME_STEP,
    AppliedEffect,
    applied_effects,
    known_effects,
)

__all__ = [
    "CATALOGUE",
    "TIME_STEP",
    "AppliedEffect",
    "Effect",
    "Parameter",
    "Variables",
    "applied_effects",
    "known_effects",
]
