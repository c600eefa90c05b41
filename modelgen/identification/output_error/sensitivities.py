"""A simulated motion with its derivatives by its initial state and by parameters, through stick and slip."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import casadi as ca
import numpy as np
from scipy.optimize import brentq

from modelgen.backends.casadi.function import casadi_function
from modelgen.numeric import Array
from modelgen.simulation.friction_set import Modes, accelerated, hold, settled
from modelgen.simulation.plant import Plant

_EVENTS = 50  # of one step: more is no motion


class Sensitive:
    """Classical Runge-Kutta steps whose exact Jacobians CasADi derives.

    Where a contact comes to rest or turns, at a time that depends on the parameters, the derivatives jump
    by (f+ - f-) (dv/dz) / a- (saltation; Leine and Nijmeijer 2004, section 7.1), f the equations before
    and after, v the contact's velocity, a- its acceleration before. free: indices of the parameters.
    """

    def __init__(self, plant: Plant, free: Sequence[int]) -> None:
        self.plant, self.free = plant, list(free)
        self.rows = plant.slip.contacts
        self._accelerations = casadi_function(plant.slip.accelerations)
        self._step = lru_cache(maxsize=256)(self._made)
        n, c = plant.n, len(self.rows)
        y, p, u, t = self._symbols()
        out = self._called(y, p, u, t)
        self._terms = ca.Function("terms", [y, p, u, t], [out[:n], ca.reshape(out[n:], c, n).T])

    def run(self, y0: Array, times: Array, inputs: Array, p: Array) -> tuple[Array, Array]:
        """States (K, 2n) at `times` (K,) and their derivatives (K, 2n, 2n + f) by initial state, parameters.

        inputs: (K, n), held over the interval that follows. NaN from where the state is not finite.
        """
        path, slopes, _ = self._run(y0, times, inputs, p, False)
        return path, slopes

    def disturbed(self, y0: Array, times: Array, inputs: Array, p: Array) -> Array:
        """Derivatives (K - 1, 2n, 2n + n) of the state at the end of each interval by that at its begin, and
        by the input (n,) held over it. As of `run`.
        """
        return self._run(y0, times, inputs, p, True)[2]

    def _run(
        self, y0: Array, times: Array, inputs: Array, p: Array, disturbed: bool
    ) -> tuple[Array, Array, Array]:
        """As of `run` and, where it is asked for, of `disturbed`."""
        n, m, wide = self.plant.n, 2 * self.plant.n, 2 * self.plant.n + len(self.free)
        begin = np.hstack([np.eye(m), np.zeros((m, n))])[:, : 3 * n if disturbed else 0]
        y, s = y0.copy(), np.hstack([np.eye(m), np.zeros((m, len(self.free))), begin])
        path, slopes = np.full((len(times), m), np.nan), np.full((len(times), m, wide), np.nan)
        steps = np.tile(begin, (len(times) - 1, 1, 1))
        path[0], slopes[0] = y, s[:, :wide]
        modes: Modes = tuple(int(x) for x in np.sign(self.rows @ y[n:]))
        for k in range(len(times) - 1):
            u, t, end = inputs[k], float(times[k]), float(times[k + 1])
            modes = self._settled(y, p, u, t, modes)
            if self._at_rest(modes) and (inputs[k:] == u).all():
                path[k + 1 :], slopes[k + 1 :] = y, s[:, :wide]
                break
            for _ in range(_EVENTS):
                after, jacobian = self._stepped(modes, y, p, u, t, end - t, disturbed)
                if not np.isfinite(after).all():
                    return path, slopes, steps
                margins = self._margins(after, p, u, end, modes)
                over = [c for c, value in enumerate(margins) if value < 0.0]
                if not over:
                    y, s = after, self._chained(jacobian, s)
                    break
                lengths = [self._crossing(c, modes, y, p, u, t, end - t) for c in over]
                first = int(np.argmin(lengths))
                after, jacobian = self._stepped(modes, y, p, u, t, lengths[first], disturbed)
                y, s, t = after, self._chained(jacobian, s), t + lengths[first]
                y, s, modes = self._changed(over[first], y, s, p, u, t, modes)
            for c, own in enumerate(self.plant.own):
                if modes[c] == 0 and own >= 0:
                    y[n + own], s[n + own] = 0.0, 0.0
            path[k + 1], slopes[k + 1], steps[k] = y, s[:, :wide], s[:, wide:]
            s[:, wide:] = begin
        return path, slopes, steps

    def _at_rest(self, modes: Modes) -> bool:
        """Every coordinate sticks by itself."""
        return (
            len({own for m, own in zip(modes, self.plant.own, strict=True) if m == 0} - {-1}) == self.plant.n
        )

    def _changed(
        self, c: int, y: Array, s: Array, p: Array, u: Array, t: float, modes: Modes
    ) -> tuple[Array, Array, Modes]:
        """State, derivatives and modes after contact c has come to rest or torn loose."""
        n, own, now = self.plant.n, self.plant.own[c], list(modes)
        before = self._acceleration(y, p, u, t, modes)
        if modes[c] == 0:
            # it tears loose with no acceleration yet: nothing jumps
            free, dry = self._at(y, p, u, t)
            now[c] = 1 if hold(free, dry, self.rows, modes)[c] > 0 else -1
            return y, s, self._settled(y, p, u, t, tuple(now))
        now[c] = 0
        if own >= 0:
            y[n + own] = 0.0
        found = self._settled(y, p, u, t, tuple(now))
        jump = self._acceleration(y, p, u, t, found) - before
        rate = float(self.rows[c] @ before)
        if rate:
            s[n:] += np.outer(jump, self.rows[c] @ s[n:] / rate)
        return y, s, found

    def _settled(self, y: Array, p: Array, u: Array, t: float, modes: Modes) -> Modes:
        stuck = [k for k, mode in enumerate(modes) if mode == 0]
        return settled(*self._at(y, p, u, t), self.rows, modes, stuck) if stuck else modes

    def _acceleration(self, y: Array, p: Array, u: Array, t: float, modes: Modes) -> Array:
        free, dry = self._at(y, p, u, t)
        return accelerated(free, dry, hold(free, dry, self.rows, modes), modes, self.plant.own)

    def _at(self, y: Array, p: Array, u: Array, t: float) -> tuple[Array, Array]:
        free, dry = self._terms(y, p, u, t)
        return np.asarray(free).ravel(), np.asarray(dry).reshape(self.plant.n, len(self.rows))

    def _margins(self, y: Array, p: Array, u: Array, t: float, modes: Modes) -> list[float]:
        """Margins of every contact, positive while it keeps its mode."""
        v = self.rows @ y[self.plant.n :]
        s = hold(*self._at(y, p, u, t), self.rows, modes) if 0 in modes else v
        return [float(mode * v[c]) if mode else 1.0 - abs(float(s[c])) for c, mode in enumerate(modes)]

    def _crossing(self, c: int, modes: Modes, y: Array, p: Array, u: Array, t: float, h: float) -> float:
        """Length of the step at which contact c changes its mode."""

        def margin(x: float) -> float:
            return self._margins(self._stepped(modes, y, p, u, t, x)[0], p, u, t + x, modes)[c]

        low = 0.0
        if self._margins(y, p, u, t, modes)[c] <= 0.0:  # on the edge yet: find where it has left it
            low = h / 2
            while low > 1e-9 * h and margin(low) < 0.0:
                low /= 2
            if margin(low) <= 0.0:
                return low
        return float(brentq(margin, low, h, xtol=1e-16, rtol=1e-14))

    def _stepped(
        self, modes: Modes, y: Array, p: Array, u: Array, t: float, h: float, disturbed: bool = False
    ) -> tuple[Array, Array]:
        after, jacobian = self._step(modes, disturbed)(y, p, u, t, h)
        return np.asarray(after).ravel(), np.asarray(jacobian)

    def _chained(self, jacobian: Array, s: Array) -> Array:
        m, wide = 2 * self.plant.n, 2 * self.plant.n + len(self.free)
        made = jacobian[:, :m] @ s
        made[:, m:wide] += jacobian[:, m:wide]
        if jacobian.shape[1] > wide:
            made[:, wide + m :] += jacobian[:, wide:]
        return np.asarray(made)

    def _made(self, modes: Modes, disturbed: bool) -> ca.Function:
        """One step: state after it, and its Jacobian by state, free parameters and, where asked, input."""
        n, c = self.plant.n, len(self.rows)
        y, p, u, t = self._symbols()
        h = ca.SX.sym("h")
        stuck = [k for k, mode in enumerate(modes) if mode == 0]

        def rate(y: ca.SX, t: ca.SX) -> ca.SX:
            out = self._called(y, p, u, t)
            free, dry = out[:n], ca.reshape(out[n:], c, n).T
            s = ca.SX([float(mode) for mode in modes])
            if stuck:
                rows = ca.DM(self.rows[stuck])
                s[stuck] = -ca.solve(rows @ dry[:, stuck], rows @ (free + dry @ s))
            ddq = free + dry @ s if c else free
            for k in stuck:
                if self.plant.own[k] >= 0:
                    ddq[self.plant.own[k]] = 0.0
            return ca.vertcat(y[n:], ddq)

        a = rate(y, t)
        b = rate(y + h / 2 * a, t + h / 2)
        d = rate(y + h / 2 * b, t + h / 2)
        e = rate(y + h * d, t + h)
        after = y + h / 6 * (a + 2 * b + 2 * d + e)
        by = ca.vertcat(y, p[self.free], u) if disturbed else ca.vertcat(y, p[self.free])
        jacobian = ca.densify(ca.jacobian(after, by))
        return ca.Function("step", [y, p, u, t, h], [after, jacobian])

    def _symbols(self) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        n, count = self.plant.n, len(self.plant.parameters)
        return ca.SX.sym("y", 2 * n), ca.SX.sym("p", count), ca.SX.sym("u", n), ca.SX.sym("t")

    def _called(self, y: ca.SX, p: ca.SX, u: ca.SX, t: ca.SX) -> ca.SX:
        n, f = self.plant.n, self._accelerations
        known = {"q": y[:n], "dq": y[n:], "input": u, "parameters": p, "time": t}
        names = [(f.name_in(i), f.size1_in(i)) for i in range(f.n_in())]
        return ca.SX(f.call([known.get(name, ca.SX.zeros(size)) for name, size in names])[0])
