"""Functions that carry a state of their own from one call to the next."""

from __future__ import annotations

from dataclasses import replace

from modelgen.functions.objects import Function
from modelgen.graph.renamed import renamed

STATE = "state"  # of the function itself, as a caller knows it
OF_EFFECTS = "effect_state"  # what other functions call `state`


def stepping(function: Function, own: str) -> Function:
    """The function with its own state, so far the input `own`, called `state`, and that of the effects, where
    it reads one, `effect_state`.
    """
    names = {own: STATE, STATE: OF_EFFECTS}
    arguments = tuple(replace(a, name=names.get(a.name, a.name)) for a in function.arguments)
    return replace(function, arguments=arguments, program=renamed(function.program, names))
