"""Drives: each kind is one class, one function q_m(q)."""

from modelgen.transmission.actuator import Actuator
from modelgen.transmission.bars import Bar
from modelgen.transmission.curves import Curves, curves, curves_over_figures
from modelgen.transmission.direct import UNDRIVEN, DirectDrive, NoDrive
from modelgen.transmission.drive import KINDS, NO_LIMITS, Drive, MotorLimits
from modelgen.transmission.figures import Figure, FigureError
from modelgen.transmission.levered import LeveredDrive
from modelgen.transmission.linkages import DEAD_CENTRE, SliderCrank
from modelgen.transmission.transmission import STROKE_MARGIN, Transmission, of_joint

__all__ = [
    "DEAD_CENTRE",
    "KINDS",
    "NO_LIMITS",
    "STROKE_MARGIN",
    "UNDRIVEN",
    "Actuator",
    "Bar",
    "Curves",
    "DirectDrive",
    "Drive",
    "Figure",
    "FigureError",
    "LeveredDrive",
    "MotorLimits",
    "NoDrive",
    "SliderCrank",
    "Transmission",
    "curves",
    "curves_over_figures",
    "of_joint",
]
