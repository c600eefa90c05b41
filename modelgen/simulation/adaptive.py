"""Steps of variable length, ended where a joint comes to rest or tears loose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

from modelgen.backends.casadi.function import casadi_function
from modelgen.numeric import Array
from modelgen.simulation.friction_set import Modes, accelerated, hold, settled
from modelgen.simulation.plant import Plant

METHODS = ("DOP853", "RK45", "LSODA", "Radau", "BDF")
LEFT = -1  # the event of a coordinate that leaves its range
BENT = -2  # that of a law that bends: play that closes or opens
_EVENTS = 10_000  # of one interval: more is no motion
# Evaluations, and the time [s] that they must cover: what is slower comes to no end.
_STRETCH, _COVERED = 5000, 5e-5


@dataclass(frozen=True)
class Phase:
    """States (k, 2n + z) at the samples reached, and where it ended: contact `event`, LEFT or None."""

    path: Array
    t: float
    y: Array
    event: int | None


class Adaptive:
    """An integrator of scipy over the smooth phases of an arm with dry friction.

    States y = (q, dq, states of effects). The right-hand side is CasADi's, not the compiled one.
    """

    def __init__(self, plant: Plant, method: str, rtol: float, atol: float) -> None:
        self.plant, self.method, self.rtol, self.atol = plant, method, rtol, atol
        own = plant.slip
        self._accelerations = casadi_function(own.accelerations)
        self._rates = casadi_function(own.rates) if own.rates else None
        self._kinks = casadi_function(own.kinks) if own.kinks else None
        self._names = [a.name for a in own.accelerations.arguments]
        self._zeros = {a.name: np.zeros(a.size) for a in own.accelerations.arguments}
        self.rows = own.contacts

    @cached_property
    def _own(self) -> list[int]:
        return self.plant.own

    def terms(self, t: float, y: Array, u: Array) -> tuple[Array, Array]:
        """free (n,) and dry (n, c) at a state."""
        n, c = self.plant.n, len(self.rows)
        out = self._call(self._accelerations, t, y, np.zeros(n), u)
        return out[:n], out[n:].reshape(n, c)

    def rate(self, t: float, y: Array, u: Array, modes: Modes) -> Array:
        """dy/dt while nothing changes its mode."""
        n = self.plant.n
        free, dry = self.terms(t, y, u)
        ddq = accelerated(free, dry, hold(free, dry, self.rows, modes), modes, self._own)
        if not np.isfinite(ddq).all():
            raise FloatingPointError("its state is not finite")
        drift = self._call(self._rates, t, y, ddq, u) if self._rates else np.zeros(0)
        return np.concatenate([y[n : 2 * n], ddq, drift])

    def begin(self, t: float, y: Array, u: Array) -> Modes:
        """Modes at a state: of contacts at rest what the forces make of them."""
        v = self.rows @ y[self.plant.n : 2 * self.plant.n]
        modes = tuple(int(x) for x in np.sign(v))
        return settled(*self.terms(t, y, u), self.rows, modes, [k for k, m in enumerate(modes) if m == 0])

    def again(self, t: float, y: Array, u: Array, modes: Modes) -> Modes:
        """Modes after a jump of the input: what sticks may tear loose."""
        stuck = [k for k, mode in enumerate(modes) if mode == 0]
        return settled(*self.terms(t, y, u), self.rows, modes, stuck) if stuck else modes

    def run(
        self, times: Sequence[float], y: Array, u: Array, modes: Modes, low: Array, high: Array
    ) -> tuple[Array, Modes, str, float]:
        """States at `times` (the first is where `y` holds), modes at the end, why it ended early and when.

        Constant input. The reason is empty where all is well, and "left" at the edge of low..high.
        """
        t, end = times[0], times[-1]
        wanted = np.asarray(times)
        path = np.empty((len(wanted), len(y)))
        path[0] = y
        filled = 1
        for _ in range(_EVENTS):
            try:
                found = self._phase(t, end, y, u, modes, wanted[filled:], low, high)
            except (FloatingPointError, RuntimeError) as error:
                return path[:filled], modes, str(error), t
            path[filled : filled + len(found.path)] = found.path
            filled += len(found.path)
            if found.event is None:
                return path, modes, "", end
            t, y = found.t, found.y
            if found.event == LEFT:
                return path[:filled], modes, "left", t
            if found.event == BENT:
                continue
            modes, y = self._changed(t, y, u, modes, found.event)
            if filled == len(wanted):
                return path, modes, "", end
        return path[:filled], modes, "dry friction changes its direction without end", t

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
        """Integrate from t until a contact changes its mode, a coordinate leaves its range, or to the end."""
        events: list[Callable[[float, Array], float]] = [
            self._margin(k, t, u, modes) for k in range(len(modes))
        ]
        bends = 0 if self._kinks is None else self._kinks.size1_out(0)
        events += [self._bend(k, t, y, u, modes) for k in range(bends)]
        if np.isfinite(low).any() or np.isfinite(high).any():
            events.append(_Left(self.plant.n, low, high))
        watched = _Watched(lambda at, x: self.rate(at, x, u, modes), t)
        found = solve_ivp(
            watched,
            (t, end),
            y,
            method=self.method,
            rtol=self.rtol,
            atol=self.atol,
            events=events or None,
            t_eval=times,
        )
        if found.status < 0:
            raise RuntimeError(f"the integrator gave up: {found.message}")
        path = found.y.T if len(found.t) else np.empty((0, len(y)))
        if found.status == 0:
            return Phase(path, end, path[-1], None)
        which = next(k for k, at in enumerate(found.t_events) if len(at))
        at, state = float(found.t_events[which][0]), np.array(found.y_events[which][0])
        if which >= len(modes):
            return Phase(path, at, state, BENT if which < len(modes) + bends else LEFT)
        return Phase(path, at, state, which)

    def _changed(self, t: float, y: Array, u: Array, modes: Modes, which: int) -> tuple[Modes, Array]:
        """Modes and state after contact `which` has come to rest or torn loose."""
        now = list(modes)
        free, dry = self.terms(t, y, u)
        if modes[which] == 0:
            now[which] = 1 if hold(free, dry, self.rows, modes)[which] > 0 else -1
        else:
            now[which] = 0
            if self._own[which] >= 0:
                y[self.plant.n + self._own[which]] = 0.0
            free, dry = self.terms(t, y, u)
        stuck = [k for k, mode in enumerate(now) if mode == 0]
        return settled(free, dry, self.rows, tuple(now), stuck), y

    def _margin(self, k: int, begin: float, u: Array, modes: Modes) -> Callable[[float, Array], float]:
        """Positive while contact k keeps its mode; at the beginning it is on its edge, which is no event."""
        n, row = self.plant.n, self.rows[k]

        def margin(t: float, y: Array) -> float:
            if modes[k]:
                value = float(modes[k] * (row @ y[n : 2 * n]))
            else:
                value = float(1.0 - abs(hold(*self.terms(t, y, u), self.rows, modes)[k]))
            return value if t > begin else max(value, 1e-300)

        margin.terminal = True  # type: ignore[attr-defined]
        margin.direction = -1.0  # type: ignore[attr-defined]
        return margin

    def _bend(
        self, k: int, begin: float, y: Array, u: Array, modes: Modes
    ) -> Callable[[float, Array], float]:
        """Zero where law k bends; a phase that begins there goes the way that its rate says."""
        zero, kinks = np.zeros(self.plant.n), self._kinks
        assert kinks is not None

        def value(t: float, y: Array) -> float:
            return float(self._call(kinks, t, y, zero, u)[k])

        side = value(begin, y)
        if abs(side) < 1e-12:
            step = 1e-9
            side = value(begin, y + step * self.rate(begin, y, u, modes)) - side

        def bend(t: float, y: Array) -> float:
            now = value(t, y)
            return now if t > begin else float(np.sign(side)) * max(abs(now), 1e-300)

        bend.terminal = True  # type: ignore[attr-defined]
        return bend

    def _call(self, function: ca.Function, t: float, y: Array, ddq: Array, u: Array) -> Array:
        n = self.plant.n
        given = self._zeros | {
            "q": y[:n],
            "dq": y[n : 2 * n],
            "ddq": ddq,
            "input": u,
            "parameters": self.plant.parameters,
            "time": np.array([t]),
            "state": y[2 * n :],
        }
        names = [function.name_in(i) for i in range(function.n_in())]
        return np.asarray(function(*(given.get(name, np.zeros(1)) for name in names)), dtype=float).ravel()


class _Watched:
    """A rate that ends an integration whose steps become too short to come to an end."""

    def __init__(self, rate: Callable[[float, Array], Array], begin: float) -> None:
        self._rate, self._since, self._count = rate, begin, 0

    def __call__(self, t: float, y: Array) -> Array:
        self._count += 1
        if self._count % _STRETCH == 0:
            if t - self._since < _COVERED:
                raise RuntimeError(
                    f"{_STRETCH} evaluations covered {max(t - self._since, 0.0):.2g} s: its speeds grow "
                    "without bound, or the method is not one for stiff arms"
                )
            self._since = t
        return self._rate(t, y)


class _Left:
    """Distance from the nearest bound; it ends the integration at zero."""

    terminal = True
    direction = -1.0

    def __init__(self, n: int, low: Array, high: Array) -> None:
        self.n, self.low, self.high = n, low, high

    def __call__(self, t: float, y: Array) -> float:
        q = y[: self.n]
        return float(min((q - self.low).min(), (self.high - q).min()))
