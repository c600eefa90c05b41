"""One simulated motion, by fixed or by variable steps."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil

import numpy as np
from numpy.typing import ArrayLike, NDArray

from modelgen.errors import InputError
from modelgen.native import compiler
from modelgen.numeric import Array
from modelgen.simulation.adaptive import METHODS, Adaptive
from modelgen.simulation.control import Control
from modelgen.simulation.fixed import ENDS, Stepper
from modelgen.simulation.plant import Plant
from modelgen.simulation.sundials import Sundials
from modelgen.simulation.trajectory import Trajectory
from modelgen.simulation.weightless import check_inertia

MOST = 2e7  # samples: all are kept in memory
STEP = 1e-3  # s, longest fixed step
STIFF = 2e4  # 1/s, beyond which explicit steps are too many


def simulate(
    plant: Plant,
    q0: ArrayLike,
    dq0: ArrayLike,
    duration: float,
    rate: float,
    control: Control | ArrayLike | None = None,
    *,
    method: str = "",
    step: float | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-10,
    stop_at_limits: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """The motion from q0, dq0 (n,) over `duration` [s], with samples at `rate` [Hz].

    control: None for no input; the input (n,) that a function gives at a sample for t, q, dq; or inputs
    (S, n) sample by sample. The input is held until the next sample. method: "fixed" (compiled C, steps of
    `step` [s] at most), or a method of scipy.integrate.solve_ivp with rtol and atol; by default DOP853 (LSODA
    for effects with states) without control, fixed with it, where there is a C compiler. A lever that
    leaves its stroke ends the motion, so do, if wanted, the description's limits: `ended` then says
    so and when. States of effects begin at zero. Raises InputError for a state outside the stroke, a
    length or method that makes no sense, and a start at which joints move no inertia.
    """
    q, dq = (np.broadcast_to(np.asarray(x, dtype=float), (plant.n,)).copy() for x in (q0, dq0))
    _check(plant, q, dq, duration, rate)
    check_inertia(plant, q)
    if step is not None and not (np.isfinite(step) and step > 0):
        raise InputError(f"--step: found {step:g}, expected more than 0")
    count = round(duration * rate) + 1
    times = np.arange(count) / rate
    inputs = np.zeros((count, plant.n))
    held = control
    if held is not None and not callable(held):
        given = np.asarray(held, dtype=float)
        if given.shape != (count, plant.n):
            raise InputError(f"found inputs of shape {given.shape}, expected ({count}, {plant.n})")
        inputs = given.copy()
    low, high = plant.strokes
    if stop_at_limits:
        low, high = np.maximum(low, plant.limits[0]), np.minimum(high, plant.limits[1])
    y = np.concatenate([q, dq, np.zeros(len(plant.model.states))])
    if not np.isfinite(Adaptive(plant, METHODS[0], rtol, atol).terms(0.0, y, inputs[0])[0]).all():
        raise InputError(
            f"{plant.arm.name}: the accelerations at the beginning are not finite; a joint with play or "
            "elasticity needs a drive with inertia of its own, in the description's nominal values"
        )
    name = method or default_method(plant, q, dq, compiled=control is not None)
    path = np.empty((count, len(y)))
    path[0] = y
    feedback = held if callable(held) else None
    if name == "fixed":
        run = _fixed(plant, low, high, rate, step, y)
    else:
        run = _adaptive(plant, low, high, name, rtol, atol)
    ended = ""
    done = 1
    while done < count and not ended:
        last = _until(done, count, feedback is not None, control is None, name)
        if feedback is not None:
            u = np.asarray(
                feedback(times[done - 1], path[done - 1, : plant.n], path[done - 1, plant.n : 2 * plant.n])
            )
            if u.shape != (plant.n,) or not np.isfinite(u).all():
                ended = f"the control's input is not finite at {times[done - 1]:.6g} s"
                break
            inputs[done - 1] = u
        part, why = run(times[done - 1 : last + 1], y, inputs[done - 1 : last])
        path[done : done + len(part) - 1] = part[1:]
        done += len(part) - 1
        y = path[done - 1].copy() if not why else y
        ended = why
        if progress is not None:
            progress(float(times[done - 1]))
    n = plant.n
    inputs[done - 1] = inputs[done - 2] if feedback is not None and done > 1 else inputs[done - 1]
    path = path[:done]
    return Trajectory(times[:done], path[:, :n], path[:, n : 2 * n], inputs[:done], path[:, 2 * n :], ended)


_Run = Callable[[Array, Array, Array], tuple[Array, str]]


def _until(done: int, count: int, feedback: bool, free: bool, name: str) -> int:
    """Sample up to which the next call may run."""
    if feedback:
        return done
    if name != "fixed" and not free:
        return done
    return min(count - 1, done + 999)


def _fixed(plant: Plant, low: Array, high: Array, rate: float, step: float | None, y: Array) -> _Run:
    try:
        stepper = Stepper(plant, low, high)
    except RuntimeError as error:
        raise InputError(f"fixed steps: {error}; or choose a method of variable steps") from None
    # A step of 1 over the fastest rate is well inside where the method is stable (2.8).
    longest = step or min(STEP, 1.0 / max(fastest(plant, y), 1e-9))
    substeps = max(1, ceil(1.0 / rate / longest - 1e-9))
    if substeps * rate > 1e7:
        raise InputError(
            f"{plant.arm.name}: fixed steps of {longest:.1g} s would be needed; expected a method for stiff "
            "arms, LSODA, Radau, BDF or cvodes"
        )
    modes: list[NDArray[np.intc]] = []

    def run(times: Array, y: Array, inputs: Array) -> tuple[Array, str]:
        if not modes:
            modes.append(stepper.begin(times[0], y, inputs[0]))
        h = 1.0 / rate / substeps
        path, status = stepper.run(times[0], h, substeps, y, modes[0], inputs)
        if status:
            at = times[len(path) - 1]
            return path, f"{_who(plant, y, low, high, ENDS[status])} after {at:.6g} s"
        return path, ""

    return run


def _adaptive(plant: Plant, low: Array, high: Array, name: str, rtol: float, atol: float) -> _Run:
    if name not in (*METHODS, "cvodes"):
        raise InputError(f"--method {name}: expected fixed, cvodes, {', '.join(METHODS)}")
    integrator = Sundials(plant, rtol, atol) if name == "cvodes" else Adaptive(plant, name, rtol, atol)
    modes: list[tuple[int, ...]] = []

    def run(times: Array, y: Array, inputs: Array) -> tuple[Array, str]:
        u = inputs[0]
        now = integrator.again(times[0], y, u, modes[0]) if modes else integrator.begin(times[0], y, u)
        path, now, why, at = integrator.run(list(times), y, u, now, low, high)
        modes[:] = [now]
        y[:] = path[-1]
        if why:
            reason = ENDS[1] if why == "left" else why
            return path, f"{_who(plant, path[-1], low, high, reason)} at {at:.6g} s"
        return path, ""

    return run


def _who(plant: Plant, y: Array, low: Array, high: Array, what: str) -> str:
    """The joint that left its range, where one did."""
    if what != ENDS[1]:
        return f"the simulation stopped: {what}"
    q = y[: plant.n]
    k = int(np.argmin(np.minimum(q - low, high - q)))
    stroke = "stroke" if low[k] == plant.strokes[0][k] else "limits"
    return f"joint {plant.names[k]} left its {stroke} ({low[k]:.6g} to {high[k]:.6g})"


def default_method(plant: Plant, q: Array, dq: Array, *, compiled: bool) -> str:
    """The method for motions that begin at q, dq (n,). compiled: fixed steps of compiled C will do."""
    stiff = fastest(plant, np.concatenate([q, dq, np.zeros(len(plant.model.states))])) > STIFF
    if compiled and compiler() is not None and not stiff:
        return "fixed"
    return "LSODA" if plant.model.states or stiff else "DOP853"


def fastest(plant: Plant, y: Array) -> float:
    """Largest magnitude of an eigenvalue [1/s] of the equations at a state (2n + z,), friction sliding."""
    integrator = Adaptive(plant, "DOP853", 1e-9, 1e-9)
    modes = (1,) * len(plant.slip.contacts)
    u, size = np.zeros(plant.n), len(y)
    jacobian = np.empty((size, size))
    for k in range(size):
        step = 1e-6 * max(1.0, abs(y[k])) * np.eye(size)[k]
        try:
            ahead, back = (integrator.rate(0.0, y + s * step, u, modes) for s in (1, -1))
        except FloatingPointError:
            return 0.0
        jacobian[:, k] = (ahead - back) / (2 * step[k])
    return float(np.abs(np.linalg.eigvals(jacobian)).max()) if np.isfinite(jacobian).all() else 0.0


def check_length(duration: float, rate: float) -> None:
    """Raises InputError for a length [s] or a rate [Hz] that gives no motion, or one without end."""
    for text, value in (("--duration", duration), ("--rate", rate)):
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"{text}: found {value:g}, expected more than 0")
    if not 1 <= duration * rate <= MOST:
        raise InputError(
            f"--duration {duration:g} s at --rate {rate:g} Hz: {duration * rate:g} samples, expected 1 to 2e7"
        )


def _check(plant: Plant, q: Array, dq: Array, duration: float, rate: float) -> None:
    if not (np.isfinite(q).all() and np.isfinite(dq).all()):
        raise InputError("the initial state is not finite")
    check_length(duration, rate)
    low, high = plant.strokes
    for k, name in enumerate(plant.names):
        if not low[k] <= q[k] <= high[k]:
            raise InputError(
                f"--q0: joint {name} at {q[k]:.6g}, outside its stroke {low[k]:.6g} to {high[k]:.6g} rad"
            )
