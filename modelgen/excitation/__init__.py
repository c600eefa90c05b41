"""Trajectories that make parameters well determined."""

from modelgen.excitation.determined import NOISE, Determined, determined
from modelgen.excitation.problem import Problem, problem
from modelgen.excitation.run import Excitation, described, excite, random_conditions
from modelgen.excitation.spectrum import condition

__all__ = [
    "NOISE",
    "Determined",
    "Excitation",
    "Problem",
    "condition",
    "described",
    "determined",
    "excite",
    "problem",
    "random_conditions",
]
