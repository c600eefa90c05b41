"""The identifiable combinations of the standard parameters, in closed form."""

from modelgen.base_parameters.grouping import base_values, fluid_remarks, group
from modelgen.base_parameters.objects import BaseParameter, Grouping
from modelgen.base_parameters.printing import for_reading

__all__ = ["BaseParameter", "Grouping", "base_values", "fluid_remarks", "for_reading", "group"]
