"""Description of arms: arms.yaml to frozen, validated objects."""

from modelgen.description.joints import DEFAULT_EFFECTS
from modelgen.description.loading import load, loads
from modelgen.description.objects import (
    Arm,
    DirectDrive,
    Drive,
    EffectUse,
    Inertial,
    Joint,
    LeveredDrive,
    Limits,
    LinkageDrive,
    MotorLimits,
    NoDrive,
    Range,
    Scalar,
    Tool,
    Transform,
    geometry_symbol,
)
from modelgen.description.schema import json_schema
from modelgen.description.starter import starter

__all__ = [
    "DEFAULT_EFFECTS",
    "Arm",
    "DirectDrive",
    "Drive",
    "EffectUse",
    "Inertial",
    "Joint",
    "LeveredDrive",
    "Limits",
    "LinkageDrive",
    "MotorLimits",
    "NoDrive",
    "Range",
    "Scalar",
    "Tool",
    "Transform",
    "geometry_symbol",
    "json_schema",
    "load",
    "loads",
    "starter",
]
