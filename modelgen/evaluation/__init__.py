"""Evaluation of an arm's model, and of effects that it may have besides, along a recorded motion."""

from __future__ import annotations

from modelgen.effects.placement import places, with_effect
from modelgen.evaluation.evaluator import Evaluator
from modelgen.evaluation.motion import Motion
from modelgen.evaluation.predicted import predicted

__all__ = ["Evaluator", "Motion", "places", "predicted", "with_effect"]
