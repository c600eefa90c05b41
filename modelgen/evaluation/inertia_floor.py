"""Base parameters with which the links behind an elastic joint can be simulated.

A rigid arm's parameters take over some of what an elastic joint does, and more of it the less the records
tell the links' inertia from the drive's: of the links may be left less than nothing, with which no spring
holds them. The inertia of links and drive together is known all the same: a part of it is theirs at least.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from modelgen.base_parameters import Grouping
from modelgen.description.objects import Arm
from modelgen.evaluation.motion import Motion
from modelgen.numeric import Array

LEAST = 0.05  # of the inertia of links and drive: the links'
NOTHING = 1e-9  # of the largest, below which a parameter does not show in a pose
COUNT = 400  # places along a motion where it is asked for
ABOUT, ALONG = 5, 9  # of a link's ten standard parameters: ZZ, and M where it slides
Inputs = Callable[[Motion, Array], Array]


def carried(
    arm: Arm, base: Grouping, joint: int, motion: Motion, parameters: Array, links: Inputs, drives: Inputs
) -> Array:
    """The parameters (p,), with as much more inertia of the link at coordinate `joint` (from 1) about its
    axis as the links lack there. links, drives: inputs (N, n) of the links, and of what acts at the motors.
    """
    j, index = joint - 1, arm.coordinates[joint - 1]
    name = 10 * index + (ALONG if arm.joints[index].type == "prismatic" else ABOUT)
    places = [k for k, parameter in enumerate(base.base) if parameter.representative == name]
    every = slice(None, None, max(1, len(motion.t) // COUNT))
    here = replace(
        motion, t=motion.t[every], q=motion.q[every], dq=motion.dq[every], ddq=0.0 * motion.ddq[every]
    )
    faster = replace(here, ddq=here.ddq + np.eye(motion.q.shape[1])[j])

    def inertia(inputs: Inputs, values: Array) -> Array:
        return (inputs(faster, values) - inputs(here, values))[:, j]

    own = inertia(links, parameters)
    whole = own + inertia(drives, parameters)
    for place in places:
        unit = inertia(links, np.eye(len(parameters))[place])
        shown = np.abs(unit) > NOTHING * np.abs(unit).max(initial=0.0)
        if not shown.any():
            continue
        ratio = whole[shown] / unit[shown]
        lacking = float(np.max(LEAST * np.median(ratio) - own[shown] / unit[shown]))
        if lacking > 0.0:
            parameters = parameters.copy()
            parameters[place] += lacking
    return parameters
