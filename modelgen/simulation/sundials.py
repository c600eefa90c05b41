"""The smooth phases by CVODES of SUNDIALS, through CasADi."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from modelgen.numeric import Array
from modelgen.simulation.adaptive import LEFT, Adaptive, Phase
from modelgen.simulation.friction_set import Modes, hold
from modelgen.simulation.plant import Plant


class Sundials(Adaptive):
    """Variable order and step with exact Jacobians (Hindmarsh et al. 2005), for stiff effects too.

    From sample to sample; where a contact has changed its mode within one, the change is located.
    """

    def __init__(self, plant: Plant, rtol: float, atol: float) -> None:
        super().__init__(plant, "cvodes", rtol, atol)
        self._integrator = lru_cache(maxsize=64)(self._made)

    def _phase(
        self,
        t: float,
        end: float,
        y: Array,
        u: Array,
        modes: Modes,
        times: Array,
        low: Array,
        high: Array,
    ) -> Phase:
        path = np.empty((len(times), len(y)))
        edge = True  # at its beginning a phase is on the edge of its modes
        for k, at in enumerate(times):
            after = self._step(t, at - t, y, u, modes)
            margins = self._margins(at, after, u, modes, low, high)
            over = [m for m, value in enumerate(margins) if value < 0.0]
            if over:
                before = self._margins(t, y, u, modes, low, high)
                where = [
                    self._crossing(m, t, at - t, y, u, modes, low, high, edge and before[m] <= 1e-12)
                    for m in over
                ]
                first = int(np.argmin(where))
                state = self._step(t, where[first], y, u, modes)
                event = over[first]
                return Phase(path[:k], t + where[first], state, event if event < len(modes) else LEFT)
            path[k] = y = after
            t, edge = float(at), False
        return Phase(path, t, y, None)

    def _crossing(
        self,
        m: int,
        t: float,
        length: float,
        y: Array,
        u: Array,
        modes: Modes,
        low: Array,
        high: Array,
        edge: bool,
    ) -> float:
        """Time after t at which margin m becomes negative, by bisection to rounding."""
        begin, end = 0.0, length
        if edge:  # find where it has become positive first
            begin = length / 2
            while begin > 1e-12 * length and self._at(m, t, begin, y, u, modes, low, high) < 0.0:
                end, begin = begin, begin / 2
        while end - begin > 4e-16 * max(1.0, t + length):
            middle = (begin + end) / 2
            if middle in (begin, end):
                break
            if self._at(m, t, middle, y, u, modes, low, high) < 0.0:
                end = middle
            else:
                begin = middle
        return end

    def _at(
        self, m: int, t: float, h: float, y: Array, u: Array, modes: Modes, low: Array, high: Array
    ) -> float:
        return self._margins(t + h, self._step(t, h, y, u, modes), u, modes, low, high)[m]

    def _margins(self, t: float, y: Array, u: Array, modes: Modes, low: Array, high: Array) -> list[float]:
        """Margins of every contact, then of the range of q, positive while nothing changes."""
        n = self.plant.n
        s = hold(*self.terms(t, y, u), self.rows, modes) if 0 in modes else np.zeros(len(modes))
        found = [
            float(mode * (self.rows[k] @ y[n : 2 * n])) if mode else 1.0 - abs(float(s[k]))
            for k, mode in enumerate(modes)
        ]
        return [*found, float(min((y[:n] - low).min(), (high - y[:n]).min()))]

    def _step(self, t: float, h: float, y: Array, u: Array, modes: Modes) -> Array:
        if h <= 0.0:
            return y
        try:
            found = self._integrator(modes)(x0=y, p=np.concatenate([u, [t, h]]))["xf"]
        except RuntimeError as error:
            raise RuntimeError(f"CVODES gave up: {str(error).splitlines()[-1]}") from None
        after = np.asarray(found, dtype=float).ravel()
        for mode, own in zip(modes, self.plant.own, strict=True):
            if mode == 0 and own >= 0:  # Newton's iteration leaves 1e-26
                after[own], after[self.plant.n + own] = y[own], 0.0
        return after

    def _made(self, modes: Modes) -> ca.Function:
        """The integrator over one unit of scaled time, for one set of modes."""
        n, c, z = self.plant.n, len(modes), len(self.plant.model.states)
        y, p, tau = ca.SX.sym("y", 2 * n + z), ca.SX.sym("p", n + 2), ca.SX.sym("tau")
        t = p[n] + p[n + 1] * tau
        known = {
            "q": y[:n],
            "dq": y[n : 2 * n],
            "input": p[:n],
            "parameters": ca.DM(self.plant.parameters),
            "time": t,
            "state": y[2 * n :],
        }

        def call(function: ca.Function, more: dict[str, ca.SX]) -> ca.SX:
            given = known | more
            values: list[Any] = [
                given.get(function.name_in(i), ca.DM.zeros(function.size1_in(i)))
                for i in range(function.n_in())
            ]
            (result,) = function.call(values)
            return ca.SX(result)

        out = call(self._accelerations, {})
        free, dry = out[:n], ca.reshape(out[n:], c, n).T
        s = ca.SX([float(mode) for mode in modes])
        stuck = [k for k, mode in enumerate(modes) if mode == 0]
        if stuck:
            rows = ca.DM(self.rows[stuck])
            s[stuck] = -ca.solve(rows @ dry[:, stuck], rows @ (free + dry @ s))
        ddq = free + dry @ s if c else free
        for k in stuck:
            if self.plant.own[k] >= 0:
                ddq[self.plant.own[k]] = 0.0
        parts = [y[n : 2 * n], ddq]
        if self._rates is not None:
            parts.append(call(self._rates, {"ddq": ddq}))
        system = {"x": y, "p": p, "t": tau, "ode": p[n + 1] * ca.vertcat(*parts)}
        options = {"reltol": self.rtol, "abstol": self.atol, "max_num_steps": 100_000}
        return ca.integrator("phase", "cvodes", system, 0.0, 1.0, options)
