"""Evidence of columns beyond the noise: whitening, likelihood ratios, instruments."""

from modelgen.diagnosis.evidence.instruments import Endogeneity, Pairs, endogeneity
from modelgen.diagnosis.evidence.likelihood import (
    NEGLIGIBLE,
    Evidence,
    StackedEquations,
    joints_of,
    weighted,
)
from modelgen.diagnosis.evidence.noise import Autocorrelation, whitened
from modelgen.diagnosis.evidence.system import System, covariance, independent, mean_squares, whitened_fit

__all__ = [
    "NEGLIGIBLE",
    "Autocorrelation",
    "Endogeneity",
    "Evidence",
    "Pairs",
    "StackedEquations",
    "System",
    "covariance",
    "endogeneity",
    "independent",
    "joints_of",
    "mean_squares",
    "weighted",
    "whitened",
    "whitened_fit",
]
