"""Windows of a record simulated from their measured initial states with the measured inputs.

Short windows (multiple shooting) keep an arm without a controller comparable with its log.
"""

from __future__ import annotations

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.diagnosis.objects import Scores
from modelgen.diagnosis.rows import Array, Rows
from modelgen.functions import Model

WINDOW = 0.25  # s
MOST = 250  # windows


def replay(model: Model, parameters: Array, rows: Rows) -> tuple[Scores, Array] | None:
    """Scores of the simulated positions, and the positions (W, S, n) of all windows; None where there is no
    input, or where the model has states, whose beginning no log holds.

    Fixed steps of the record's period by the midpoint rule, all windows at once.
    """
    p = rows.prepared
    if p.input is None or model.states:
        return None
    functions = {f.name: NumpyFunction(f) for f in model.functions if f.name == "forward_dynamics"}
    forward = functions["forward_dynamics"]
    step, length = p.record.step, max(4, round(WINDOW / p.record.step))
    trim = int(p.rows[0])
    count = (len(p.time) - 2 * trim) // length
    if count < 2:
        return None
    starts = trim + length * np.linspace(0, count - 1, min(count, MOST)).astype(int)
    names = [a.name for a in forward.function.arguments]
    q, dq = p.q[starts].copy(), p.dq[starts].copy()
    path = np.empty((len(starts), length, q.shape[1]))

    def acceleration(q: Array, dq: Array, k: int) -> Array:
        given = {
            "q": q,
            "dq": dq,
            "input": np.asarray(p.input)[starts + k],
            "parameters": parameters,
            "time": p.time[starts + k][:, None],
        }
        return np.asarray(forward(**{name: given[name] for name in names}))

    for k in range(length):
        path[:, k] = q
        half = dq + step / 2 * acceleration(q, dq, k)
        middle = acceleration(q + step / 2 * dq, half, k)
        q, dq = q + step * half, dq + step * middle
    measured = np.stack([p.q[s : s + length] for s in starts])
    good = np.isfinite(path).all(axis=(1, 2))
    if not good.any():
        return None
    error = (path - measured)[good]
    spread = measured[good] - measured[good].mean(axis=(0, 1))
    f_gof = 100 * (1 - np.sqrt((error**2).sum(axis=(0, 1)) / (spread**2).sum(axis=(0, 1))))
    scores = Scores(f_gof, np.abs(error).mean(axis=(0, 1)), np.sqrt((error**2).mean(axis=(0, 1))))
    return scores, path
