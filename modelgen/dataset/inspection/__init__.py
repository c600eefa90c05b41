"""What a log says about itself, before it is used for anything."""

from modelgen.dataset.inspection.channels import Channel, Inspected, inspect

__all__ = ["Channel", "Inspected", "inspect"]
