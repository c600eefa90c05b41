"""Functions that watch an arm while it moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from modelgen.functions.assembly import Assembly
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.momentum_observer import momentum_observer
from modelgen.functions.monitor import monitor, monitored_parameters
from modelgen.functions.objects import Function


def watch_functions(
    a: Assembly,
    dynamics: Mapping[str, Dynamics],
    given: Mapping[str, Sequence[str]],
    folded: Mapping[str, Mapping[str, float]],
) -> list[Function]:
    """For every way of giving parameters, by suffix: the dynamics, the inputs that are parameters, and values
    by name where they are folded in.

    Raises InputError for a name in the arm's `monitor` that does not exist.
    """
    names = monitored_parameters(a)
    found = []
    for suffix, own in dynamics.items():
        found.append(momentum_observer(a, own, suffix, given[suffix]))
        if names:
            values = folded.get(suffix)
            general = own if values is None else dynamics[""]
            found.append(monitor(a, own, general, names, suffix, values))
    return found
