"""The geometry of a levered drive from motor counts and measured joint angles."""

from modelgen.calibration.fit import Calibration, Estimate, calibrate
from modelgen.calibration.lever import Lever, lever_of
from modelgen.calibration.patch import calibrated_yaml

__all__ = ["Calibration", "Estimate", "Lever", "calibrate", "calibrated_yaml", "lever_of"]
