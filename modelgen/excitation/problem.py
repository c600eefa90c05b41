"""The arm along a trajectory, as CasADi functions of one sample."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from modelgen.backends.casadi.function import casadi_function
from modelgen.description import Arm
from modelgen.effects import CATALOGUE, applied_effects
from modelgen.errors import InputError
from modelgen.excitation.fourier import Basis, basis
from modelgen.excitation.limits import Bound, bounds, ranges, speeds
from modelgen.functions import EVALUATED, Model, build_model, grouped
from modelgen.functions.nominal import nominal_base, nominal_links
from modelgen.numeric import Array
from modelgen.options import Box, ExcitationOptions

GRID = 24  # samples per period of the highest harmonic, in the optimisation
MARGIN = 0.01  # of every limit, left for what happens between the samples
SMOOTHING = 0.01  # of the speed limit: width of the smoothed sign that the optimisation sees
SIGNALS = ("q", "dq", "ddq", "qm", "dqm", "ddqm", "input", "effort")


@dataclass(frozen=True)
class Problem:
    """Functions that the optimiser and the random search need; they can be sent to other processes.

    exact: (x, dx, ddx) of one sample to (regressor^T (p, n), constraints), which are scaled to lie in
    [-1, 1]. motion: (x, dx, ddx) to all of SIGNALS. middle, half: (n,) ranges of the coordinates that the
    series is written in; amplitude: (n,) their unit in the coefficients. names: of the base parameters.
    constraints: what each limits.
    """

    settings: ExcitationOptions
    basis: Basis
    exact: ca.Function
    motion: ca.Function
    middle: Array
    half: Array
    amplitude: Array
    names: tuple[str, ...]
    constraints: tuple[str, ...]
    remarks: tuple[str, ...]

    def grid(self, density: int = GRID) -> Array:
        """Times [s] of one period, `density` per period of the highest harmonic."""
        count = density * self.settings.harmonics
        return np.arange(count) * self.settings.period / count

    def at_rate(self) -> Array:
        """Times [s] of one period at the settings' rate."""
        return np.arange(round(self.settings.period * self.settings.rate)) / self.settings.rate

    def series(self, z: Array, t: Array) -> tuple[Array, Array, Array]:
        """x, dx, ddx (N, n) at times t (N,) of the coefficients z (n, size), in units of the coordinates."""
        x, dx, ddx = (matrix @ z.T for matrix in self.basis.signals(t))
        return self.middle + self.amplitude * x, self.amplitude * dx, self.amplitude * ddx

    def sampled(self, function: ca.Function, z: Array, t: Array) -> tuple[Array, ...]:
        """The outputs of a function of one sample, (N, rows, columns), at times t (N,)."""
        mapped = _mapped(function, len(t))
        made: tuple[Any, Any] = mapped.buffer()  # matrices of CasADi are copied number by number
        buffer, evaluate = made
        given = [np.ascontiguousarray(part) for part in self.series(z, t)]
        for k, part in enumerate(given):
            buffer.set_arg(k, part.data)
        sizes = [function.size_out(k) for k in range(function.n_out())]
        found = [np.empty((len(t), columns, rows)) for rows, columns in sizes]
        for k, values in enumerate(found):
            buffer.set_res(k, values.data)
        evaluate()
        return tuple(values.transpose(0, 2, 1) for values in found)

    def observation(self, z: Array, t: Array) -> tuple[Array, float]:
        """The observation matrix (n N, p) and the largest magnitude of a constraint; infinite for NaN."""
        regressor, limits = self.sampled(self.exact, z, t)
        size = regressor.shape[1]
        largest = float(np.abs(limits).max()) if np.isfinite(limits).all() else float("inf")
        # columns that lie together in memory are summed up pairwise
        return np.asfortranarray(regressor.transpose(0, 2, 1).reshape(-1, size)), largest


@lru_cache(maxsize=16)
def _mapped(function: ca.Function, count: int) -> ca.Function:
    """For so many samples side by side, with dense outputs."""
    given = [ca.MX.sym(name, function.size1_in(name), count) for name in function.name_in()]
    return ca.Function("mapped", given, [ca.densify(x) for x in function.map(count).call(given)])


def problem(arm: Arm, settings: ExcitationOptions) -> Problem:
    """The problem of one arm.

    Raises InputError where a limit is missing that nothing can stand for, where the arm has effects with
    states, and for a box of an unknown link.
    """
    settings.checked()
    limits, remarks = bounds(arm, settings)
    middle, half = ranges(arm, limits, settings.coordinates)
    exact = _functions(arm, limits, settings)
    series = basis(settings.period, settings.harmonics, settings.rest)
    if not exact.nominal:
        kept = [b for b in limits if b.signal in ("input", "effort")]
        if kept:
            remarks.append("efforts are not limited: the description has no nominal inertials and effects")
    speed = speeds(arm, limits, settings.coordinates)
    amplitude = np.minimum(half, speed * settings.period / (2 * np.pi))
    return Problem(
        settings,
        series,
        exact.sample,
        exact.motion,
        middle,
        half,
        amplitude,
        exact.names,
        exact.constraints,
        tuple(remarks),
    )


def smooth(arm: Arm, settings: ExcitationOptions) -> ca.Function:
    """The problem of `exact` with the signs of dry friction smoothed, so that it has derivatives."""
    limits, _ = bounds(arm, settings)
    return _functions(_smoothed(arm, speeds(arm, limits, "motor")), limits, settings).sample


@dataclass(frozen=True)
class _Functions:
    sample: ca.Function
    motion: ca.Function
    names: tuple[str, ...]
    constraints: tuple[str, ...]
    nominal: bool


def _weighed(arm: Arm) -> Model:
    """The model, without friction by the load where nobody knows what the links weigh."""
    model = build_model(arm, EVALUATED)
    loaded = {(e.effect.name, e.joint) for e in applied_effects(arm) if e.depends_on("load")}
    if not loaded or _weights(model):
        return model
    joints = tuple(
        replace(joint, effects=tuple(use for use in joint.effects if (use.name, k) not in loaded))
        for k, joint in enumerate(arm.joints)
    )
    return build_model(replace(arm, joints=joints), EVALUATED)


def _nominal(model: Model) -> list[float]:
    """Nominal base parameters; none where the description does not give them."""
    try:
        return list(nominal_base(model).values())
    except InputError:
        return []


def _weights(model: Model) -> list[float]:
    """Base parameters of the nominal links alone; none where the description does not give them."""
    try:
        known = nominal_links(model.arm)
    except InputError:
        return []
    return list(grouped(model, [known.get(p.name, 0.0) for p in model.standard]).values())


def _functions(arm: Arm, limits: Sequence[Bound], settings: ExcitationOptions) -> _Functions:
    model = _weighed(arm)
    if model.states:
        raise InputError(
            f"{arm.name}: its effects have states ({', '.join(model.states)}), which depend on the past; "
            "excite needs the description without them",
            arm.where,
        )
    made = {f.name: f for f in model.functions}
    n = len(arm.coordinates)
    x, dx, ddx = (ca.SX.sym(name, n) for name in ("x", "dx", "ddx"))
    if settings.coordinates == "motor":
        q, dq, ddq = casadi_function(made["joint_from_motor"]).call([x, dx, ddx])
        motor = [x, dx, ddx]
    else:
        q, dq, ddq = x, dx, ddx
        motor = casadi_function(made["motor_from_joint"]).call([q, dq, ddq])
    arguments = {"q": q, "dq": dq, "ddq": ddq}
    regressor = casadi_function(made["regressor"])
    nominal = _nominal(model)
    if "load" in regressor.name_in():
        arguments["load"] = casadi_function(made["load"])(q, _weights(model))
    y = regressor(*(arguments[name] for name in regressor.name_in()))
    values = {**arguments, "qm": motor[0], "dqm": motor[1], "ddqm": motor[2]}
    values["input"] = y @ ca.DM(nominal) if nominal else ca.SX.nan(n)
    values["effort"] = values["input"] * casadi_function(made["drive_gain"])(q)
    rows, names = [], []
    for b in limits:
        if b.signal in ("input", "effort") and not nominal:
            continue
        rows.append((values[b.signal][b.coordinate] - (b.high + b.low) / 2) / ((b.high - b.low) / 2))
        names.append(f"{b.signal}{b.coordinate + 1}")
    frames = casadi_function(made["forward_kinematics"])
    for box in settings.boxes:
        found, said = _boxed(box, frames, q)
        rows += found
        names += said
    sample = ca.Function("sample", [x, dx, ddx], [ca.densify(y.T), ca.vertcat(*rows)])
    motion = ca.Function("motion", [x, dx, ddx], [values[name] for name in SIGNALS])
    parameters = tuple(p.name for p in model.grouping.base)
    return _Functions(sample, motion, parameters, tuple(names), bool(nominal))


def _boxed(box: Box, frames: ca.Function, q: ca.SX) -> tuple[list[ca.SX], list[str]]:
    """The rows of a box: two-sided ranges scaled to [-1, 1], one-sided ones bent to stay below 1."""
    links = [name.removeprefix("T_") for name in frames.name_out()]
    if box.link not in links:
        raise InputError(f"--box: found link '{box.link}', expected one of {', '.join(links)}")
    place = frames.call([q])[links.index(box.link)]
    rows, names = [], []
    for axis, (low, high) in enumerate(zip(box.low, box.high, strict=True)):
        value = place[axis, 3]
        if np.isfinite(low) and np.isfinite(high):
            rows.append((value - (low + high) / 2) / ((high - low) / 2))
        elif np.isfinite(low) or np.isfinite(high):
            depth = value - low if np.isfinite(low) else high - value
            # depth 0 gives 1, depth of a metre about -0.5, none ever -1
            rows.append(1 - 2 * depth / (1 + ca.sqrt(1 + depth**2)))
        else:
            continue
        names.append(f"{'xyz'[axis]} of {box.link}")
    return rows, names


def _smoothed(arm: Arm, speed: Array) -> Arm:
    """The arm with the sign of every dry friction smoothed, as far as its description leaves that open."""
    joints = list(arm.joints)
    for n, i in enumerate(arm.coordinates):
        uses = []
        for use in joints[i].effects:
            known = any(p.name == "smoothing" for p in CATALOGUE[use.name].nonlinear)
            smooth = {**use.values, "smoothing": SMOOTHING * float(speed[n])}
            uses.append(replace(use, values=smooth) if known and not use.values.get("smoothing") else use)
        joints[i] = replace(joints[i], effects=tuple(uses))
    return replace(arm, joints=tuple(joints))
