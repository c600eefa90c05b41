"""States of effects along a motion, sample after sample."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np

from modelgen.backends.casadi_function import casadi_function
from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping
from modelgen.compiled import compiler, shared_library
from modelgen.functions.objects import Function
from modelgen.model.equations import Equations
from modelgen.probing.motion import Array
from modelgen.probing.programs import steps_of

# A library of the process may have a function of that name: glibc has a step().
_PRIVATE = "#define CASADI_SYMBOL_EXPORT static\n"
_DRIVER = """
#ifdef _WIN32
__declspec(dllexport)
#endif
void run(long count, long heads, long states, const double *head, const double *values, double *state);
void run(long count, long heads, long states, const double *head, const double *values, double *state)
{
    static casadi_int integers[%d];
    static double numbers[%d];
    for (long k = 0; k < count; k++) {
        const double *given[%d] = {state + k * states, head + k * heads, values};
        double *found[%d] = {state + (k + 1) * states};
        step(given, found, integers, numbers, 0);
    }
}
"""


class Series:
    """The states of the effects of some equations along a motion.

    What of a step needs neither state nor free values is evaluated for all samples at once. The rest, a few
    operations, is compiled, or where there is no C compiler run by CasADi's virtual machine. It holds none
    of the arm's figures: one library serves all arms.
    """

    def __init__(self, e: Equations, base: Grouping) -> None:
        heads, self.rest = steps_of(e, base)
        self.heads = NumpyFunction(heads)

    @property
    def arguments(self) -> list[str]:
        """Names of the inputs of `head`."""
        return [a.name for a in self.heads.function.arguments]

    def head(self, given: Mapping[str, Array], count: int, ahead: int = 0) -> Array:
        """What the steps need of every sample, (ahead + N, h), the first ones like the motion's first.

        given: inputs by name, (N or 1, m).
        """
        found = np.asarray(self.heads(**{name: given[name] for name in self.arguments}))
        whole = np.broadcast_to(found, (count, self.rest.arguments[1].size))
        return np.concatenate([np.repeat(whole[:1], ahead, axis=0), whole])

    def __call__(self, head: Array, free: Sequence[float], ahead: int = 0) -> Array:
        """States (N, s) from zero `ahead` steps before the first sample."""
        state = np.zeros((len(head) + 1, self.rest.arguments[0].size))
        self._run(head, np.array([*free, 0.0]), state)
        return state[ahead:-1]

    @cached_property
    def _run(self) -> Callable[[Array, Array, Array], None]:
        return _interpreted(self.rest) if compiler() is None else _compiled(self.rest)


def _compiled(rest: Function) -> Callable[[Array, Array, Array], None]:
    step = casadi_function(rest)
    made = ca.CodeGenerator("step", {"with_header": False})
    made.add(step)
    # a length of zero is none in C
    sizes = (step.sz_iw() + 1, step.sz_w() + 1, step.sz_arg() + 1, step.sz_res() + 1)
    library = _library(_PRIVATE + made.dump() + _DRIVER % sizes)
    library.run.restype = None

    def run(head: Array, free: Array, state: Array) -> None:
        counts = (ctypes.c_long(x) for x in (len(head), head.shape[1], state.shape[1]))
        library.run(*counts, *(ctypes.c_void_p(x.ctypes.data) for x in (head, free, state)))

    return run


@lru_cache(maxsize=64)
def _library(source: str) -> ctypes.CDLL:
    return shared_library({"series.c": source}, "series.c")


def _interpreted(rest: Function) -> Callable[[Array, Array, Array], None]:
    step = casadi_function(rest)

    def run(head: Array, free: Array, state: Array) -> None:
        series = step.mapaccum("series", len(head), {"base": 4})
        values = np.tile(free[: rest.arguments[2].size, None], (1, len(head)))
        state[1:] = np.array(series(state[0], head.T, values)).T

    return run
