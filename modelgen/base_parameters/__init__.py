"""The identifiable combinations of the standard parameters, in closed form."""

from modelgen.base_parameters.objects import BaseParameter, Grouping

__all__ = ["BaseParameter", "Grouping"]
