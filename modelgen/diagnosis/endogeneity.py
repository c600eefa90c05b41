"""Whether the regressor is correlated with the errors of the equations: the test of Durbin, Wu and Hausman.

Where the motion repeats, the same phase of another period is an instrument: its regressor has the same truth
and other errors of the positions. What the instruments do not explain of the regressor, beside it, explains
nothing of the effort where positions are exact (Hausman 1978; Janot, Vandanjon and Gautier 2014).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from modelgen.diagnosis.instruments import Pairs
from modelgen.diagnosis.system import System
from modelgen.numeric import Array

SIGNIFICANCE = 1e-4


@dataclass(frozen=True)
class Endogeneity:
    """statistic: likelihood ratio, chi-squared of `degrees` where positions are exact; threshold: of it.

    share: percent of the whitened RMSE by joint (n,) that the errors of the regressor explain; cost: of the
    RMSE as it is, as whitening brings out what is high in frequency.
    """

    statistic: float
    degrees: int
    threshold: float
    share: Array
    cost: Array

    @property
    def found(self) -> bool:
        """Whether errors of the positions are seen."""
        return self.statistic > self.threshold


def endogeneity(system: System) -> Endogeneity | None:
    """Of the equations with all that they contain; None where nothing repeats."""
    pairs = Pairs(system.rows, system.columns, system.periods, system.sizes)
    if not pairs.enough:
        return None
    stage = pairs.first_stage()
    left = [
        np.zeros(table.shape)
        if partner is None
        else (table - (table[partner] / pairs.scale) @ stage) * there[:, :, None]
        for table, partner, there in zip(system.columns, pairs.partners, pairs.flags, strict=True)
    ]
    gain = system.white.gain(left)
    if gain is None:
        return Endogeneity(0.0, 0, np.inf, np.zeros(system.n), np.zeros(system.n))
    used = system.white.counts > 0
    ratio = gain.rss0[used] / np.maximum(gain.rss1[used], 1e-300)
    statistic = float((system.white.counts[used] * np.log(ratio)).sum())
    plain, share, cost = system.plain.gain(left), np.zeros(system.n), np.zeros(system.n)
    share[used] = 100.0 * (1.0 - 1.0 / np.sqrt(ratio))
    if plain is not None:
        used = plain.rss0 > 0
        cost[used] = 100.0 * (1.0 - np.sqrt(plain.rss1[used] / plain.rss0[used]))
    return Endogeneity(statistic, gain.rank, float(special.chdtri(gain.rank, SIGNIFICANCE)), share, cost)
