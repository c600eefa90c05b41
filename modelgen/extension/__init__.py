"""The description with the causes that were found."""

from modelgen.extension.describe import extended_arm, extended_yaml, with_torque_constants

__all__ = ["extended_arm", "extended_yaml", "with_torque_constants"]
