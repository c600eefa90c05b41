"""Inputs that a model with its base parameters has along a recorded motion."""

from __future__ import annotations

import numpy as np

from modelgen.evaluation.evaluator import Evaluator
from modelgen.evaluation.motion import Motion
from modelgen.functions import Model
from modelgen.numeric import Array


def predicted(evaluator: Evaluator, model: Model, motion: Motion, base: Array) -> Array:
    """Inputs of ideal drives (N, n) that base parameters (p,) take along a motion, with the known forces."""
    columns = np.asarray(evaluator.regressor(model, motion, base))
    unseen = evaluator.unseen(motion, columns, base)
    return np.asarray(columns @ base + unseen + evaluator.known.inputs(motion))
