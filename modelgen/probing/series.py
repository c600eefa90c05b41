"""States of effects along a motion, sample after sample."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from functools import lru_cache

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
void run(long count, long heads, long states, const double *head, double *state);
void run(long count, long heads, long states, const double *head, double *state)
{
    static casadi_int integers[%d];
    static double numbers[%d];
    for (long k = 0; k < count; k++) {
        const double *given[%d] = {state + k * states, head + k * heads};
        double *found[%d] = {state + (k + 1) * states};
        step(given, found, integers, numbers, 0);
    }
}
"""


class Series:
    """The states of the effects of some equations along a motion.

    What of a step needs no state is evaluated for all samples at once. The rest, a few operations, is
    compiled, or where there is no C compiler run by CasADi's virtual machine. It holds none of the arm's
    figures: one library serves all arms.
    """

    def __init__(self, e: Equations, base: Grouping) -> None:
        heads, self.rest = steps_of(e, base)
        self.heads = NumpyFunction(heads)

    def __call__(self, given: Mapping[str, Array], count: int, ahead: int = 0) -> Array:
        """States (N, s) at `count` samples, from zero `ahead` steps before the first, all like the first.

        given: inputs by name, (N or 1, m).
        """
        found = np.asarray(self.heads(**{a.name: given[a.name] for a in self.heads.function.arguments}))
        head = np.ascontiguousarray(np.broadcast_to(found, (count, self.rest.arguments[1].size)))
        head = np.concatenate([np.repeat(head[:1], ahead, axis=0), head])
        state = np.zeros((len(head) + 1, self.rest.arguments[0].size))
        if compiler() is None:
            state[1:] = _interpreted(self.rest, head)
        else:
            _compiled(self.rest)(head, state)
        return state[ahead:-1]


def _compiled(rest: Function) -> Callable[[Array, Array], None]:
    step = casadi_function(rest)
    made = ca.CodeGenerator("step", {"with_header": False})
    made.add(step)
    # a length of zero is none in C
    sizes = (step.sz_iw() + 1, step.sz_w() + 1, step.sz_arg() + 1, step.sz_res() + 1)
    library = _library(_PRIVATE + made.dump() + _DRIVER % sizes)
    library.run.restype = None

    def run(head: Array, state: Array) -> None:
        counts = (ctypes.c_long(x) for x in (len(head), head.shape[1], state.shape[1]))
        library.run(*counts, ctypes.c_void_p(head.ctypes.data), ctypes.c_void_p(state.ctypes.data))

    return run


@lru_cache(maxsize=64)
def _library(source: str) -> ctypes.CDLL:
    return shared_library({"series.c": source}, "series.c")


def _interpreted(rest: Function, head: Array) -> Array:
    series = casadi_function(rest).mapaccum("series", len(head), {"base": 4})
    return np.array(series(np.zeros(rest.arguments[0].size), head.T)).T
