"""Which parameters a motion determines worst, by the effort that their uncertainty stands for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from modelgen.excitation.run import Excitation

NOISE = 0.01  # of the RMS of a joint's input, in every sample


@dataclass(frozen=True)
class Determined:
    """A base parameter. name: its own; joint: coordinate (from 0) whose input shows it most.

    size: what its standard deviation adds to the input there, RMS, in A for a driven joint, N m or N else; of
    an arm without nominal parameters in units of the noise. share: in % of the RMS of the input, None without
    nominal parameters.
    """

    name: str
    joint: int
    size: float
    share: float | None

    def periods(self, percent: float) -> int:
        """How many periods bring it within a share of the input, or within a unit of the noise."""
        times = self.size if self.share is None else self.share / percent
        return math.ceil(times**2)


def determined(e: Excitation) -> list[Determined]:
    """All base parameters, the worst first, after a single period at the settings' rate.

    Every sample has white noise of NOISE of the RMS input of its joint, of one unit where nothing says how
    large that is. The deviations are those of weighted least squares (Gautier and Khalil 1992).
    """
    observed, _ = e.problem.observation(e.z, e.t)
    inputs = e.signals["input"]
    rms = np.sqrt(np.mean(inputs**2, axis=0))
    known = bool(np.isfinite(rms).all() and (rms > 0.0).all())
    noise = NOISE * rms if known else np.ones(inputs.shape[1])
    columns = observed.reshape(*inputs.shape, -1) / noise[:, None]  # (N, n, p), in units of the noise
    sizes = np.sqrt(np.mean(columns**2, axis=0))  # (n, p)
    norms = np.sqrt(np.sum(columns**2, axis=(0, 1)))
    scaled = (columns / norms).reshape(-1, len(norms))
    stds = np.sqrt(np.diag(np.linalg.pinv(scaled.T @ scaled))) / norms
    moved = stds * sizes
    places = np.argmax(moved, axis=0)
    found = [
        Determined(
            name,
            int(j),
            float(moved[j, k] * noise[j]),
            float(100.0 * NOISE * moved[j, k]) if known else None,
        )
        for k, (name, j) in enumerate(zip(e.problem.names, places, strict=True))
    ]
    return sorted(found, key=lambda d: -float(d.size / noise[d.joint]))
