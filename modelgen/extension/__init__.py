"""The description with the causes that were found."""

from modelgen.extension.describe import extended_arm, extended_yaml

__all__ = ["extended_arm", "extended_yaml"]
