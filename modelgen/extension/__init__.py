"""The description with the causes that were found."""

from modelgen.extension.describe import Found, extended_arm, extended_yaml, with_torque_constants

__all__ = ["Found", "extended_arm", "extended_yaml", "with_torque_constants"]
