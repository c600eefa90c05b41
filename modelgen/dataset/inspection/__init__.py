"""What a log says about itself, before it is used for anything."""

from modelgen.dataset.inspection.channels import Channel, Inspected, inspect
from modelgen.dataset.inspection.picture import inspection_svg
from modelgen.dataset.inspection.records import RecordsInspected, inspect_records
from modelgen.dataset.inspection.skeleton import skeleton

__all__ = [
    "Channel",
    "Inspected",
    "RecordsInspected",
    "inspect",
    "inspect_records",
    "inspection_svg",
    "skeleton",
]
