"""What the emitted derivatives cost in CasADi: the sensitivities of a step of Runge-Kutta 4.

    python examples/mpc/mpc_jacobian.py       a table on stdout, some seconds

docs/mpc.md has the figures.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from mpc_arm import imported
from mpc_horizon import after_step

GENERATED = Path(__file__).resolve().parents[2] / "generated"
ARMS = ("ariane4", "yaw3pitch", "ur10e", "iiwa14")
STEP = 0.0125  # s
REPETITIONS, CALLS = 21, 50


def sensitivities(dynamics: ca.Function) -> ca.Function:
    """(x, u, parameters) -> the state after a step of Runge-Kutta 4, and its Jacobian by x and by u."""
    n = dynamics.numel_out(0)
    x, u, p = ca.MX.sym("x", 2 * n), ca.MX.sym("u", n), ca.MX.sym("p", dynamics.size1_in(3))
    reached = after_step(dynamics, x, u, p, STEP)
    outputs = [reached, ca.jacobian(reached, x), ca.jacobian(reached, u)]
    return ca.Function("sensitivities", [x, u, p], outputs)


def cpu(function: ca.Function) -> float:
    """CPU time of one call [s]. What is computed is the same at all values."""
    values = [np.full(function.size1_in(i), 0.3) for i in range(function.n_in())]
    begin = time.process_time()
    for _ in range(CALLS):
        function(*values)
    return (time.process_time() - begin) / CALLS


def ratio(arm: str) -> float:
    """CPU time with the emitted derivatives over that with CasADi's own: the median of alternating runs."""
    module: Any = imported(GENERATED / arm / f"{arm}_casadi.py")
    name = f"{arm}_forward_dynamics"
    given, own = sensitivities(module.with_jacobian(name)), sensitivities(module.function(name))
    return float(np.median([cpu(given) / cpu(own) for _ in range(REPETITIONS)]))


def main() -> int:
    """Print the table."""
    print("| arm | time with_jacobian / function |\n|---|---:|")
    for arm in ARMS:
        print(f"| {arm} | {ratio(arm):.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
