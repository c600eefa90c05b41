"""The optimal control problem over a horizon, in two formulations, for ipopt and for fatrop.

The state is (q, dq), constant controls over each interval. With "inverse" the control is the
acceleration: the motion over an interval is exact and linear, and the input, inverse_dynamics(q, dq, ddq)
in the middle of the interval, is a constraint of the path. With "forward" the control is the input, and
forward_dynamics is integrated by Runge-Kutta 4.

How it is put together decides how fast it is:

- One interval is one function, mapped over the horizon: generated code does not grow with the horizon.
- Parameters are marked as not differentiated (is_diff_in): no derivatives by them are computed.
- The arm's functions stay function calls of an MX graph for the compiler, and are expanded to SX for
  CasADi's own virtual machine.
- Variables and constraints stand interval after interval, as fatrop wants them.
"""

from __future__ import annotations

import contextlib
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from mpc_arm import ControlledArm, Drives

FloatArray = np.ndarray

FORMULATIONS = ("inverse", "forward")
SOLVERS = ("ipopt", "fatrop")
FLAGS = ("-O2", "-march=native")
TOLERANCE = 1e-6

# Weights of the squares of position [rad], velocity [rad/s] and control; of a soft limit (share of stroke).
POSITION, VELOCITY, CONTROL = 100.0, 1.0, 1e-3
SOFT, SOFT_SQUARE = 300.0, 1e3
MARGIN = 0.01  # of the stroke, kept free at both ends


@dataclass(frozen=True)
class Solution:
    """States (steps + 1 × 2n), inputs of the first interval, and what the solver took."""

    states: FloatArray
    inputs: FloatArray
    iterations: int
    cpu: float  # s
    wall: float  # s
    cost: float
    success: bool
    guess: FloatArray


class Horizon:
    """One solver for one arm and one formulation."""

    def __init__(
        self,
        arm: ControlledArm,
        formulation: str,
        solver: str,
        *,
        compiled_in: Path | None = None,
        flags: tuple[str, ...] = FLAGS,
        steps: int = 20,
        period: float = 0.05,
        substeps: int = 4,
        tolerance: float = TOLERANCE,
    ) -> None:
        """`compiled_in`: folder for the compiler's files; without it CasADi's virtual machine evaluates."""
        if formulation not in FORMULATIONS:
            raise ValueError(f"formulation {formulation!r}, expected one of {', '.join(FORMULATIONS)}")
        if not ca.has_nlpsol(solver):
            raise ValueError(f"this CasADi has no solver {solver!r}, expected one of {', '.join(SOLVERS)}")
        self.arm, self.formulation, self.steps, self.period = arm, formulation, steps, period
        n = arm.n
        self._interval = _interval(arm, formulation, period, substeps)
        self._width = 2 * n + n + (n if arm.drives else 0)  # variables of an interval
        problem, self._bounds, equality = self._problem()
        options = _options(solver, equality, flags if compiled_in else None, tolerance)
        begin = time.perf_counter()
        # The compiler's files go into the current folder.
        with contextlib.chdir(compiled_in) if compiled_in else contextlib.nullcontext():
            self._solver = ca.nlpsol("mpc", solver, problem, options)
        self.build_time = time.perf_counter() - begin

    def solve(
        self,
        state: FloatArray,
        reference: FloatArray,
        guess: FloatArray | None = None,
        parameters: FloatArray | None = None,
    ) -> Solution:
        """Plan from `state` (2n) along `reference` (steps + 1 × 2n); cold start at rest without a guess."""
        n, width = self.arm.n, self._width
        theta = self.arm.parameters if parameters is None else parameters
        if guess is None:
            rest = np.concatenate([state[:n], np.zeros(width - n)])
            guess = np.concatenate([np.tile(rest, self.steps), rest[: 2 * n]])
        p = np.concatenate([state, reference.ravel(), theta])
        wall, cpu = time.perf_counter(), time.process_time()
        result = self._solver(x0=guess, p=p, **self._bounds)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        x = result["x"].full().ravel()
        intervals = x[: self.steps * width].reshape(self.steps, width)
        states = np.vstack([intervals[:, : 2 * n], x[-2 * n :]])
        control = intervals[0, 2 * n : 3 * n]
        inputs = control
        if self.formulation == "inverse":
            inverse = self.arm.functions["inverse_dynamics"]
            middle = _middle(state[:n], state[n:], control, self.period)
            inputs = inverse(*middle, control, theta).full().ravel()
        stats = self._solver.stats()
        shifted = np.concatenate([x[width : self.steps * width], intervals[-1], x[-2 * n :]])
        shifted[(self.steps - 1) * width : (self.steps - 1) * width + 2 * n] = x[-2 * n :]
        return Solution(
            states,
            np.clip(inputs, -self.arm.effort, self.arm.effort),  # the solver's tolerance
            int(stats["iter_count"]),
            cpu,
            wall,
            float(result["f"]),
            bool(stats["success"]),
            shifted,
        )

    def _problem(self) -> tuple[dict[str, ca.MX], dict[str, Any], list[bool]]:
        """The problem, its bounds, and which constraints are equalities."""
        arm, steps, width, n = self.arm, self.steps, self._width, self.arm.n
        w = ca.MX.sym("w", steps * width + 2 * n)
        state = ca.MX.sym("state", 2 * n)
        reference = ca.MX.sym("reference", 2 * n, steps + 1)
        theta = ca.MX.sym("parameters", arm.parameters.size)
        columns = ca.reshape(w[: steps * width], width, steps)
        x, u, last = columns[: 2 * n, :], columns[2 * n :, :], w[steps * width :]
        reached, path, cost = self._interval["path"].map(steps)(
            x, u, reference[:, :steps], ca.repmat(theta, 1, steps)
        )
        gaps = ca.horzcat(x[:, 1:], last) - reached
        rows = ca.vertcat(gaps, path)
        # The measured state is a constraint of the first interval.
        g = ca.vertcat(gaps[:, 0], x[:, 0] - state, path[:, 0], ca.vec(rows[:, 1:]))
        f = ca.sum2(cost) + self._interval["end"](last, reference[:, steps])
        low, high = _path_bounds(arm, self.formulation)
        zeros = [0.0] * (2 * n)
        equal, free = [True] * (2 * n), [False] * len(low)
        control = [np.inf] * n if self.formulation == "inverse" else arm.effort.tolist()
        free_state = [np.inf] * (2 * n)
        slack = n if arm.drives else 0
        bounds = {
            "lbx": [*([-v for v in free_state + control] + [0.0] * slack) * steps, *(-v for v in free_state)],
            "ubx": [*(free_state + control + [np.inf] * slack) * steps, *free_state],
            "lbg": [*zeros, *zeros, *low, *(zeros + low) * (steps - 1)],
            "ubg": [*zeros, *zeros, *high, *(zeros + high) * (steps - 1)],
        }
        equality = equal + equal + free + (equal + free) * (steps - 1)
        p = ca.vertcat(state, ca.vec(reference), theta)
        return {"x": w, "f": f, "g": g, "p": p}, bounds, equality


def _middle(q: Any, dq: Any, ddq: Any, period: float) -> tuple[Any, Any]:
    """Half-way through an interval: a held input is right to second order there, to first at the start."""
    half = period / 2
    return q + half * dq + half**2 / 2 * ddq, dq + half * ddq


def _interval(arm: ControlledArm, formulation: str, period: float, substeps: int) -> dict[str, ca.Function]:
    """Functions of one interval: (x, u, reference, parameters) -> (next x, path, cost); cost of the end."""
    n = arm.n
    x, reference = ca.MX.sym("x", 2 * n), ca.MX.sym("reference", 2 * n)
    u = ca.MX.sym("u", 2 * n if arm.drives else n)
    theta = ca.MX.sym("parameters", arm.parameters.size)
    q, dq, control, slack = x[:n], x[n:], u[:n], u[n:]
    path = []
    if formulation == "inverse":
        reached = ca.vertcat(q + period * dq + period**2 / 2 * control, dq + period * control)
        middle = _middle(q, dq, control, period)
        path.append(_constant_parameters(arm.functions["inverse_dynamics"])(*middle, control, theta))
    else:
        step, reached = _runge_kutta(arm, period / substeps), x
        for _ in range(substeps):
            reached = step(reached, control, theta)
    tracking = POSITION * ca.sumsqr(q - reference[:n]) + VELOCITY * ca.sumsqr(dq - reference[n:])
    cost = tracking + CONTROL * ca.sumsqr(control)
    if arm.drives:
        path.append(_soft_limits(arm.functions["motor_from_joint"], arm.drives, q, slack))
        cost += SOFT * ca.sum1(slack) + SOFT_SQUARE * ca.sumsqr(slack)
    outputs = [reached, ca.vertcat(*path) if path else ca.MX(0, 1), cost]
    return {
        "path": ca.Function(
            "interval", [x, u, reference, theta], outputs, {"is_diff_in": [True, True, False, False]}
        ),
        "end": ca.Function("end", [x, reference], [tracking]),
    }


def _runge_kutta(arm: ControlledArm, h: float) -> ca.Function:
    """The state after one step of Runge-Kutta 4: a function of its own, which is compiled once."""
    n = arm.n
    x, u, theta = ca.MX.sym("x", 2 * n), ca.MX.sym("u", n), ca.MX.sym("parameters", arm.parameters.size)
    forward = _constant_parameters(arm.functions["forward_dynamics"])

    reached = after_step(forward, x, u, theta, h)
    return ca.Function("runge_kutta", [x, u, theta], [reached], {"is_diff_in": [True, True, False]})


def after_step(forward: ca.Function, x: ca.MX, u: ca.MX, theta: ca.MX, h: float) -> ca.MX:
    """The state (2 n,) that is reached from x after one step h [s] of Runge-Kutta 4."""
    n = x.numel() // 2

    def slope(state: ca.MX) -> ca.MX:
        return ca.vertcat(state[n:], forward(state[:n], state[n:], u, theta))

    a = slope(x)
    b = slope(x + h / 2 * a)
    c = slope(x + h / 2 * b)
    d = slope(x + h * c)
    return x + h / 6 * (a + 2 * b + 2 * c + d)


def _constant_parameters(function: ca.Function) -> ca.Function:
    """The function without derivatives by its parameters, which cost most and nobody asks for."""
    inputs = function.sx_in()
    wanted = [name != "parameters" for name in function.name_in()]
    return ca.Function(function.name(), inputs, function.call(inputs), {"is_diff_in": wanted})


def _soft_limits(motor: ca.Function, drives: Drives, q: ca.MX, slack: ca.MX) -> ca.MX:
    """Place in the stroke, 0 to 1: with the slack added for its lower end, subtracted for its upper end.

    Soft, since the plant may carry the arm beyond a limit and the next plan must still exist.
    """
    rest = ca.DM.zeros(q.numel())
    q_m, _, _ = motor(q, rest, rest)
    share = (q_m - drives.low) / (drives.high - drives.low)
    limits: ca.MX = ca.vertcat(share + slack, share - slack)
    return limits


def _path_bounds(arm: ControlledArm, formulation: str) -> tuple[list[float], list[float]]:
    low, high = [], []
    if formulation == "inverse":
        low += (-arm.effort).tolist()
        high += arm.effort.tolist()
    if arm.drives:
        n, inf = arm.n, np.inf
        low += [MARGIN] * n + [-inf] * n
        high += [inf] * n + [1 - MARGIN] * n
    return low, high


def _options(
    solver: str, equality: list[bool], flags: tuple[str, ...] | None, tolerance: float
) -> dict[str, Any]:
    options: dict[str, Any] = {"print_time": False}
    if flags is None:
        options["expand"] = True
    else:
        options |= {"jit": True, "compiler": "shell", "jit_options": {"compiler": "cc", "flags": list(flags)}}
    if solver == "ipopt":
        return options | {
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.tol": tolerance,
            "ipopt.max_iter": 200,
        }
    fatrop = {"print_level": 0, "tol": tolerance, "max_iter": 200}
    return options | {"structure_detection": "auto", "equality": equality, "fatrop": fatrop}
