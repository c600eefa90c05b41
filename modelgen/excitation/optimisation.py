"""One start of the optimisation: CasADi and IPOPT with exact derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from modelgen.excitation.counting import one_more
from modelgen.excitation.problem import GRID, MARGIN, Problem
from modelgen.excitation.random_motion import feasible, shrunk
from modelgen.excitation.spectrum import Criterion, condition, log_determinant
from modelgen.numeric import Array

FINE = 4 * GRID  # samples per period of the highest harmonic, where the limits are checked
_OPTIONS = {
    "ipopt.hessian_approximation": "limited-memory",
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-4,
    "ipopt.acceptable_tol": 1e-3,
    "ipopt.acceptable_iter": 10,
    "ipopt.mu_strategy": "adaptive",
    "print_time": False,
    "show_eval_warnings": False,
}


class Optimiser:
    """The nonlinear programme of a problem, built once and started as often as wanted.

    The objective and the constraints have exact first derivatives; the Hessian is that of limited-memory
    BFGS. smooth: what they are made of, of the same arm and settings.
    """

    def __init__(self, problem: Problem, smooth: ca.Function) -> None:
        self.problem = problem
        t = problem.grid()
        n, size = len(problem.middle), problem.basis.size
        z = ca.MX.sym("z", n * size)
        rows = ca.reshape(z, size, n)
        x, dx, ddx = (ca.mtimes(ca.DM(m), rows) for m in problem.basis.signals(t))
        unit = ca.repmat(ca.DM(problem.amplitude).T, len(t), 1)
        middle = ca.repmat(ca.DM(problem.middle).T, len(t), 1)
        sampled = smooth.map(len(t))
        w, limits = sampled((middle + unit * x).T, (unit * dx).T, (unit * ddx).T)
        scale = self._scale(t)
        w = ca.mtimes(ca.diag(ca.DM(1 / scale)), w)
        # Kept: CasADi holds no reference to a callback.
        self._criterion = Criterion(problem.settings.criterion, len(scale))
        nlp: Any = {"x": z, "f": self._criterion(ca.mtimes(w, w.T)), "g": ca.vec(limits)}
        self._iterations = _Iterations({"x": z.numel(), "g": limits.numel()})
        options: Any = {
            **_OPTIONS,
            "ipopt.max_iter": problem.settings.iterations,
            "iteration_callback": self._iterations,
        }
        self._solver = ca.nlpsol("excitation", "ipopt", nlp, options)

    def _scale(self, t: Array) -> Array:
        """Norms of the columns for one motion: so the Gram matrix is near unit size."""
        z = feasible(self.problem, np.random.default_rng(0), MARGIN)
        norms = np.linalg.norm(self.problem.observation(z, t)[0], axis=0)
        return np.where(norms > 0, norms, 1.0)

    def start(self, seed: int, count: str = "") -> Array | None:
        """Coefficients z (n, size) from the random start `seed`, within all limits; None where it failed.

        count: file that counts the iterations, empty for none.
        """
        p, self._iterations.file = self.problem, count
        rng = np.random.default_rng([p.settings.seed, seed])
        first = feasible(p, rng, 2 * MARGIN)
        bound = 1 - MARGIN
        solution = self._solver(x0=first.ravel(), lbg=-bound, ubg=bound)
        z = solution["x"].full().reshape(first.shape)
        fine = p.grid(FINE)
        if not np.isfinite(z).all():
            return first
        z = shrunk(p, z, fine, 1.0)
        return better(p, z, shrunk(p, first, fine, 1.0))


class _Iterations(ca.Callback):
    """Counts the iterations of a programme into a file. sizes: of its variables x and its constraints g."""

    def __init__(self, sizes: dict[str, int]) -> None:
        ca.Callback.__init__(self)
        self._sizes, self.file = sizes, ""
        self.construct("iterations", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_sparsity_in(self, k: int) -> ca.Sparsity:
        name = ca.nlpsol_out(k)
        return ca.Sparsity.dense(1 if name == "f" else self._sizes.get(name.removeprefix("lam_"), 0), 1)

    def eval(self, _: Sequence[ca.DM]) -> list[float]:
        """Zero: go on."""
        one_more(self.file)
        return [0.0]


def better(problem: Problem, a: Array | None, b: Array | None) -> Array | None:
    """The one of two trajectories that the criterion prefers, at the settings' rate."""
    if a is None or b is None:
        return b if a is None else a
    return a if merit(problem, a) <= merit(problem, b) else b


def merit(problem: Problem, z: Array) -> float:
    """Merit, which is minimised: the condition number, or minus the logarithm of the determinant."""
    w, _ = problem.observation(z, problem.at_rate())
    if problem.settings.criterion == "cond":
        return condition(w)
    norms = np.linalg.norm(w, axis=0)
    if (norms == 0).any():
        return float("inf")
    return -(log_determinant(w, norms) + 2 * float(np.mean(np.log(norms))))
