"""What an effect that the arm does not have would add to its inputs along a recorded motion."""

from __future__ import annotations

from modelgen.effects.placement import places, with_effect
from modelgen.evaluation.evaluator import Evaluator
from modelgen.evaluation.motion import Motion

__all__ = ["Evaluator", "Motion", "places", "with_effect"]
