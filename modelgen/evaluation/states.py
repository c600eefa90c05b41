"""States of effects along a motion, sample after sample."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Protocol

import casadi as ca
import numpy as np

from modelgen.backends.casadi.function import casadi_function
from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping
from modelgen.evaluation.cache import Recent
from modelgen.evaluation.motion import Motion, given_for
from modelgen.evaluation.programs import steps_of
from modelgen.functions.objects import Function
from modelgen.model.equations import Equations
from modelgen.native import compiler, shared_library
from modelgen.numeric import Array

SPANS = np.geomspace(2e-4, 1.0, 13)  # s, of steps towards rest
CYCLES = 6  # of them
LONGEST = 0.05  # rad or m, by one of them: across a gap a long one would leave the lever's range
BEGINNING = 0.1  # s, over which the load tells how fast a transmission is wound at first
CALM = 3.0  # s, in which ringing from the start shows
TOUCH = 1e-4  # rad or m, and their rates
_TABLES = ("t", "q", "dq", "ddq")
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
#ifdef _WIN32
__declspec(dllexport)
#endif
void settle(long count, long heads, long states, const double *head, const double *values, double *state,
            const double *longest);
void settle(long count, long heads, long states, const double *head, const double *values, double *state,
            const double *longest)
{
    static casadi_int integers[%d];
    static double numbers[%d], after[%d];
    for (long k = 0; k < count; k++) {
        const double *given[%d] = {state, head + k * heads, values};
        double *found[%d] = {after};
        step(given, found, integers, numbers, 0);
        for (long i = 0; i < states; i++) {
            const double moved = after[i] - state[i];
            state[i] += moved > longest[i] ? longest[i] : moved < -longest[i] ? -longest[i] : moved;
        }
    }
}
"""


class _Steps(Protocol):
    """run: states (N + 1, s) from the first along heads (N, h). settle: one state (s,), that moves by no more
    than `longest` (s,) at each of them.
    """

    def run(self, head: Array, values: Array, state: Array) -> None: ...

    def settle(self, head: Array, values: Array, state: Array, longest: Array) -> None: ...


class Series:
    """The states of the effects of some equations along a motion.

    What of a step needs neither state nor free values is evaluated for all samples at once. The rest, a few
    operations, is compiled, or where there is no C compiler run by CasADi's virtual machine. It holds none
    of the arm's figures: one library serves all arms.
    """

    def __init__(self, e: Equations, base: Grouping, remembered: int) -> None:
        self._recent: Recent[Array] = Recent(remembered)
        heads, self.rest = steps_of(e, base)
        self.heads = NumpyFunction(heads)
        names = e.state_names()
        pairs = [
            [names.index(symbol.name) for symbol in effect.states.values()]
            for effect in e.effects
            if effect.elastic
        ]
        self.lags, self.rates = [lag for lag, _ in pairs], [rate for _, rate in pairs]

    def head(self, motion: Motion, parameters: Array) -> Array:
        """Values that the steps need of every sample, (N, h); before them, for elastic transmissions, those
        that steps of all `SPANS` need of the first one and of one `BEGINNING` later.
        """
        whole = self._head(given_for(self.heads.function, motion, parameters), len(motion.t))
        if not self.lags:
            return whole
        places = np.tile(self._ends(motion), len(SPANS))
        ends = replace(motion, **{name: getattr(motion, name)[places] for name in _TABLES})
        given = given_for(self.heads.function, ends, parameters)
        spans = np.repeat(SPANS, 2)[:, None]
        return np.concatenate([self._head({**given, "dt": spans}, len(spans)), whole])

    def _ends(self, motion: Motion) -> list[int]:
        return [0, min(max(1, round(BEGINNING / motion.step)), len(motion.t) - 1)]

    def _head(self, given: Mapping[str, Array], count: int) -> Array:
        taken = {a.name: given[a.name] for a in self.heads.function.arguments}
        return np.broadcast_to(np.asarray(self.heads(**taken)), (count, self.rest.arguments[1].size))

    def run(
        self, motion: Motion, free: Sequence[float], parameters: Array, push: Array | None = None
    ) -> Array:
        """States (N + 1, s), from where the motion before and the rest after it left them, else from zero.

        Elastic transmissions begin where their load holds them, and ring in finer steps than the samples'.
        push: (s,), by how much they begin elsewhere.
        """
        finer, count = motion.finer if self.lags else (motion, 1)
        if finer is not motion:
            head = self._recent.along("head", finer, parameters, lambda: self.head(finer, parameters))
            found = self(head, free, finer, push=push)
            return np.concatenate([found[:-1:count], found[-1:]])
        start = None
        if motion.before is not None and not self.lags:
            ended = self.run(motion.before, free, parameters)[-2]
            rest = motion.before.rest_until(float(motion.t[0]))
            start = self(self.head(rest, parameters), free, rest, ended)[1]
        head = self._recent.along("head", motion, parameters, lambda: self.head(motion, parameters))
        return self(head, free, motion, start, push=push)

    def __call__(
        self,
        head: Array,
        free: Sequence[float],
        motion: Motion,
        start: Array | None = None,
        push: Array | None = None,
    ) -> Array:
        """States (N + 1, s) from the first sample to one step after the last one.

        start: (s,) at the first sample, by default zero. Elastic transmissions begin as far behind as their
        load winds them, and as fast: let loose, a soft one would ring for as long as the record. push: added
        to that.
        """
        values, before = np.array([*free, 0.0]), len(head) - len(motion.t)
        state = np.zeros((len(motion.t) + 1, self.rest.arguments[0].size))
        if start is not None:
            state[0] = start
        if self.lags:
            first, second = (self._at_rest(head[k:before:2], values) for k in (0, 1))
            state[0, self.lags] = first
            state[0, self.rates] = (second - first) / (self._ends(motion)[1] * motion.step)
            calm = before + round(CALM / motion.step)
            state[0] = self._calm(np.ascontiguousarray(head[before:calm]), values, state[0])
        if push is not None:
            state[0] += push
        self._steps.run(np.ascontiguousarray(head[before:]), values, state)
        return state

    def _calm(self, head: Array, values: Array, start: Array) -> Array:
        """The start (s,) from which the lags ring least: over the first samples their accelerations change as
        little as other lags and rates at the start can make them. head: (N, h).
        """

        def bends(first: Array) -> Array:
            state = np.zeros((len(head) + 1, len(first)))
            state[0] = first
            self._steps.run(head, values, state)
            return np.diff(state[:, self.lags], 3, axis=0).ravel()

        places, found = [*self.lags, *self.rates], start.copy()
        with np.errstate(over="ignore", invalid="ignore"):  # what holds no link leaves all bounds
            now, moved = bends(start), np.eye(len(start))[places] * TOUCH
            slopes = np.stack([(bends(start + more) - now) / TOUCH for more in moved], axis=1)
            if not np.isfinite(slopes).all() or not np.isfinite(now).all():
                return start
            found[places] -= np.linalg.lstsq(slopes, now, rcond=None)[0]
            return found if np.sum(bends(found) ** 2) < np.sum(now**2) else start

    def _at_rest(self, heads: Array, values: Array) -> Array:
        """Lags at which the transmissions carry their load.

        Steps of all lengths, the speeds taken away after each (dynamic relaxation, Day 1965). An implicit
        step is one of Newton's where it is as long as 1/pi of the period in which the link rings; steps of
        other lengths lead towards rest as well. heads: (D, h), of one sample, the shortest step first.
        """
        state = np.zeros(self.rest.arguments[0].size)
        longest = np.zeros(len(state))
        longest[self.lags] = LONGEST
        self._steps.settle(np.tile(heads[::-1], (CYCLES, 1)), values, state, longest)
        return state[self.lags]

    @cached_property
    def _steps(self) -> _Steps:
        return _Interpreted(self.rest) if compiler() is None else _Compiled(self.rest)


class _Compiled:
    """Steps in compiled C."""

    def __init__(self, rest: Function) -> None:
        step = casadi_function(rest)
        made = ca.CodeGenerator("step", {"with_header": False})
        made.add(step)
        # a length of zero is none in C
        work, calls = (step.sz_iw() + 1, step.sz_w() + 1), (step.sz_arg() + 1, step.sz_res() + 1)
        sizes = (*work, *calls, *work, rest.arguments[0].size + 1, *calls)
        self._library = _library(_PRIVATE + made.dump() + _DRIVER % sizes)
        self._library.run.restype = self._library.settle.restype = None

    def run(self, head: Array, values: Array, state: Array) -> None:
        """Run the steps in compiled code."""
        self._library.run(*_given(head, state, head, values, state))

    def settle(self, head: Array, values: Array, state: Array, longest: Array) -> None:
        """Settle the states in compiled code."""
        self._library.settle(*_given(head, state, head, values, state, longest))


def _given(head: Array, state: Array, *tables: Array) -> list[object]:
    counts = (ctypes.c_long(x) for x in (len(head), head.shape[1], state.shape[-1]))
    return [*counts, *(ctypes.c_void_p(x.ctypes.data) for x in tables)]


@lru_cache(maxsize=64)
def _library(source: str) -> ctypes.CDLL:
    return shared_library({"series.c": source}, "series.c")


class _Interpreted:
    """Steps by CasADi's virtual machine."""

    def __init__(self, rest: Function) -> None:
        self._step, self._free = casadi_function(rest), rest.arguments[2].size

    def run(self, head: Array, values: Array, state: Array) -> None:
        """Run the steps one by one."""
        series = self._step.mapaccum("series", len(head), {"base": 4})
        free = np.tile(values[: self._free, None], (1, len(head)))
        state[1:] = np.array(series(state[0], head.T, free)).T

    def settle(self, head: Array, values: Array, state: Array, longest: Array) -> None:
        """Settle the states one step at a time."""
        for row in head:
            after = np.array(self._step(state, row, values[: self._free])).ravel()
            state += np.clip(after - state, -longest, longest)
