"""Description of arms: arms.yaml to frozen, validated objects."""

from modelgen.description.joints import DEFAULT_EFFECTS
from modelgen.description.json_schema import json_schema
from modelgen.description.loading import load, loads
from modelgen.description.objects import (
    Arm,
    Combined,
    EffectUse,
    Inertial,
    Joint,
    Limits,
    Tool,
    Transform,
    Watched,
)
from modelgen.description.starter import starter
from modelgen.symbolic import Range, Scalar, geometry_symbol
from modelgen.transmission import DirectDrive, Drive, LeveredDrive, MotorLimits, NoDrive

__all__ = [
    "DEFAULT_EFFECTS",
    "Arm",
    "Combined",
    "DirectDrive",
    "Drive",
    "EffectUse",
    "Inertial",
    "Joint",
    "LeveredDrive",
    "Limits",
    "MotorLimits",
    "NoDrive",
    "Range",
    "Scalar",
    "Tool",
    "Transform",
    "Watched",
    "geometry_symbol",
    "json_schema",
    "load",
    "loads",
    "starter",
]
