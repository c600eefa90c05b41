"""How well a simulated motion fits a measured one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.numeric import Array


@dataclass(frozen=True)
class Scores:
    """Scores by joint, (n,): f_gof [%], mae and rmse [rad, m]."""

    f_gof: Array
    mae: Array
    rmse: Array


def scores(measured: Array, simulated: Array) -> Scores:
    """Scores of (..., S, n) positions; all leading axes count as one record.

    F_gof = 100 (1 - |y - y_sim| / |y - mean y|), the fit of Ljung (1999, System Identification, section
    16.4, in percent; NaN where the measured joint does not move), MAE = mean |y - y_sim|, RMSE the root of
    the mean of squares (Hyndman and Koehler 2006).
    """
    y = measured.reshape(-1, measured.shape[-1])
    e = y - simulated.reshape(-1, simulated.shape[-1])
    # a motion that runs away may leave what can be squared
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        ratio = np.linalg.norm(e, axis=0) / np.linalg.norm(y - y.mean(axis=0), axis=0)
        rmse = np.sqrt((e**2).mean(axis=0))
    ratio[~np.isfinite(ratio)] = np.nan
    return Scores(100.0 * (1.0 - ratio), np.abs(e).mean(axis=0), rmse)


def repeated(runs: Sequence[Array]) -> tuple[Array, Array]:
    """Mean (S, n) of repeated runs and their scatter (n,): the noise that no model can explain.

    runs: R arrays (S_r, n) that begin alike; all are cut to the shortest. The scatter is the root mean
    square over time of the standard deviation between runs (R - 1 degrees of freedom). Raises ValueError
    for fewer than two runs.
    """
    if len(runs) < 2:
        raise ValueError(f"found {len(runs)} run, expected two at least: one alone has no scatter")
    length = min(len(run) for run in runs)
    stack = np.stack([run[:length] for run in runs])
    return stack.mean(axis=0), np.sqrt(stack.var(axis=0, ddof=1).mean(axis=0))
