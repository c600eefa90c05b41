"""Controllers: functions of t, q, dq that give the input, sampled and held."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from modelgen.backends.casadi.function import casadi_function
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.simulation.plant import Plant


@dataclass(frozen=True)
class Reference:
    """Motion that a controller shall follow: t (S,) [s], q (S, n) [rad, m]; a cubic spline in between."""

    t: Array
    q: Array

    @cached_property
    def _spline(self) -> CubicSpline:
        return CubicSpline(self.t, self.q)

    def at(self, t: float) -> tuple[Array, Array, Array]:
        """q, dq, ddq (n,); at rest where the reference begins or ends before or after it."""
        if not self.t[0] <= t <= self.t[-1]:
            end = self.q[0] if t < self.t[0] else self.q[-1]
            return end, np.zeros(len(end)), np.zeros(len(end))
        s = self._spline
        return s(t), s(t, 1), s(t, 2)


Control = Callable[[float, Array, Array], ArrayLike]


class _Functions:
    """Emitted functions of the plant, called one sample at a time."""

    def __init__(self, plant: Plant, *names: str) -> None:
        found = {f.name: casadi_function(f) for f in plant.model.functions if f.name in names}
        missing = [name for name in names if name not in found]
        if missing:
            raise InputError(f"{plant.arm.name}: has no function {missing[0]}, which the controller needs")
        self._found = found
        self._zeros = {
            a.name: np.zeros(a.size) for f in plant.model.functions if f.name in names for a in f.arguments
        }

    def call(self, name: str, **given: Array) -> list[Array]:
        function = self._found[name]
        values = self._zeros | given
        out = function.call([values[function.name_in(i)] for i in range(function.n_in())])
        return [np.asarray(x, dtype=float).ravel() for x in out]


def current_limits(plant: Plant) -> Array:
    """Largest input (n,): the drive's current, the effort of an undriven joint; infinite where not given."""
    found = np.full(plant.n, np.inf)
    for k, i in enumerate(plant.arm.coordinates):
        joint = plant.arm.joints[i]
        limit = joint.drive.limits.current if joint.drive.driven else joint.limits.effort
        if limit is not None:
            found[k] = limit
    return found


class _Cascade:
    """See `cascade`."""

    def __init__(self, plant: Plant, reference: Reference, bandwidth: float, period: float) -> None:
        self.reference, self.period = reference, period
        self.functions = _Functions(plant, "motor_from_joint", "mass_matrix", "drive_gain")
        self.limit = current_limits(plant)
        q = reference.q[0]
        mass = self.functions.call("mass_matrix", q=q, parameters=plant.base)[0]
        gain = self.functions.call("drive_gain", q=q)[0]
        motor = self.functions.call("motor_from_joint", q=q, dq=np.ones(plant.n))
        # dq_m = k1 dq, and an input u accelerates the motor by k1 K u / M.
        w = 2 * pi * bandwidth
        self.speed = w * np.diag(mass.reshape(plant.n, plant.n)) / (motor[1] * gain)
        self.position, self.integral, self.slow = w / 4, w / 4, w / 40
        self.sum, self.way = np.zeros(plant.n), np.zeros(plant.n)

    def __call__(self, t: float, q: Array, dq: Array) -> Array:
        q_r, dq_r, _ = self.reference.at(t)
        now, wanted = (self.functions.call("motor_from_joint", q=x, dq=v) for x, v in ((q, dq), (q_r, dq_r)))
        behind = wanted[0] - now[0]
        way = self.way + behind * self.period
        error = self.position * (behind + self.slow * way) + wanted[1] - now[1]
        total = self.sum + error * self.period
        whole = self.speed * (error + self.integral * total)
        given = np.clip(whole, -self.limit, self.limit)
        # The integrals stand still where the current is at its limit.
        free = given == whole
        self.sum, self.way = np.where(free, total, self.sum), np.where(free, way, self.way)
        return np.asarray(given)


def cascade(plant: Plant, reference: Reference, bandwidth: float, rate: float) -> _Cascade:
    """Position PI around velocity PI in the motor coordinates, the currents within the drives' limits.

    As on the arm of Leborne, Creuze, Chemori and Brignone (2018). bandwidth: of the velocity loop [Hz], from
    the diagonal of the mass matrix where the reference begins; the position loop has a quarter of it, as
    drive makers tune such cascades (Leonhard 2001, section 15). rate: of the samples [Hz]. The current loop,
    a PI too, counts as ideal: the model has no inductance.
    """
    return _Cascade(plant, reference, bandwidth, 1.0 / rate)


class _ComputedTorque:
    """See `computed_torque`."""

    def __init__(self, plant: Plant, reference: Reference, bandwidth: float, parameters: Array) -> None:
        self.reference, self.parameters = reference, parameters
        self.functions = _Functions(plant, "inverse_dynamics")
        self.limit = current_limits(plant)
        self.w = 2 * pi * bandwidth

    def __call__(self, t: float, q: Array, dq: Array) -> Array:
        q_r, dq_r, ddq_r = self.reference.at(t)
        ddq = ddq_r + 2 * self.w * (dq_r - dq) + self.w**2 * (q_r - q)
        # Friction of the motion that is wanted: that of the measured speed chatters where a joint rests.
        given = self.functions.call(
            "inverse_dynamics", q=q, dq=dq_r, ddq=ddq, parameters=self.parameters, time=np.array([t])
        )[0]
        return np.asarray(np.clip(given, -self.limit, self.limit))


def computed_torque(
    plant: Plant, reference: Reference, bandwidth: float, parameters: Array | None = None
) -> _ComputedTorque:
    """Inverse dynamics of the reference's motion with its errors fed back (Luh, Walker and Paul 1980).

    bandwidth: of the critically damped error [Hz]. parameters: base parameters that the controller
    believes in (p,), by default the plant's own.
    """
    return _ComputedTorque(plant, reference, bandwidth, plant.base if parameters is None else parameters)


def controller(plant: Plant, name: str, reference: Reference, bandwidth: float, rate: float) -> Control:
    """The controller of a name: "pi" for `cascade`, or "computed_torque". Raises InputError for another."""
    if not (np.isfinite(bandwidth) and bandwidth > 0):
        raise InputError(f"--bandwidth: found {bandwidth:g}, expected more than 0 Hz")
    if name == "pi":
        return cascade(plant, reference, bandwidth, rate)
    if name == "computed_torque":
        return computed_torque(plant, reference, bandwidth)
    raise InputError(f"--control {name}: expected pi or computed_torque")
