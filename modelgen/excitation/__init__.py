"""Trajectories that make parameters well determined."""

from modelgen.excitation.problem import Problem, problem
from modelgen.excitation.run import Excitation, described, excite, random_conditions
from modelgen.excitation.settings import CRITERIA, Box, Settings, box
from modelgen.excitation.spectrum import condition

__all__ = [
    "CRITERIA",
    "Box",
    "Excitation",
    "Problem",
    "Settings",
    "box",
    "condition",
    "described",
    "excite",
    "problem",
    "random_conditions",
]
