"""States within the limits, over which a law of a file is held against that of the effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.dataset import drives_of
from modelgen.description.objects import Arm
from modelgen.effects import AppliedEffect
from modelgen.exporting.build import range_of
from modelgen.exporting.machine import Axis
from modelgen.functions import Model
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.parametric import standard_values
from modelgen.model.equations import Equations
from modelgen.numeric import Array

SAMPLES = 256
SPEED = 1.0  # rad/s, m/s, of a joint whose speed has no limit
RISE = 0.25  # s, in which a joint without a limit of its acceleration reaches its highest speed
LONG = 1e4  # s, after which states have settled
NOISE = 1e-12  # of arithmetic, relative to the largest effort


@dataclass(frozen=True)
class Signal:
    """A coordinate over N samples: itself, its derivatives, and its slope by the joint's coordinate (N,)."""

    position: Array
    velocity: Array
    acceleration: Array
    slope: Array


class States:
    """N states of n joints, the same at every call: q, dq, ddq (N, n)."""

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        self.drives = drives_of(arm)
        ranges = np.array([range_of(arm, i) for i in arm.coordinates])
        draw = np.random.default_rng(1).uniform(size=(3, SAMPLES, len(ranges)))
        self.q = ranges[:, 0] + draw[0] * (ranges[:, 1] - ranges[:, 0])
        speed = np.array([self._fastest(n) for n in range(len(ranges))]).T
        self.dq = (2 * draw[1] - 1) * speed
        joints = [arm.joints[i] for i in arm.coordinates]
        given = [joint.limits.acceleration for joint in joints]
        most = np.array([np.nan if a is None else a for a in given])
        self.ddq = (2 * draw[2] - 1) * np.where(np.isnan(most), speed / RISE, most)

    def efforts(self, model: Model, parameters: Array) -> Array:
        """Efforts (N, n) at the joints with these base parameters, states of effects at zero."""
        function = model.function("inverse_dynamics")
        given = {"q": self.q, "dq": self.dq, "ddq": self.ddq, "parameters": parameters}
        named = {a.name: given.get(a.name, np.zeros(a.size)) for a in function.arguments}
        gains = np.array([drive.gain(self.q[:, n]) for n, drive in enumerate(self.drives)])
        found: Array = np.asarray(NumpyFunction(function)(**named)) * gains.T
        return found

    def _fastest(self, n: int) -> Array:
        """Highest speed of a joint in every state (N,)."""
        joint = self.arm.joints[self.arm.coordinates[n]]
        own, motor = joint.limits.velocity, joint.drive.limits.velocity
        found = np.full(SAMPLES, np.inf if own is None else own)
        if motor is not None:
            found = np.minimum(found, motor / np.abs(self.drives[n].k1(self.q[:, n])))
        return np.where(np.isfinite(found), found, SPEED)

    def joint(self, n: int) -> Signal:
        """The coordinate of joint n."""
        return Signal(self.q[:, n], self.dq[:, n], self.ddq[:, n], np.ones(SAMPLES))

    def motor(self, n: int) -> Signal:
        """The coordinate of its motor."""
        drive, q, dq, ddq = self.drives[n], self.q[:, n], self.dq[:, n], self.ddq[:, n]
        k1 = drive.k1(q)
        return Signal(drive.motor(q), k1 * dq, k1 * ddq + drive.slope(q) * dq**2, k1)

    def carried(self, axis: Axis, levers: bool) -> Signal:
        """What a file has for the motor's coordinate: itself, or one that turns with the joint."""
        if axis.lever is not None and levers:
            return self.motor(axis.number)
        own, k = self.joint(axis.number), axis.ratio
        place = axis.middle[1] + k * (own.position - axis.middle[0])
        return Signal(place, k * own.velocity, k * own.acceleration, k * own.slope)

    def pair(self, n: int, other: int, ratio: float) -> Signal:
        """The coordinate q_n + ratio q_other; its slope by q_n."""
        x, v, a = (y[:, n] + ratio * y[:, other] for y in (self.q, self.dq, self.ddq))
        return Signal(x, v, a, np.ones(SAMPLES))


def force(signal: Signal, properties: Mapping[str, float]) -> Array:
    """Force at the coordinate of these properties (N,), by the laws of `Definition.simulated`."""
    x, v, p = signal.position, signal.velocity, properties
    total = p.get("damping", 0.0) * v + p.get("quadratic", 0.0) * np.abs(v) * v + p.get("cubic", 0.0) * v**3
    total = total + p.get("friction", 0.0) * np.sign(v) + p.get("armature", 0.0) * signal.acceleration
    phase = p.get("wave", 0.0) * x
    total = total + p.get("sine", 0.0) * np.sin(phase) + p.get("cosine", 0.0) * np.cos(phase)
    return np.asarray(total + p.get("stiffness", 0.0) * (x - p.get("rest", 0.0)) + p.get("force", 0.0))


class Efforts:
    """Efforts of effects at the joints, from the arm's own inverse dynamics.

    values: standard parameters by name; zero is used for one that is not there.
    """

    def __init__(self, arm: Arm, states: States, values: Mapping[str, float]) -> None:
        self._states, self._named = states, values
        self._equations = Equations(arm)

    def of(self, effect: AppliedEffect) -> list[Array]:
        """Efforts (N, n) of one effect: with the states of all at zero, and where they settle."""
        names = {symbol.name for _, symbol in effect.parameters}
        kept = [p.name not in names for p in self._equations.standard]
        rest = [self._at(np.where(kept, self._values, 0.0), state) for state in self._held]
        return [whole - other for whole, other in zip(self._whole, rest, strict=True)]

    @property
    def noise(self) -> float:
        """Effort that is arithmetic."""
        return NOISE * largest(self._whole)

    @cached_property
    def _values(self) -> Array:
        return np.array([self._named.get(p.name, 0.0) for p in self._equations.standard])

    @cached_property
    def _dynamics(self) -> Dynamics:
        return Dynamics(self._equations, standard_values(self._equations))

    @cached_property
    def _inputs(self) -> NumpyFunction:
        e = self._equations
        inputs = self._dynamics.inverse_dynamics(e.vector("dq"), e.vector("ddq"))
        return NumpyFunction(bare("inputs", e, len(e.standard), inputs))

    @cached_property
    def _whole(self) -> list[Array]:
        return [self._at(self._values, state) for state in self._held]

    @cached_property
    def _held(self) -> list[Array]:
        """States of the effects (N, s): zero, and where there are any what they settle to."""
        e = self._equations
        names = e.state_names()
        rest: Array = np.zeros((SAMPLES, len(names)))
        if not names:
            return [rest]
        steps = self._dynamics.effects_step(e.vector("dq"), e.vector("ddq"), e.graph.input("dt", 0))
        after = self._call(NumpyFunction(bare("steps", e, len(e.standard), steps)), self._values, rest)
        # how far a link lags does not settle in one step
        elastic = {x.name for effect in e.effects if effect.elastic for x in effect.states.values()}
        return [rest, np.where([name in elastic for name in names], 0.0, after)]

    def _at(self, values: Array, state: Array) -> Array:
        gains = [drive.gain(self._states.q[:, n]) for n, drive in enumerate(self._states.drives)]
        found: Array = self._call(self._inputs, values, state) * np.array(gains).T
        return found

    def _call(self, function: NumpyFunction, values: Array, state: Array) -> Array:
        s = self._states
        given = {
            "q": s.q,
            "dq": s.dq,
            "ddq": s.ddq,
            "parameters": values,
            "state": state,
            "dt": np.array([LONG]),
        }
        # the others are those of other functions
        named = {a.name: given.get(a.name, np.zeros(a.size)) for a in function.function.arguments}
        return np.asarray(function(**named))


def largest(efforts: Sequence[Array]) -> float:
    """Of all of them."""
    return max((float(np.abs(e).max(initial=0.0)) for e in efforts), default=0.0)
