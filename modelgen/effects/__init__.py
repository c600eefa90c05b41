"""Effects: each is one definition in SymPy."""

from modelgen.effects.applied import (
    TIME_STEP,
    AppliedEffect,
    Part,
    applied_effects,
    described,
    free_symbol,
    pivot_direction,
)
from modelgen.effects.base import (
    BodyEffect,
    Definition,
    DescriptionEffect,
    Effect,
    InputEffect,
    LinkEffect,
    Parameter,
    Point,
    Swing,
    Values,
)
from modelgen.effects.catalogue import CATALOGUE, effect_texts, known_effects
from modelgen.effects.traits import Family, Presence, Seen, Shows
from modelgen.effects.variables import BodyVariables, InputVariables, PointVariables, Variables

__all__ = [
    "CATALOGUE",
    "TIME_STEP",
    "AppliedEffect",
    "BodyEffect",
    "BodyVariables",
    "Definition",
    "DescriptionEffect",
    "Effect",
    "Family",
    "InputEffect",
    "InputVariables",
    "LinkEffect",
    "Parameter",
    "Part",
    "Point",
    "PointVariables",
    "Presence",
    "Seen",
    "Shows",
    "Swing",
    "Values",
    "Variables",
    "applied_effects",
    "described",
    "effect_texts",
    "free_symbol",
    "known_effects",
    "pivot_direction",
]
