"""Generated folders: made whole, compared with what they should be."""

from modelgen.generation.arm import GeneratedArm, generate_arm, print_model
from modelgen.generation.budget import TARGETS, Budget
from modelgen.generation.generate import Drift, Report, generate, refuse_collisions

__all__ = [
    "TARGETS",
    "Budget",
    "Drift",
    "GeneratedArm",
    "Report",
    "generate",
    "generate_arm",
    "print_model",
    "refuse_collisions",
]
