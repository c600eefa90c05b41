"""Which functions are wanted over many states."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from modelgen.errors import InputError, suggest
from modelgen.functions.objects import Function
from modelgen.functions.parametric import SUFFIXES

ALL = "all"


def batch_names(arm: str, asked: Collection[str], functions: Sequence[Function]) -> tuple[str, ...]:
    """Names of the functions that are asked for, one without a suffix for every way of giving parameters.

    Raises InputError for what the arm has not.
    """
    known = [f.name for f in functions]
    plain = list(dict.fromkeys(_plain(name) for name in known))
    for name in sorted(asked):
        if name not in (*known, *plain, ALL):
            listed = ", ".join(plain)
            raise InputError(
                f"--batch: found '{name}'{suggest(name, [*plain, ALL])}; the functions of {arm} are {listed}"
            )
    wanted = set(known) if ALL in asked else {n for n in known if n in asked or _plain(n) in asked}
    return tuple(name for name in known if name in wanted)


def _plain(name: str) -> str:
    """The name without what says how the parameters are given."""
    return next((name.removesuffix(s) for s in SUFFIXES if name.endswith(s)), name)
